#include <algorithm>
#include <array>
#include <cmath>

#include "capture/clip/fall/fall_scene.hpp"
#include "capture/clip/fall/fall_tracks.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp {
namespace {

constexpr int kLongSide = 320;       // pixels of the small pictures
constexpr std::uint8_t kMoves = 12;  // grey levels from one frame to the next, while it is filmed
constexpr std::size_t kMinFrames = 16;
constexpr double kMaxUnsteady = 0.2;  // share of the picture
constexpr double kMaxShake = 0.01;    // of the picture's height: twice what a still camera's positions are off by
constexpr std::size_t kMinFalls = 3;  // fewer repeat themselves at once; whether segments suffice, learning says
constexpr std::size_t kGoodFalls = 20;
constexpr double kMinWhole = 0.8;   // share of the falls: with fewer, the ones that stray are wanting among the learned
constexpr double kMaxFilled = 0.2;  // share of the rows
constexpr double kLong = 1.8;       // aspect: long enough to tell how it lies …
constexpr double kShort = 1.3;      // … and too short for it
constexpr double kMaxShort = 0.25;  // share of the rows that may be
constexpr double kJerk = 0.52;      // rad: nothing light changes its turning by so much from one frame to the next …
constexpr double kMaxJerks = 0.05;  // … and the long axis of a leaf, which is also seen from its edge and its tip, does

using fall::Cut;
using fall::Fall;
using fall::Falls;
using fall::Thing;

// What all falls have in common.
struct Facts {
  std::size_t rows = 0;
  std::size_t filled = 0;
  double aspect = 0;       // median
  double short_share = 0;  // of the rows, in which it is too short to tell how it lies
  double jerks = 0;        // share of the rows at which its axis jumps

