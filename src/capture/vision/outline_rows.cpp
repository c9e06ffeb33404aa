#include "capture/vision/outline_rows.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "base/statistics.hpp"
#include "capture/vision/survey.hpp"

namespace wisp {
namespace {

constexpr double kFadeShare = 0.73;  // share of an object's usual brightness below which it is fading
constexpr double kDimSeconds = 0.1;
constexpr double kDuplicateShare = 0.35;  // change relative to neighbours below which a frame is a duplicate
constexpr double kDuplicateMost = 0.5;    // grey levels of change above which a frame is new: it has new noise
constexpr std::size_t kNeighbours = 4;    // frames compared on each side; minimum length of a frozen stretch
constexpr double kFrozenMost = 0.1;       // maximum change of a frame in a frozen stretch, grey levels
constexpr double kFrozenUsual = 0.02;     // maximum median change in a stretch: coding corrects repeats once or twice

enum class Fate : std::uint8_t { kKept, kDuplicate, kFilled, kFade, kNothing, kLost };

// Detects frames repeated by a screen or a converter: they change much less than the frames around. Near the turning
// points of an object's motion, where it really stands still, the frames around change little too.
bool duplicate(const FrameFindings& findings, std::size_t row) {
  const float change = findings.frames[row].change;
  if (row == 0 || change >= kDuplicateMost) return false;
  std::vector<float> around;
  const std::size_t first = row > kNeighbours ? row - kNeighbours : 1;
  for (std::size_t k = first; k < std::min(findings.size(), row + kNeighbours + 1); ++k) {
    if (findings.frames[k].kind == FrameFinding::Kind::kTracked) around.push_back(findings.frames[k].change);
  }
  return change < kDuplicateShare * median(std::move(around));
}

Fate judge(const FrameFindings& findings, std::size_t row, double usual_brightness) {
  const FrameFinding& frame = findings.frames[row];
  if (frame.kind == FrameFinding::Kind::kLost) return Fate::kLost;
  if (frame.kind == FrameFinding::Kind::kNothing) return Fate::kNothing;
  if (frame.brightness < kFadeShare * usual_brightness) return Fate::kFade;
  return duplicate(findings, row) ? Fate::kDuplicate : Fate::kKept;
}

double usual_brightness_of(const FrameFindings& findings) {
  std::vector<float> brightness;
  for (const FrameFinding& frame : findings.frames) {
    if (frame.kind == FrameFinding::Kind::kTracked) brightness.push_back(frame.brightness);
  }
  return median(std::move(brightness));
}

// Number of consecutive rows that show each frame of a slower film or of slow motion, at most eight, and the first such
// group's first row. The picture changes most at a group's first row; within a group only noise changes.
struct Stands {
  std::size_t times = 1;
  std::size_t first = 0;
};

Stands find_stands(const FrameFindings& findings) {
  // By chance, the first row changes most in 1 / `times` of the groups; kErrors standard errors more are significant.
  constexpr double kMinGroups = 20, kOfGroups = 0.6, kErrors = 4;
  for (Stands found{.times = 8}; found.times > 1; --found.times) {
    for (found.first = 0; found.first < found.times; ++found.first) {
      double groups = 0, such = 0;
      for (std::size_t row = found.first; row + found.times <= findings.size(); row += found.times) {
        const std::span frames(findings.frames.data() + row, found.times);
        const auto tracked = [](const FrameFinding& one) { return one.kind == FrameFinding::Kind::kTracked; };
        if (row == 0 || !std::all_of(frames.begin(), frames.end(), tracked)) continue;
        ++groups;
        such += std::all_of(frames.begin() + 1, frames.end(),
                            [&](const FrameFinding& one) { return one.change < frames.front().change; });
      }
      const double chance = 1 / static_cast<double>(found.times), error = std::sqrt(chance * (1 - chance) / groups);
      if (groups >= kMinGroups && such >= std::max(kOfGroups, chance + kErrors * error) * groups) return found;
    }
  }
  return {};
}

std::vector<Fate> judge(const FrameFindings& findings, double usual_brightness, const Stands& stands) {
  std::vector<Fate> fate;
  for (std::size_t row = 0; row < findings.size(); ++row) {
    fate.push_back(judge(findings, row, usual_brightness));
    const bool again = stands.times > 1 && (row + stands.times - stands.first) % stands.times != 0;
    if (again && fate.back() == Fate::kKept) fate.back() = Fate::kDuplicate;
  }
  return fate;
}

// Marks frozen stretches as duplicates (duplicate() misses them: frames around repeat too). Returns the number of rows.
std::size_t mark_frozen(const FrameFindings& findings, std::vector<Fate>& fate) {
  std::size_t rows = 0;
  std::vector<float> changes;
  for (std::size_t row = 1; row <= fate.size(); ++row) {
    const bool same = row < fate.size() && findings.frames[row].kind == FrameFinding::Kind::kTracked &&
                      findings.frames[row].change < kFrozenMost;
    if (same) changes.push_back(findings.frames[row].change);
    if (same) continue;
    if (changes.size() >= kNeighbours && median(changes) < kFrozenUsual) {
      std::fill_n(fate.begin() + static_cast<std::ptrdiff_t>(row - changes.size()), changes.size(), Fate::kDuplicate);
      rows += changes.size();
    }
    changes.clear();
  }
  return rows;
}

// Removes brief appearances between longer absences: they are glints, not the object.
void leave_out_glints(std::vector<Fate>& fate, double rate_hz) {
  struct Span {
    bool nothing = false;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t size() const { return end - begin; }
  };
  std::vector<Span> stretches;
  for (std::size_t k = 0; k < fate.size(); ++k) {
    const bool nothing = fate[k] == Fate::kNothing;
    if (stretches.empty() || stretches.back().nothing != nothing) stretches.push_back({nothing, k, k});
    stretches.back().end = k + 1;
  }
  for (std::size_t k = 1; k + 1 < stretches.size(); ++k) {
    const Span& now = stretches[k];
    if (now.nothing || static_cast<double>(now.size()) > kGlintSeconds * rate_hz) continue;
    if (std::min(stretches[k - 1].size(), stretches[k + 1].size()) <= now.size()) continue;
    for (std::size_t row = now.begin; row < now.end; ++row) fate[row] = Fate::kNothing;
  }
}

// Extends a fade to its dark end, where no bright region is found.
void extend_fades(std::vector<Fate>& fate) {
  for (std::size_t k = 1; k < fate.size(); ++k) {
    if (fate[k] == Fate::kNothing && fate[k - 1] == Fate::kFade) fate[k] = Fate::kFade;
  }
  for (std::size_t k = fate.size(); k-- > 1;) {
    if (fate[k - 1] == Fate::kNothing && fate[k] == Fate::kFade) fate[k - 1] = Fate::kFade;
  }
}

// Maximum number of consecutive frames to fill: a screen shows a picture up to four times, slow motion `times` times.
// A gap of more than one lost frame is not filled, as the motion in it is unknown.
std::size_t max_filled(Fate fate, const Stands& stands) {
  if (fate == Fate::kDuplicate) return std::max<std::size_t>(3, stands.times - 1);
  return fate == Fate::kLost ? 1 : 0;
}

// Fills short gaps between outlines of distinct frames by linear interpolation.
void fill_gaps(std::vector<Fate>& fate, const Stands& stands, std::vector<double>& controls, std::size_t width) {
  for (std::size_t begin = 1; begin + 1 < fate.size(); ++begin) {
    const std::size_t most = max_filled(fate[begin], stands);
    if (most == 0 || fate[begin - 1] != Fate::kKept) continue;
    std::size_t end = begin;
    while (end < fate.size() && fate[end] == fate[begin]) ++end;
    if (end == fate.size() || end - begin > most || fate[end] != Fate::kKept) continue;
    for (std::size_t k = begin; k < end; ++k) {
      const double part = static_cast<double>(k + 1 - begin) / static_cast<double>(end + 1 - begin);
      for (std::size_t i = 0; i < width; ++i) {
        const double from = controls[(begin - 1) * width + i], to = controls[end * width + i];
        controls[k * width + i] = from + part * (to - from);
      }
      fate[k] = Fate::kFilled;
    }
  }
}

const char* reason(Fate fate, bool elsewhere) {
  if (fate == Fate::kDuplicate) return "duplicate";
  if (fate == Fate::kFade) return "fade";
  if (fate == Fate::kLost) return "lost";
  return elsewhere ? "elsewhere" : "nothing there";
}

bool present(Fate fate) { return fate == Fate::kKept || fate == Fate::kFilled; }

void count(const std::vector<Fate>& fate, const FrameFindings& findings, CaptureReport& report) {
  report.frames = fate.size();
  double residuals = 0;
  for (std::size_t k = 0; k < fate.size(); ++k) {
    if (!present(fate[k])) report.dropped.push_back({k, reason(fate[k], findings.frames[k].elsewhere)});
    report.filled += fate[k] == Fate::kFilled;
    if (fate[k] != Fate::kKept) continue;
    ++report.tracked;
    residuals += findings.frames[k].residual;
  }
  report.residual = report.tracked == 0 ? 0 : residuals / static_cast<double>(report.tracked);
}

// Finds another scene before the first or after the last outline: most of its frames show an object elsewhere.
void find_other_scenes(const std::vector<Fate>& fate, const FrameFindings& findings, OutlineFacts& facts) {
  const auto first = std::find_if(fate.begin(), fate.end(), present),
             last = std::find_if(fate.rbegin(), fate.rend(), present).base();
  const auto other = [&](auto from, auto to) {
    const auto begin = findings.frames.begin();
    const auto elsewhere = std::count_if(begin + (from - fate.begin()), begin + (to - fate.begin()),
                                         [](const FrameFinding& finding) { return finding.elsewhere; });
    return 2 * elsewhere > to - from ? static_cast<std::size_t>(to - from) : 0;
  };
  facts.other_before = other(fate.begin(), first);
  facts.other_after = other(last, fate.end());
}

// Returns whether the object was dim for kDimSeconds before it disappeared, as in a fade. A flame goes out abruptly.
bool fades_out(const std::vector<Fate>& fate, const FrameFindings& findings, double usual_brightness, double rate_hz) {
  std::size_t end = static_cast<std::size_t>(std::find_if(fate.rbegin(), fate.rend(), present).base() - fate.begin());
  while (end < fate.size() && findings.frames[end].kind == FrameFinding::Kind::kTracked) ++end;
  const auto rows = std::max<std::size_t>(2, static_cast<std::size_t>(std::ceil(kDimSeconds * rate_hz)));
  if (end < rows) return false;
  return std::all_of(findings.frames.begin() + static_cast<std::ptrdiff_t>(end - rows),
                     findings.frames.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](const FrameFinding& f) { return f.brightness < kAsBright * usual_brightness; });
}

void write_channels(const std::vector<Fate>& fate, const std::vector<double>& controls, int points,
                    Recording& recording) {
  const std::size_t rows = fate.size(), width = 2 * static_cast<std::size_t>(points);
  for (std::size_t i = 0; i < width; ++i) {
    Channel channel{"p" + std::to_string(i / 2) + (i % 2 == 0 ? ".x" : ".y"), "px", Role::kOutput, {}};
    channel.samples.reserve(rows);
    for (std::size_t k = 0; k < rows; ++k)
      channel.samples.push_back(present(fate[k]) ? controls[k * width + i] : std::nan(""));
    recording.channels.push_back(std::move(channel));
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    Channel channel{axis == 0 ? "base.x" : "base.y", "px", Role::kMotion, {}};
    const std::vector<double>& left = recording.channels[axis].samples;
    const std::vector<double>& right = recording.channels[width - 2 + axis].samples;
    for (std::size_t k = 0; k < rows; ++k) channel.samples.push_back(0.5 * (left[k] + right[k]));
    recording.channels.push_back(std::move(channel));
  }
}

// Writes episodes and flags. Missing rows belong to the episode before them; the next outline starts a new one.
void write_episodes(const std::vector<Fate>& fate, Recording& recording) {
  RowFlag filled{"filled", {}}, lost{std::string(kLostRows), {}};
  std::int64_t episode = 0;
  bool seen = false, gap = false;
  for (const Fate f : fate) {
    if (present(f) && gap && seen) ++episode;
    gap = !present(f);
    seen = seen || present(f);
    recording.episode_ids.push_back(episode);
    filled.rows.push_back(f == Fate::kFilled);
    lost.rows.push_back(f == Fate::kLost || f == Fate::kDuplicate);
  }
  recording.flags.push_back(std::move(filled));
  if (std::count(lost.rows.begin(), lost.rows.end(), 1) > 0) recording.flags.push_back(std::move(lost));
}

}  // namespace

