#include "capture/clip/fall/falls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "record/number_text.hpp"

namespace wisp::fall {
namespace {

constexpr double kMaxUnsteady = 0.2;  // maximum share of the picture that changes all the time
constexpr double kMaxShake = 0.01;    // maximum shake, share of the height: twice a fixed camera's position error
constexpr std::size_t kMinFalls = 3;  // minimum number of falls; learning checks whether segments suffice
constexpr std::size_t kGoodFalls = 20;
constexpr double kMinWhole = 0.8;   // minimum share of complete falls: below it, falls that stray are under-represented
constexpr double kLong = 1.8;       // minimum median aspect for attitude to be measured
constexpr double kMaxShort = 0.25;  // maximum share of rows below kRound for attitude to be measured
constexpr double kJerk = 0.52;      // rad per frame: a larger change of the turning rate counts as a jump of the axis
constexpr double kMaxJerks = 0.05;  // maximum share of rows with a jump of the axis, as in a leaf seen edge-on

std::size_t jerks_of(const Fall& fall) {
  std::size_t jerks = 0;
  for (std::size_t k = 2; k < fall.rows.size(); ++k) {
    jerks += std::abs(fall.rows[k].angle - 2 * fall.rows[k - 1].angle + fall.rows[k - 2].angle) > kJerk;
  }
  return jerks;
}

std::string percent(double share) { return number_text(100 * share, 3) + " %"; }

std::string unsteady_sentence(const Wall& wall) {
  return "everything moves: " + percent(wall.unsteady) +
         " of the picture changes all the time; put the camera on something firm, before a plain wall in steady light";
}

std::string falls_text(std::size_t count) { return std::to_string(count) + (count == 1 ? " fall" : " falls"); }

// Returns the number of falls, missed ones included, for each Cut; [0] counts falls followed to their end.
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
           "that all of every fall is in view";
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

const char* cut_text(Cut cut) {
  if (cut == Cut::kNo) return "yes";
  if (cut == Cut::kSide) return "no: cut by the picture's side";
  return cut == Cut::kLost ? "no: lost from view" : "";  // the others belong to missed falls
}

}  // namespace

bool Facts::tilt() const { return aspect >= kLong && short_share <= kMaxShort && jerks <= kMaxJerks; }

const char* Facts::tilt_reason() const {
  if (tilt()) return "long enough in view to tell how it lies";
  return aspect >= kLong && short_share <= kMaxShort ? "its long axis jumps from frame to frame, as a leaf's does "
                                                       "that turns about more than one: positions alone"
                                                     : "too round in view to tell how it lies: positions alone";
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
  const auto shorter = std::lower_bound(aspects.begin(), aspects.end(), kRound) - aspects.begin();
  facts.short_share = static_cast<double>(shorter) / static_cast<double>(aspects.size());
  return facts;
}

Error no_fall(const std::string& source, const Wall& wall, const std::vector<Seen>& frames, const Falls& found) {
  const bool inside = std::any_of(frames.begin(), frames.end(), [](const Seen& seen) { return !seen.things.empty(); });
  const bool border = std::any_of(frames.begin(), frames.end(), [](const Seen& seen) { return seen.at_border; });
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

ReportVerdict verdict_on(const Falls& found, const Wall& wall) {
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

std::optional<std::string> filled_warning(const Facts& facts) {
  const double share = static_cast<double>(facts.filled) / static_cast<double>(facts.rows);
  if (share <= 0.2) return std::nullopt;
  return percent(share) +
         " of the rows were interpolated: the film repeats or loses frames, or the thing is as bright as the wall";
}

ReportSection frames_section(const std::vector<Frame>& frames, std::size_t repeated, const Wall& wall, double rate_hz) {
  const auto lost =
      static_cast<std::size_t>(std::count_if(frames.begin(), frames.end(), [](const auto& f) { return f.empty(); }));
  const double shake = wall.shake / wall.height;
  return {"Frames",
          {{"frames", frames.size(), "frames", ""},
           {"lost", lost, "lost", "", {}, "frames that the film has not"},
           {"duplicates", repeated, "duplicates", "", {}, "frames that repeat the one before"},
           {"rate_hz", rate_hz, "rate", "frames a second"},
           {"noise", wall.noise, "noise", "grey levels", {}, "of the wall; below 2 is good"},
           {"shake", shake, "shakes by", "", {}, "share of the picture's height; 0 too before a wall without marks"},
           {"unsteady", wall.unsteady, "changing", "", {}, "share of the picture that changes all the time"}}};
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

}  // namespace wisp::fall