  bool tilt() const { return aspect >= kLong && short_share <= kMaxShort && jerks <= kMaxJerks; }
  const char* tilt_reason() const {
    if (tilt()) return "long enough in view to tell how it lies";
    return aspect >= kLong && short_share <= kMaxShort ? "its long axis jumps from frame to frame, as a leaf's does "
                                                         "that turns about more than one: positions alone"
                                                       : "too round in view to tell how it lies: positions alone";
  }
};

std::size_t jerks_of(const Fall& fall) {
  std::size_t jerks = 0;
  for (std::size_t k = 2; k < fall.rows.size(); ++k) {
    jerks += std::abs(fall.rows[k].angle - 2 * fall.rows[k - 1].angle + fall.rows[k - 2].angle) > kJerk;
  }
  return jerks;
}

Facts facts_of(const std::vector<Fall>& falls) {
  Facts facts;
  std::vector<double> aspects;
  for (const Fall& fall : falls) {
    for (std::size_t k = 0; k < fall.rows.size(); ++k) {
      ++facts.rows;
      facts.filled += fall.filled[k];
      if (fall.filled[k] == 0) aspects.push_back(fall.rows[k].aspect);
    }
    facts.jerks += static_cast<double>(jerks_of(fall));
  }
  facts.jerks /= static_cast<double>(facts.rows);
  std::sort(aspects.begin(), aspects.end());
  facts.aspect = aspects[aspects.size() / 2];
  const auto shorter = std::lower_bound(aspects.begin(), aspects.end(), kShort) - aspects.begin();
  facts.short_share = static_cast<double>(shorter) / static_cast<double>(aspects.size());
  return facts;
}

std::string percent(double share) { return number_text(100 * share, 3) + " %"; }

std::string unsteady_sentence(const fall::Wall& wall) {
  return "everything moves: " + percent(wall.unsteady) +
         " of the picture changes all the time; put the camera on something firm, before a plain wall in steady light";
}

std::string falls_text(std::size_t count) { return std::to_string(count) + (count == 1 ? " fall" : " falls"); }

// How many falls were not seen whole, by the reason.
std::array<std::size_t, 5> counted(const Falls& found) {
  std::array<std::size_t, 5> count{};
  for (const Fall& fall : found.falls) ++count[static_cast<std::size_t>(fall.cut)];
  for (const Cut cut : found.missed) ++count[static_cast<std::size_t>(cut)];
  return count;
}

std::string cut_sentence(const std::array<std::size_t, 5>& count) {
  const auto of = [&](Cut cut) { return count[static_cast<std::size_t>(cut)]; };
  const std::size_t most = *std::max_element(count.begin() + 1, count.end());
  const std::string number = std::to_string(most);
  if (of(Cut::kSide) == most) {
    return "cut by the picture's sides, at least " + number +
           ", so that what is left strays less than it does; film from further away, or hold the camera across, so "
           "that "
           "all of every fall is in view";
  }
  if (of(Cut::kLost) == most) {
    return "lost from view in the air, at least " + number +
           "; film one thing at a time, before a plain wall much darker or lighter than it, in more light";
  }
  if (of(Cut::kPasses) == most) {
    return "so near to another that either may have been taken for the other, at least " + number +
           "; let one thing fall at a time";
  }
  return "over in less than 0.3 s or 8 frames, at least " + number +
         "; let it fall through more of the picture, film 60 frames a second or more, or drop something lighter";
}

// Why there is no fall in a film.
Error no_fall(const std::string& source, const fall::Wall& wall, const std::vector<fall::Seen>& frames,
              const Falls& found) {
  const bool inside =
      std::any_of(frames.begin(), frames.end(), [](const fall::Seen& seen) { return !seen.things.empty(); });
  const bool border = std::any_of(frames.begin(), frames.end(), [](const fall::Seen& seen) { return seen.at_border; });
  if (wall.unsteady > kMaxUnsteady) return {source + ": " + unsteady_sentence(wall)};
  if (found.missed.size() >= kMinFalls || counted(found)[static_cast<std::size_t>(Cut::kPasses)] > 0) {
    return {source + ": no fall can be followed in it: " + cut_sentence(counted(found))};
  }
  if (inside) {
    return {
        source +
        ": nothing falls in it: what moves is not seen for 0.3 s, or does not sink by a quarter of the picture; drop "
        "something light in the middle of the picture, in front of a wall of another brightness"};
  }
  if (border) {
    return {source +
            ": nothing falls in it: only what reaches in over the picture's edge moves; let go of the thing "
            "within the picture, and take the hand away"};
  }
  return {source + ": nothing moves in it; drop something light before a wall of another brightness"};
}

ReportVerdict verdict_on(const Falls& found, const fall::Wall& wall) {
  if (wall.unsteady > kMaxUnsteady) return {false, unsteady_sentence(wall)};
  if (const double shake = wall.shake / wall.height; shake > kMaxShake) {
    return {false, "the camera shakes, by " + percent(shake) +
                       " of the picture's height, and every position with it; put it on something firm"};
  }
  const auto count = counted(found);
  const std::size_t whole = count[0], all = found.falls.size() + found.missed.size();
  const std::string better = std::to_string(kGoodFalls) + " or more are better, in one film or in several";
  if (static_cast<double>(whole) < kMinWhole * static_cast<double>(all)) {
    return {false, "only " + std::to_string(whole) + " of about " + falls_text(all) +
                       " were followed to their end: " + cut_sentence(count)};
  }
  if (whole < kMinFalls) {
    return {false, "only " + falls_text(whole) + ", expected at least " + std::to_string(kMinFalls) +
                       ": drop it again; " + better};
  }
  std::string reason = falls_text(found.falls.size());
  if (whole < all)
    reason += ", " + std::to_string(whole) + " of about " + std::to_string(all) + " followed to their end";
  return {true, reason + (whole < kGoodFalls ? "; " + better : "")};
}

// The body's second axis along the thing, its third the normal, both in the picture, x and z of the world: half a
// quarter turn about z, then the angle about −y. So the second axis is the one along which a leaf glides.
std::array<double, 4> attitude(double angle) {
  const double c = std::sqrt(0.5) * std::cos(angle / 2), s = std::sqrt(0.5) * std::sin(angle / 2);
  return {c, s, -s, -c};
}

ReportSection frames_section(const std::vector<std::vector<std::uint8_t>>& frames, std::size_t repeated,
                             const fall::Wall& wall, double rate_hz) {
  const auto lost =
      static_cast<std::size_t>(std::count_if(frames.begin(), frames.end(), [](const auto& f) { return f.empty(); }));
  return {"Frames",
          {{"frames", frames.size(), "frames", ""},
           {"lost", lost, "lost", "", {}, "frames that the film has not"},
           {"duplicates", repeated, "duplicates", "", {}, "frames that repeat the one before"},
           {"rate_hz", rate_hz, "rate", "frames a second"},
           {"noise", wall.noise, "noise", "grey levels", {}, "of the wall; below 2 is good"},
           {"shake",
            wall.shake / wall.height,
            "shakes by",
            "",
            {},
            "share of the picture's height; 0 too before a wall without marks"},
           {"unsteady", wall.unsteady, "changing", "", {}, "share of the picture that changes all the time"}}};
}

const char* cut_text(Cut cut) {
  switch (cut) {
    case Cut::kNo:
      return "yes";
    case Cut::kSide:
      return "no: cut by the picture's side";
    case Cut::kLost:
      return "no: lost from view";
    case Cut::kPasses:
    case Cut::kQuick:
      break;  // are missed
  }
  return "";
}

ReportSection falls_section(const Falls& found, const Facts& facts, double metres_per_pixel, double rate_hz) {
  ReportSection section{"Falls"};
  const std::vector<Fall>& falls = found.falls;
  section.entries = {{"falls", falls.size(), "falls", ""},
                     {"whole", counted(found)[0], "whole", "", {}, "followed from their release to their end"},
                     {"missed",
                      found.missed.size(),
                      "missed",
                      "",
                      {},
                      "something sank, but was seen for too short, or passed another"},
                     {"rows", facts.rows, "rows", ""},
                     {"filled", facts.filled, "filled", "", {}, "interpolated between their neighbours"},
                     {"aspect", facts.aspect, "length over width", "", {}, "median"},
                     {"tilt", facts.tilt(), "tilt", ""},
                     {"tilt_reason", facts.tilt_reason(), "", ""}};
  ReportTable table{"fall",
                    "falls",
                    {{"frame", "from frame"},
                     {"seconds", "lasts", "s"},
                     {"metres", "falls", "m"},
                     {"aspect", "aspect"},
                     {"whole", "whole"}},
                    {}};
  for (const Fall& fall : falls) {
    table.rows.push_back({fall.first + 1, static_cast<double>(fall.rows.size() - 1) / rate_hz,
                          (fall.rows.back().y - fall.rows.front().y) * metres_per_pixel, facts_of({fall}).aspect,
                          cut_text(fall.cut)});
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

FallCapture::FallCapture(ClipSource source, const FallOptions& options)
    : source_(std::move(source)), options_(options) {}

Result<FallCapture> FallCapture::create(const ClipSource& source, const FallOptions& options) {
  if (!(source.rate_hz > 0)) return Error{source.name + ": states no frame rate; give it as --rate"};
  const double height = options.height_metres;
  if (height != 0 && !(height >= 0.01 && height <= 100)) {
    return Error{source.name + ": the picture's height is " + number_text(height, 6) +
                 " m, expected 0.01 to 100: how much of the wall it shows"};
  }
  return FallCapture(source, options);
}

std::vector<std::uint8_t> FallCapture::reduced(const Picture& picture) const {
  const Region region{region_.x, region_.y, width_ * step_, height_ * step_};
  std::vector<std::uint8_t> luma(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
  extract_channel(picture, PixelChannel::kLuma, region, luma.data());
  if (step_ == 1) return luma;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(width_ * height_), 0);
  for (int y = 0; y < region.height; ++y) {
    const std::uint8_t* row = luma.data() + static_cast<std::ptrdiff_t>(y) * region.width;
    std::uint32_t* sum = sums.data() + static_cast<std::ptrdiff_t>(y / step_) * width_;
    for (int x = 0; x < width_; ++x) {
      for (int k = 0; k < step_; ++k) sum[x] += *row++;
    }
  }
  const auto count = static_cast<std::uint32_t>(step_ * step_);
  std::vector<std::uint8_t> small;
  for (const std::uint32_t sum : sums) small.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
  return small;
}

Result<void> FallCapture::feed(const Picture& picture) {
  if (frame_.empty()) {
    frame_ = picture.frame();
    region_ = options_.region.empty() ? frame_ : intersection(options_.region, frame_);
    if (region_.width < 16 || region_.height < 16) {
      return Error{source_.name + ": the region has less than 16 x 16 pixels of its picture of " +
                   std::to_string(frame_.width) + " x " + std::to_string(frame_.height)};
    }
    step_ = (std::max(region_.width, region_.height) + kLongSide - 1) / kLongSide;
    width_ = region_.width / step_;
    height_ = region_.height / step_;
  }
  if (picture.frame() != frame_) {
    return Error{source_.name + ": frame " + std::to_string(frames_.size() + 1) + " has " +
                 std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels, expected " +
                 std::to_string(frame_.width) + " x " + std::to_string(frame_.height) + " as the first"};
  }
  const std::size_t most = seen().max_frames;
  if (frames_.size() >= most) {
    return Error{source_.name + ": has more than " + std::to_string(most) +
                 " frames, which do not fit; give films of at most " +
                 number_text(std::floor(static_cast<double>(most) / source_.rate_hz), 4) +
                 " s: a chain is learned from several"};
  }
  frames_.push_back(reduced(picture));
  moving_ = {};
  if (frames_.size() < 2 || frames_[frames_.size() - 2].empty()) return {};
  const auto &now = frames_.back(), &before = frames_[frames_.size() - 2];
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto p = static_cast<std::size_t>(y * width_ + x);
      if (std::abs(now[p] - before[p]) < kMoves) continue;
      moving_ = enclosing(moving_, {region_.x + x * step_, region_.y + y * step_, step_, step_});
    }
  }
  return {};
}

void FallCapture::lost(int count) {
  if (count > 0) frames_.resize(frames_.size() + static_cast<std::size_t>(count));
}

FallSeen FallCapture::seen() const {
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  return {frames_.size(), pixels == 0 ? 0 : options_.max_bytes / pixels, moving_};
}

Result<Captured> FallCapture::finish() {
  if (frames_.size() < kMinFrames) {
    return Error{source_.name + ": has " + std::to_string(frames_.size()) + " frames, expected at least " +
                 std::to_string(kMinFrames) + ": film the whole fall"};
  }
  const fall::Wall wall = fall::wall_of(frames_, width_, height_);
  std::vector<fall::Seen> seen(frames_.size());
  std::size_t repeated = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    if (frames_[k].empty()) continue;
    // What a camera or a program shows twice has not stood still in between.
    const bool repeats = k > 0 && frames_[k] == frames_[k - 1];
    repeated += repeats;
    if (!repeats) seen[k] = fall::seen_in(frames_[k], wall);
  }
  const Falls found =
      fall::falls_in(seen, {source_.rate_hz, static_cast<double>(width_), static_cast<double>(height_)});
  const std::vector<Fall>& falls = found.falls;
  if (falls.empty()) return no_fall(source_.name, wall, seen, found);
  const Facts facts = facts_of(falls);
  Captured out{recorded(falls, facts.tilt()), {}};
  out.report.verdict = verdict_on(found, wall);
  set_verdict(out.recording, out.report.verdict->usable, out.report.verdict->reason);
  if (options_.height_metres == 0) {
    out.report.warnings.push_back(
        "how much of the wall the picture's height shows is not known: 1 m is taken; give it as --height METRES");
  }
  if (static_cast<double>(facts.filled) > kMaxFilled * static_cast<double>(facts.rows)) {
    out.report.warnings.push_back(
        percent(static_cast<double>(facts.filled) / static_cast<double>(facts.rows)) +
        " of the rows were interpolated: the film repeats or loses frames, or the thing is as bright as the wall");
  }
  out.report.sections = {frames_section(frames_, repeated, wall, source_.rate_hz),
                         falls_section(found, facts, step_ * metres_per_pixel(), source_.rate_hz)};
  return out;
}

