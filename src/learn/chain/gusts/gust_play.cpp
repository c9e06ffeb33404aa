#include "learn/chain/gusts/gust_play.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain {
namespace {

void add_direction(const std::string& id, const GustDirection& direction, const std::string& label,
                   ReportSection& section) {
  arx::add(section, id + ".median", direction.median, label + "direction off by, median", "degrees");
  arx::add(section, id + ".mean", direction.mean, label + "direction off by, mean", "degrees");
  arx::add(section, id + ".mean_clear", direction.mean_clear, label + "direction off by, clear gusts", "degrees",
           "mean over gusts whose displacement stands out of chance");
}

// Appends a point with NaN as y, which breaks the line.
void add_break(ReportSeries& out) {
  out.x.push_back(out.x.back());
  out.y.push_back(kMissing);
}

// Appends the parts of a path, relative to its first point, in which the wind blows (or not), with breaks between.
void add_way(const std::vector<Triple>& way, const std::vector<bool>& blows, bool in_wind, ReportSeries& out) {
  const auto point = [&](std::size_t row) {
    out.x.push_back(100 * (way[row][0] - way.front()[0]));
    out.y.push_back(100 * (way[row][1] - way.front()[1]));
  };
  bool drawing = false;
  for (std::size_t row = 0; row + 1 < way.size(); ++row) {
    if (blows[row] == in_wind) {
      if (!drawing) point(row);
      point(row + 1);
    } else if (drawing) {
      add_break(out);
    }
    drawing = blows[row] == in_wind;
  }
  if (drawing) add_break(out);
}

using Places = std::vector<std::vector<Triple>>;  // positions per clone and row

std::vector<Triple> mean_of(const Places& ways) {
  std::vector<Triple> mean(ways.front().size());
  for (const auto& way : ways) {
    for (std::size_t row = 0; row < mean.size(); ++row) {
      for (std::size_t axis = 0; axis < 3; ++axis) mean[row][axis] += way[row][axis] / static_cast<double>(ways.size());
    }
  }
  return mean;
}

void add_side(const std::string& id, const Places& ways, const std::vector<Triple>& calm,
              const std::vector<bool>& blows, ReportSection& section) {
  const auto series = [&](const char* what, const char* label) {
    return ReportSeries{id + "." + what, label, "x, cm", "y, cm", {}, {}};
  };
  const std::vector<Triple> mean = mean_of(ways);
  for (const bool in_wind : {false, true}) {
    ReportSeries clones = series(in_wind ? "clones_in_wind" : "clones", "");
    for (const auto& way : ways) add_way(way, blows, in_wind, clones);
    section.series.push_back(std::move(clones));
  }
  ReportSeries still = series("calm", "without wind");
  add_way(calm, std::vector<bool>(calm.size(), false), false, still);
  section.series.push_back(std::move(still));
  for (const bool in_wind : {true, false}) {
    ReportSeries whole = series(in_wind ? "mean_in_wind" : "mean", in_wind ? "while the wind blows" : "after it");
    add_way(mean, blows, in_wind, whole);
    section.series.push_back(std::move(whole));
  }
}

constexpr double kLaterSeconds = 2;  // time after the gust at which the effect should have vanished
constexpr double kMaxLeft = 0.1;     // m/s: a larger left_after counts as divergence
constexpr double kClearErrors = 4;   // standard errors: a longer mean displacement has a significant direction

// Two banks with equal seeds, one in the wind and one in calm air.
struct Twins {
  Bank windy;
  Bank calm;
};

Result<Bank> full_bank(const Model& model, std::size_t clones, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = static_cast<int>(clones), .seed = seed});
  if (!bank) return bank;
  for (std::size_t k = 0; k < clones; ++k) bank->spawn();
  return bank;
}

BodyMoment moment_of(const MotionPiece& piece, std::size_t row) {
  BodyMoment body;
  for (std::size_t k = 0; k < 3; ++k) {
    body.position[k] = static_cast<float>(piece.position[row][k]);
    body.velocity[k] = static_cast<float>(piece.velocity[row][k]);
    if (!piece.spin.empty()) body.spin[k] = static_cast<float>(piece.spin[row][k]);
  }
  for (std::size_t k = 0; k < piece.orientation.size() && k < 4; ++k) {
    body.orientation[k] = static_cast<float>(piece.orientation[row][k]);
  }
  return body;
}

