#include "capture/vision/outline_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/vision/film_look.hpp"
#include "capture/vision/outline_verdict_weights.hpp"

namespace wisp {
namespace {

using R = const CaptureReport&;

enum class Of : std::uint8_t { kMotion, kFlame, kFilm };

// A fact, its subject (kFlame: used for flames only, the others for any object), and the verdict's sentence if the
// fact is the reason. {} and {%} stand for the fact's value.
struct FactRow {
  const char* name;
  Of of;
  const char* sentence;
};

constexpr const char* kStill =
    "its edges do not move{still}, as those of a lamp or a lit thing; film a flame in a dark room";
constexpr const char* kShape =
    "its shape is not a flame's: it may have run together with what it lights; lower the exposure, so that only the "
    "flame is bright";
constexpr const char* kGlare =
    "it is clipped flat, {clipped} of it as bright as the camera shows anything, and its shape is not a flame's; lower "
    "the exposure";
constexpr const char* kFrozen =
    "the film stands still, {%} of its frames repeat the one before; give a part in which it moves throughout";
constexpr double kIrregular = 0.15;    // share of lost frames above which these cause the other faults
constexpr double kClippedShape = 0.5;  // share of clipped area above which a shape counts as overexposed

constexpr std::array<FactRow, 19> kFacts{{
    {"movement", Of::kMotion, kStill},
    {"over_noise", Of::kMotion, kStill},
    {"wander", Of::kFlame, "it moves about as a whole, and its shape hardly changes; keep the camera still"},
    {"still", Of::kMotion, kStill},
    {"steadiness", Of::kFlame, "its foot moves as much as its tip; keep the camera still, and only a flame in view"},
    {"taper", Of::kFlame,
     "it does not taper upwards as a flame does; choose a region around the flame, or film it before a dark ground"},
    {"light", Of::kFlame, "other things in the picture are brighter; choose a region around the flame"},
    {"contrast", Of::kFlame,
     "it is hardly brighter than what is around it, by {} of 255 levels; film a flame before a dark ground"},
    {"width", Of::kFlame, kShape},
    {"misfit", Of::kFlame, kShape},
    {"lean", Of::kFlame, "it lies on its side, {} degrees from upright; the film may be turned: rotate it"},
    {"lost", Of::kFilm, "its frames come irregularly, {%} are missing from the clip; film at a fixed rate"},
    {"repeated", Of::kFilm,
     "{%} of its frames repeat the one before{stands}: it was filmed at a lower rate; give the clip in that rate"},
    {"elsewhere", Of::kFilm,
     "in {%} of the frames it is gone and another bright thing is in the picture: the film is cut, or the camera moves "
     "too far; give frames {frames} alone"},
    {"missing", Of::kFilm, "it is missing in {%} of the frames; film it steadily, with nothing in between"},
    {"jumps", Of::kFilm, "it jumps in {%} of the frames; keep the camera still, and only one flame in the picture"},
    {"border", Of::kFilm, "it reaches the {side} border of the picture in {%} of the frames; leave room around it"},
    {"height", Of::kFilm, "it is only {} pixels high; film it from nearer"},
    {"tracked", Of::kFilm, "an outline was found in {} frames only; give a longer clip"},
}};
static_assert(kVerdictCurves.size() == kFacts.size());
constexpr std::size_t kLost = 11, kRepeated = 12;

// Returns the share of rows that have a frame but no outline, among rows in which the flame burns.
double missing_share(R r) {
  const double lost = r.facts.lost * static_cast<double>(r.frames);
  const double absent = static_cast<double>(r.facts.absent - r.facts.blown) - lost;
  return std::max(0.0, absent) / static_cast<double>(std::max<std::size_t>(r.facts.rows - r.facts.blown, 1));
}

double still_share(R r) {
  return static_cast<double>(r.facts.still) /
         static_cast<double>(std::max<std::size_t>(r.facts.seen_from + r.facts.rows, 1));
}

// Returns the facts' values in the order of kFacts.
std::array<double, kFacts.size()> values_of(R r) {
  const OutlineFacts& f = r.facts;
  const double height = std::max(f.height, 1e-9);
  const double elsewhere =
      static_cast<double>(f.other_before + f.other_after) / static_cast<double>(std::max<std::size_t>(r.frames, 1));
  return {f.movement,
          f.movement * f.height / std::max(f.edge_noise, 0.03),
          f.wander,
          still_share(r),
          f.steadiness,
          f.taper,
          f.light,
          f.contrast,
          f.width,
          (r.residual - 0.3) * r.points / height,  // few control points follow a flame less closely
          f.lean,
          f.lost,
          f.repeated,
          elsewhere,
          missing_share(r),
          f.jumps,
          *std::max_element(f.border.begin(), f.border.begin() + 3),
          f.height,
          static_cast<double>(r.tracked)};
}

std::string number(double value) { return std::to_string(std::lround(value)); }

std::string percent(double share) { return number(100 * share) + " %"; }

std::string sentence_of(std::size_t fact, R r) {
  constexpr std::array<const char*, 3> kSide{"left", "upper", "right"};
  const double value = values_of(r)[fact];
  const OutlineFacts& f = r.facts;
  const auto side = std::max_element(f.border.begin(), f.border.begin() + 3) - f.border.begin();
  const std::array<std::pair<const char*, std::string>, 7> names{{
      {"{}", number(value)},
      {"{%}", percent(value)},
      {"{side}", kSide[static_cast<std::size_t>(side)]},
      {"{still}", still_share(r) > 0.3 ? " in " + percent(still_share(r)) + " of the frames" : " beyond its noise"},
      {"{stands}",
       f.stands < 2 ? "" : " (every frame stands " + std::to_string(f.stands) + " times, as in slow motion)"},
      {"{frames}",
       std::to_string(f.seen_from + r.first_frame) + " to " + std::to_string(f.seen_from + f.rows + r.first_frame - 1)},
      {"{clipped}", percent(f.clipped)},
  }};
  const bool flat = kFacts[fact].sentence == kShape && f.clipped > kClippedShape;
  const bool frozen = fact == kRepeated && 2 * f.frozen > r.duplicates && f.stands < 2;
  std::string out = flat ? kGlare : frozen ? kFrozen : kFacts[fact].sentence;
  for (const auto& [name, text] : names) {
    const auto at = out.find(name);
    if (at != std::string::npos) out.replace(at, std::char_traits<char>::length(name), text);
  }
  return out;
}

// Returns the penalty of a fact on the log odds: linear between the knots, constant beyond them.
double against(const std::array<double, kVerdictKnots>& knots, const std::array<double, kVerdictKnots>& penalties,
               double value) {
  if (!(value > knots.front())) return penalties.front();
  for (std::size_t k = 1; k < knots.size(); ++k) {
    if (value >= knots[k]) continue;
    return penalties[k - 1] + (penalties[k] - penalties[k - 1]) * (value - knots[k - 1]) / (knots[k] - knots[k - 1]);
  }
  return penalties.back();
}

// Returns the sentence of the heaviest fact without which the verdict would be positive, else of the heaviest fact.
// With against_flame it denies a flame, unless the fact is a burning object's shape: overexposed flames have any shape.
std::string reason_of(const std::vector<WeighedFact>& facts, double WeighedFact::*weight, double odds, R r) {
  const auto heavier = [&](const WeighedFact& a, const WeighedFact& b) {
    return std::pair(odds + a.*weight > 0, a.*weight) < std::pair(odds + b.*weight > 0, b.*weight);
  };
  const WeighedFact& found = *std::max_element(facts.begin(), facts.end(), heavier);
  const auto row =
      std::find_if(kFacts.begin(), kFacts.end(), [&](const FactRow& one) { return one.name == found.name; });
  const bool none = weight == &WeighedFact::against_flame && (row->sentence != kShape || !r.facts.burns);
  return (none ? "there is no flame in the film: " : "") +
         sentence_of(static_cast<std::size_t>(row - kFacts.begin()), r);
}

std::string verdict_sentence(CaptureReport& report) {
  const std::vector<WeighedFact> facts = weighed_facts(report);
  double flame = kFlameOdds, right = kRightOdds;
  for (const WeighedFact& fact : facts) {
    flame -= fact.against_flame;
    right -= fact.against_right;
  }
  report.likely_flame = report.flames == 0 ? 1 : 1 / (1 + std::exp(-flame));
  report.likely_right = 1 / (1 + std::exp(-right));
  report.usable = right > 0;
  if (report.usable) {
    return "an outline was found in " + percent(1 - missing_share(report)) + " of the frames and moves steadily";
  }
  // Repeated or lost frames preclude film_reason(): the jumps between frames would look like a moving camera.
  const bool frames = report.facts.lost > kIrregular || report.facts.stands > 1;
  const auto film = frames || report.flames == 0 ? std::nullopt : film_reason(report.facts.film);
  if (film) return *film;
  if (report.likely_flame > 0.5 && report.facts.lost > kIrregular) return sentence_of(kLost, report);
  if (report.likely_flame > 0.5) return reason_of(facts, &WeighedFact::against_right, right, report);
  return reason_of(facts, &WeighedFact::against_flame, flame, report);
}

}  // namespace

// Where any object was requested, the flame model's penalties count against the outline.
std::vector<WeighedFact> weighed_facts(const CaptureReport& report) {
  std::vector<WeighedFact> out;
  const auto values = values_of(report);
  for (std::size_t k = 0; k < kFacts.size(); ++k) {
    const bool any = report.flames == 0;
    if (any && kFacts[k].of == Of::kFlame) continue;
    const VerdictCurve& curve = kVerdictCurves[k];
    const double flame = against(curve.knots, curve.against_flame, values[k]),
                 right = against(curve.knots, curve.against_right, values[k]);
    out.push_back({kFacts[k].name, values[k], any ? 0 : flame, any ? flame + right : right});
  }
  return out;
}

void judge_outline(CaptureReport& report) {
  report.reason = verdict_sentence(report);
  const OutlineFacts& facts = report.facts;
  if (static_cast<double>(facts.seen_from) > 0.3 * report.rate_hz) {
    report.reason += "; it is seen from frame " + std::to_string(facts.seen_from + report.first_frame) + " on";
  }
  if (report.flames > 1) report.reason += "; there are " + std::to_string(report.flames) + " flames, one is followed";
  if (report.out_at && facts.other_after == 0)
    report.reason += "; the flame is out from frame " + std::to_string(*report.out_at + report.first_frame) + " on";
}

void excuse_absence(CaptureReport& report, std::size_t rows, std::size_t times) {
  report.facts.blown = std::min(rows, report.facts.absent);
  if (report.facts.blown == 0) return;
  judge_outline(report);
  report.reason += "; it is blown out and lit again " + (times == 1 ? "once" : std::to_string(times) + " times");
}

}  // namespace wisp
