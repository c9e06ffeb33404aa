#include "learn/chain/chain_fidelity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "learn/chain/chain_windows.hpp"
#include "learn/chain/motion/motion.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain {
namespace {

constexpr double kFlipMargin = 0.2;  // of the normal's height: nearer to the horizon, no side lies up

Recording empty_fall(const Model& model) {
  Recording fall;
  fall.source = "synthesized";
  fall.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs) fall.channels.push_back({output.name, output.unit, Role::kOutput, {}});
  return fall;
}

double flips_of(const MotionPiece& piece) {
  double flips = 0;
  int side = 0;
  for (const Quad& q : piece.orientation) {
    const double height = in_world_axes(q, {0, 0, 1})[2];
    if (std::abs(height) < kFlipMargin) continue;
    const int up = height > 0 ? 1 : -1;
    if (side != 0 && up != side) ++flips;
    side = up;
  }
  return flips;
}

FallFigures figures_of(const Motion& motion, std::span<const Segment> segments) {
  FallFigures figures;
  double seconds = 0, descent = 0, spread = 0, flips = 0, between = 0;
  for (const MotionPiece& piece : motion.pieces) {
    const Triple &from = piece.position.front(), &to = piece.position.back();
    seconds += static_cast<double>(piece.rows() - 1) / motion.rate_hz;
    descent += from[2] - to[2];
    spread += (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]);
    flips += flips_of(piece);
  }
  for (const Segment& one : segments) between += (one.end - one.begin) / motion.rate_hz;
  figures.descent_speed = descent / seconds;
  figures.lateral_spread = std::sqrt(spread / static_cast<double>(motion.pieces.size()));
  figures.event_seconds = between / static_cast<double>(segments.size());
  figures.flips_per_second = flips / seconds;
  return figures;
}

// Energy distance of two sets of series through windows of one length.
EnergyTest energy_of(std::span<const MotionSeries> reference, std::span<const MotionSeries> other, std::size_t rows,
                     const ChainFidelityOptions& options, std::size_t permutations) {
  FeatureWindows x = thinned(series_windows(reference, rows), options.max_windows);
  FeatureWindows y = thinned(series_windows(other, rows), options.max_windows);
  if (x.size() == 0 || y.size() == 0) return {std::numeric_limits<double>::quiet_NaN(), 1};
  standardise(x, y);
  return energy_test(x, y, permutations, options.seed);
}

// Every other fall to a side; a single one is cut in time.
std::array<std::vector<MotionSeries>, 2> halves_of(std::span<const MotionSeries> series) {
  std::array<std::vector<MotionSeries>, 2> halves;
  for (std::size_t k = 0; k < series.size(); ++k) halves[k % 2].push_back(series[k]);
  if (series.size() != 1) return halves;
  const MotionSeries& whole = series.front();
  const auto middle = whole.values.begin() + static_cast<long>(whole.rows() / 2 * whole.columns);
  halves[0] = {{whole.columns, {whole.values.begin(), middle}}};
  halves[1] = {{whole.columns, {middle, whole.values.end()}}};
  return halves;
}

// Between what two halves of the real falls differ by and what their rows in random order do.
Bounded compared(std::span<const MotionSeries> real, std::span<const MotionSeries> made, std::size_t rows,
                 const ChainFidelityOptions& options, double* p_value) {
  const EnergyTest test = energy_of(real, made, rows, options, p_value ? options.permutations : 0);
  if (p_value) *p_value = test.p_value;
  const auto halves = halves_of(real);
  return {test.distance, energy_of(halves[0], halves[1], rows, options, 0).distance,
          energy_of(real, shuffled(real, options.seed), rows, options, 0).distance};
}

}  // namespace