// Appends the position of every clone to its path.
void take_places(const Bank& bank, Places& ways) {
  const auto count = static_cast<std::size_t>(bank.output_count());
  std::vector<float> outputs(ways.size() * count);
  bank.outputs(outputs);
  for (std::size_t k = 0; k < ways.size(); ++k) {
    ways[k].push_back({outputs[k * count], outputs[k * count + 1], outputs[k * count + 2]});
  }
}

struct Ways {
  Places windy;
  Places calm;
  double left = 0;  // m/s, maximum velocity difference over clones at the end
};

// Plays a gust on the clones of one fall, from its onset to the span's end, followed by kLaterSeconds of calm.
Ways played(Twins& twins, const GustPairs& pairs, std::size_t gust, const GustSpan& span) {
  Ways ways{Places(pairs.clones), Places(pairs.clones)};
  const std::size_t first = gust * pairs.clones;
  for (std::size_t k = 0; k < pairs.clones; ++k) {
    const BodyMoment body = moment_of(pairs.calm.pieces[first + k], span.onset);
    for (Bank* bank : {&twins.windy, &twins.calm}) bank->chain()->place(bank->at(static_cast<int>(k)), body);
  }
  take_places(twins.windy, ways.windy);
  take_places(twins.calm, ways.calm);
  std::vector<float> wind(3 * pairs.clones);
  const auto later = static_cast<std::size_t>(std::lround(kLaterSeconds * pairs.windy.rate_hz));
  for (std::size_t row = span.onset + 1; row < span.end + later; ++row) {
    for (std::size_t k = 0; k < pairs.clones; ++k) {
      const Triple now = row < span.end ? pairs.wind_at(first + k, row) : Triple{};
      for (std::size_t axis = 0; axis < 3; ++axis) wind[3 * k + axis] = static_cast<float>(now[axis]);
    }
    twins.windy.set_inputs(wind);
    twins.windy.step();
    twins.calm.step();
    take_places(twins.windy, ways.windy);
    take_places(twins.calm, ways.calm);
  }
  for (std::size_t k = 0; k < pairs.clones; ++k) {
    const std::size_t last = ways.windy[k].size() - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto apart = [&](std::size_t row) { return ways.windy[k][row][axis] - ways.calm[k][row][axis]; };
      ways.left = std::max(ways.left, std::abs(apart(last) - apart(last - 1)) * pairs.windy.rate_hz);
    }
    ways.windy[k].resize(span.rows());
    ways.calm[k].resize(span.rows());
  }
  return ways;
}

// Mean displacement by the wind in a play, per row since the onset.
std::vector<Triple> displacements(const Ways& ways) {
  std::vector<Triple> out = mean_of(ways.windy);
  const std::vector<Triple> calm = mean_of(ways.calm);
  for (std::size_t row = 0; row < out.size(); ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) out[row][axis] -= calm[row][axis];
  }
  return out;
}

double length_over_ground(const Triple& v) { return std::hypot(v[0], v[1]); }

struct Angles {
  std::vector<double> all;
  std::vector<double> clear;

  GustDirection direction() const {
    if (all.empty()) return {kMissing, kMissing, kMissing};
    return {median(all), mean(all), clear.empty() ? kMissing : mean(clear)};
  }
};

struct FitSums {
  double error = 0, size = 0;

  void add(const Triple& found, const Triple& expected) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      error += std::pow(found[axis] - expected[axis], 2);
      size += expected[axis] * expected[axis];
    }
  }
  double fit_percent() const { return size > 0 ? 100 * (1 - std::sqrt(error / size)) : 0; }
};

// Angle in the horizontal plane between two displacements, degrees.
double degrees_between(const Triple& a, const Triple& b) {
  const double across = a[0] * b[1] - a[1] * b[0], along = a[0] * b[0] + a[1] * b[1];
  return std::abs(std::atan2(across, along)) * 180 / std::acos(-1.0);
}

struct Tally {
  FitSums displacement, velocity, halves;
  Angles angles, half_angles;
};