void assemble_rows(const FrameFindings& findings, int points, Recording& recording, CaptureReport& report) {
  const double usual_brightness = usual_brightness_of(findings);
  const Stands stands = find_stands(findings);
  report.facts.stands = static_cast<int>(stands.times);
  std::vector<Fate> fate = judge(findings, usual_brightness, stands);
  report.facts.frozen = mark_frozen(findings, fate);
  const auto times = [&](Fate one) { return static_cast<std::size_t>(std::count(fate.begin(), fate.end(), one)); };
  report.duplicates = times(Fate::kDuplicate);
  report.facts.repeated = static_cast<double>(report.duplicates) / static_cast<double>(fate.size());
  report.facts.lost = static_cast<double>(times(Fate::kLost)) / static_cast<double>(fate.size());
  extend_fades(fate);
  leave_out_glints(fate, report.rate_hz);
  std::vector<double> controls = findings.controls;
  fill_gaps(fate, stands, controls, 2 * static_cast<std::size_t>(points));
  count(fate, findings, report);
  find_other_scenes(fate, findings, report.facts);
  report.facts.fades_out = fades_out(fate, findings, usual_brightness, report.rate_hz);
  write_channels(fate, controls, points, recording);
  write_episodes(fate, recording);
}

}  // namespace wisp