Result<MadeFalls> made_falls(const Model& model, int falls, std::size_t rows, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = falls, .seed = seed});
  if (!bank) return bank.error();
  for (int k = 0; k < falls; ++k) bank->spawn();
  const auto sides = static_cast<std::size_t>(falls);
  MadeFalls made{std::vector<Recording>(sides, empty_fall(model)), std::vector<std::vector<std::size_t>>(sides),
                 std::vector<std::vector<int>>(sides)};
  const std::size_t count = model.outputs.size();
  std::vector<float> outputs(static_cast<std::size_t>(falls) * count);
  const ChainFacet* chain = bank->chain();
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) bank->step();
    bank->outputs(outputs);
    for (std::size_t k = 0; k < made.falls.size(); ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        made.falls[k].channels[i].samples.push_back(outputs[k * count + i]);
      }
      if (!chain) continue;
      const ChainPlace place = *chain->place_of(bank->at(static_cast<int>(k)));
      made.modes[k].push_back(static_cast<int>(place.mode));
      if (row > 0 && place.step == 0) made.joins[k].push_back(row);
    }
  }
  return made;
}

Result<ChainFidelity> chain_fidelity(const Model& model, std::span<const Recording> real,
                                     const ChainFidelityOptions& options) {
  auto seen = motion_of(real, options.smooth_rows);
  if (!seen) return seen.error();
  if (std::abs(seen->rate_hz - model.rate_hz) > 1e-6 * model.rate_hz) {
    return Error{real.front().source + ": has " + std::to_string(seen->rate_hz) + " rows a second, the model " +
                 std::to_string(model.rate_hz) + ": resample the recording"};
  }
  auto cut = segment(*seen, real, options.segmentation);
  if (!cut) return cut.error();
  std::size_t longest = 0;
  for (const MotionPiece& piece : seen->pieces) longest = std::max(longest, piece.rows());
  const int falls = static_cast<int>(seen->pieces.size()) * options.synthesized_per_real;
  auto made = made_falls(model, falls, longest, options.seed);
  if (!made) return made.error();
  // A fall that was seen only so far is only so far compared.
  for (std::size_t k = 0; k < made->falls.size(); ++k) {
    made->falls[k] = slice(made->falls[k], 0, seen->pieces[k % seen->pieces.size()].rows());
  }
  auto played = motion_of(made->falls, options.smooth_rows);
  if (!played) return played.error();
  // What plays no events has no segments to compare, which is said of it.
  const auto played_cut = segment(*played, made->falls, options.segmentation);
  const std::vector<Segment> played_segments = played_cut ? played_cut->segments : std::vector<Segment>();
  ChainFidelity out;
  out.real = figures_of(*seen, cut->segments);
  out.synthesized = figures_of(*played, played_segments);
  const auto rows =
      static_cast<std::size_t>(std::lround(options.window_segments * out.real.event_seconds * model.rate_hz));
  out.window_seconds = static_cast<double>(rows) / model.rate_hz;
  const auto seen_series = motion_series(*seen, cut->segments);
  const auto played_series = motion_series(*played, played_segments);
  out.energy_distance =
      compared(seen_series, played_series, std::max<std::size_t>(2, rows), options, &out.energy_p_value);
  out.windows = std::min(series_windows(seen_series, std::max<std::size_t>(2, rows)).size(), options.max_windows);
  const auto long_rows = static_cast<std::size_t>(std::lround(kLongWindowSeconds * model.rate_hz));
  out.long_energy_distance = compared(seen_series, played_series, long_rows, options, nullptr);
  out.seconds = seconds_fidelity(*seen, *played, options.max_windows, options.seed);
  out.join_defect = join_defect(*seen, cut->segments, *played, made->joins);
  return out;
}

double longest_verbatim_seconds(const Model& model, std::span<const std::uint64_t> origin, std::size_t segments,
                                std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = 1, .seed = seed});
  if (!bank) return 0;
  const InstanceId id = bank->spawn();
  std::size_t steps = 0, run = 0, longest = 0, joined = 0;
  const ChainFacet& chain = *bank->chain();
  std::uint64_t before = origin[chain.place_of(id)->segment];
  while (joined < segments) {
    bank->step();
    ++steps;
    ++run;
    const auto place = *chain.place_of(id);
    if (place.step != 0) continue;
    ++joined;
    const std::uint64_t now = origin[place.segment];
    if (now != before + 1) run = 0;
    longest = std::max(longest, run);
    before = now;
  }
  return static_cast<double>(longest) / model.rate_hz;
}

}  // namespace wisp::chain