void judge(const GustEnsemble& recorded, const std::vector<Triple>& place, double rate_hz, bool clear, Tally& tally) {
  for (std::size_t row = 0; row < place.size(); ++row) {
    tally.displacement.add(place[row], recorded.displacement[row]);
    if (row == 0) continue;
    Triple change{};
    for (std::size_t axis = 0; axis < 3; ++axis) change[axis] = (place[row][axis] - place[row - 1][axis]) * rate_hz;
    tally.velocity.add(change, recorded.change[row]);
  }
  const double angle = degrees_between(recorded.displacement.back(), place.back());
  tally.angles.all.push_back(angle);
  if (clear) tally.angles.clear.push_back(angle);
}

void judge_halves(const GustPairs& pairs, std::size_t gust, const GustSpan& span, bool clear, Tally& tally) {
  const GustEnsemble a = ensemble_of(pairs, gust, span, 0, 2), b = ensemble_of(pairs, gust, span, 1, 2);
  for (std::size_t row = 0; row < a.displacement.size(); ++row)
    tally.halves.add(a.displacement[row], b.displacement[row]);
  const double angle = degrees_between(a.displacement.back(), b.displacement.back());
  tally.half_angles.all.push_back(angle);
  if (clear) tally.half_angles.clear.push_back(angle);
}

GustScene scene_of(const GustPairs& pairs, std::size_t gust, const GustSpan& span, Ways ways) {
  GustScene scene{.gust = gust};
  Places calm;
  for (std::size_t k = gust * pairs.clones; k < (gust + 1) * pairs.clones; ++k) {
    const auto part = [&](const MotionPiece& piece) {
      const auto begin = piece.position.begin();
      return std::vector<Triple>(begin + static_cast<long>(span.onset), begin + static_cast<long>(span.end));
    };
    scene.recorded.push_back(part(pairs.windy.pieces[k]));
    calm.push_back(part(pairs.calm.pieces[k]));
  }
  for (std::size_t row = 0; row < span.rows(); ++row) {
    const Triple wind = pairs.wind_at(gust * pairs.clones, span.onset + row);
    const Triple& most = scene.strongest;
    const double speed = std::hypot(wind[0], wind[1], wind[2]);
    scene.blows.push_back(speed > 1e-3);
    if (speed > std::hypot(most[0], most[1], most[2])) scene.strongest = wind;
  }
  scene.recorded_calm = mean_of(calm);
  scene.played_calm = mean_of(ways.calm);
  scene.played = std::move(ways.windy);
  return scene;
}

// Scenes at equally spaced quantiles of displacement.
std::vector<GustScene> chosen(std::vector<std::pair<double, GustScene>>& scenes) {
  constexpr std::size_t kScenes = 2;
  std::stable_sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<GustScene> out;
  for (std::size_t k = 0; k < std::min(kScenes, scenes.size()); ++k) {
    out.push_back(std::move(scenes[(2 * k + 1) * scenes.size() / (2 * kScenes)].second));
  }
  return out;
}

GustPlayFigures figures_of(const Tally& tally, GustPlayFigures figures) {
  figures.fit_percent = tally.displacement.fit_percent();
  figures.velocity_fit_percent = tally.velocity.fit_percent();
  figures.direction = tally.angles.direction();
  figures.clear_gusts = tally.angles.clear.size();
  const bool halves = figures.clones >= 4;
  figures.halves_fit_percent = halves ? tally.halves.fit_percent() : kMissing;
  figures.halves_direction = tally.half_angles.direction();
  figures.diverges = !std::isfinite(figures.largest_displacement) || !std::isfinite(figures.left_after) ||
                     figures.left_after > kMaxLeft;
  return figures;
}

Result<void> check(const Model& model, const GustPairs& pairs) {
  const auto* chain = std::get_if<ChainModel>(&model.dynamics);
  if (!chain || !chain->gust) {
    return Error{pairs.source +
                 ": has gusts, but the model has no response to them; learn it with a windy recording and its "
                 "calm twin"};
  }
  if (!same_rate(pairs.windy.rate_hz, model.rate_hz)) {
    return Error{pairs.source + ": has " + std::to_string(pairs.windy.rate_hz) + " rows a second, the model " +
                 std::to_string(model.rate_hz) + ": resample the recording"};
  }
  if (pairs.calm.has_orientation != (chain->motion == ChainMotion::kPose))
    return Error{pairs.source + ": either its calm twin or the model has orientation, expected both or neither"};
  return {};
}

}  // namespace