double FallCapture::metres_per_pixel() const {
  return (options_.height_metres > 0 ? options_.height_metres : 1.0) / frame_.height;
}

Recording FallCapture::recorded(const std::vector<Fall>& falls, bool tilt) const {
  Recording recording{.source = source_.name, .rate_hz = source_.rate_hz};
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) recording.channels.push_back({name, "m", Role::kOutput, {}});
  for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) {
    if (tilt) recording.channels.push_back({name, "", Role::kOutput, {}});
  }
  recording.flags.push_back({"filled", {}});
  const double scale = metres_per_pixel();
  for (std::size_t episode = 0; episode < falls.size(); ++episode) {
    const Fall& fall = falls[episode];
    for (std::size_t k = 0; k < fall.rows.size(); ++k) {
      const Thing& thing = fall.rows[k];
      // From pixels' middles to pixels' corners, where the picture's own height is counted.
      const double x = region_.x + (thing.x + 0.5) * step_, y = region_.y + (thing.y + 0.5) * step_;
      recording.channels[0].samples.push_back(scale * (x - 0.5 * frame_.width));
      recording.channels[1].samples.push_back(0);
      recording.channels[2].samples.push_back(scale * (frame_.height - y));
      const auto q = attitude(thing.angle);
      for (std::size_t i = 0; tilt && i < 4; ++i) recording.channels[3 + i].samples.push_back(q[i]);
      recording.flags[0].rows.push_back(fall.filled[k]);
      recording.episode_ids.push_back(static_cast<std::int64_t>(episode));
    }
  }
  return recording;
}

}  // namespace wisp