ReportSection gusts_section(const GustPlayFigures& figures) {
  ReportSection section{"Gusts, played from where each calm fall is at the onset"};
  arx::add(section, "gusts.gusts", figures.gusts, "gusts");
  arx::add(section, "gusts.clear_gusts", figures.clear_gusts, "clear ones", "",
           "whose displacement stands out of chance");
  arx::add(section, "gusts.clones", figures.clones, "clones of each");
  arx::add(section, "gusts.fit_percent", figures.fit_percent, "displacement fits by", "%", "mean over clones");
  arx::add(section, "gusts.velocity_fit_percent", figures.velocity_fit_percent, "velocity fits by", "%");
  add_direction("gusts.direction_degrees", figures.direction, "", section);
  arx::add(section, "gusts.halves.fit_percent", figures.halves_fit_percent, "half the clones: displacement fits by",
           "%", "the other half's, as recorded");
  add_direction("gusts.halves.direction_degrees", figures.halves_direction, "half the clones: ", section);
  arx::add(section, "gusts.largest_displacement", figures.largest_displacement, "carried at most", "m");
  arx::add(section, "gusts.largest_recorded_displacement", figures.largest_recorded_displacement, "  recorded", "m");
  arx::add(section, "gusts.left_after", figures.left_after, "left after two seconds", "m/s");
  arx::add(section, "gusts.diverges", figures.diverges, "diverges");
  return section;
}

ReportSection scene_section(const GustScene& scene, std::size_t number) {
  const double degrees = std::atan2(scene.strongest[1], scene.strongest[0]) * 180 / std::acos(-1.0);
  ReportSection section{"gust " + std::to_string(scene.gust + 1) + ", " +
                        number_text(std::hypot(scene.strongest[0], scene.strongest[1]), 2) + " m/s towards " +
                        std::to_string(std::lround(degrees)) + "°"};
  const std::string id = "gusts-above." + std::to_string(number);
  add_side(id + ".recorded", scene.recorded, scene.recorded_calm, scene.blows, section);
  add_side(id + ".played", scene.played, scene.played_calm, scene.blows, section);
  return section;
}

Result<GustPlay> play_gusts(const Model& model, const GustPairs& pairs, std::size_t first, std::uint64_t seed) {
  if (auto ok = check(model, pairs); !ok) return ok.error();
  auto blown = full_bank(model, pairs.clones, seed), still = full_bank(model, pairs.clones, seed);
  if (!blown) return blown.error();
  if (!still) return still.error();
  Twins twins{std::move(*blown), std::move(*still)};
  Tally tally;
  GustPlayFigures figures{.clones = pairs.clones};
  std::vector<std::pair<double, GustScene>> scenes;
  for (std::size_t gust = first; gust < pairs.gusts(); ++gust) {
    const GustSpan span = span_of(pairs, gust);
    if (span.rows() < 3) continue;
    const GustEnsemble recorded = ensemble_of(pairs, gust, span);
    Ways ways = played(twins, pairs, gust, span);
    const auto place = displacements(ways);
    const double carried = length_over_ground(recorded.displacement.back());
    const bool clear = carried > kClearErrors * recorded.displacement_error;
    judge(recorded, place, pairs.windy.rate_hz, clear, tally);
    if (pairs.clones >= 4) judge_halves(pairs, gust, span, clear, tally);
    ++figures.gusts;
    figures.left_after = std::max(figures.left_after, ways.left);
    figures.largest_displacement = std::max(figures.largest_displacement, length_over_ground(place.back()));
    figures.largest_recorded_displacement = std::max(figures.largest_recorded_displacement, carried);
    scenes.emplace_back(carried, scene_of(pairs, gust, span, std::move(ways)));
  }
  if (figures.gusts == 0) return Error{pairs.source + ": no wind blows in the gusts that are to be judged"};
  return GustPlay{figures_of(tally, figures), chosen(scenes)};
}

}  // namespace wisp::chain
