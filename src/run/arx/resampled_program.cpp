#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "run/arx/resampled_program.hpp"
#include "run/state/channels.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMaxUnits = 1e9;      // bound on a residual or wind in channel units: no sum overflows
constexpr std::uint32_t kMinLeft = 6;  // minimum number of rows after a jump target, if any row has that many

float bounded(double value) {
  if (std::abs(value) < kMinCoefficient) return 0.0f;
  return static_cast<float>(std::clamp(value, -kMaxUnits, kMaxUnits));
}

// Calls visit(row, left, stretch) for every row; `left`: number of rows that follow in its stretch.
template <class Visit>
void each_row(const ResampledResiduals& resampled, Visit visit) {
  std::uint32_t begin = 0, stretch = 0;
  for (std::uint32_t end : resampled.ends) {
    for (std::uint32_t row = begin; row < end; ++row) visit(row, end - 1 - row, stretch);
    begin = end;
    ++stretch;
  }
}

std::uint32_t max_left(const ResampledResiduals& resampled) {
  std::uint32_t most = 0;
  each_row(resampled, [&](std::uint32_t, std::uint32_t left, std::uint32_t) { most = std::max(most, left); });
  return std::min(most, kMinLeft);
}

std::size_t count_targets(const ResampledResiduals& resampled) {
  const std::uint32_t least = max_left(resampled);
  std::size_t count = 0;
  each_row(resampled, [&](std::uint32_t, std::uint32_t left, std::uint32_t) { count += left >= least ? 1 : 0; });
  return count;
}

std::size_t count_nodes(std::size_t rows) {
  std::size_t leaves = 1;
  while ((rows + leaves - 1) / leaves > kCandidates) leaves *= 2;
  return leaves - 1;
}

// Fills in all that depends on the input: the lags, `now` and `turned`; in the regressor's channel units, tolerance,
// margin and recorded inputs (deviations from the regressor's mean).
void fill_winds(const Model& model, const ArxModel& arx, const ResampledResiduals& resampled,
                ResampledProgram& program) {
  const double unit = resampled.wind_scale / regressor_scale(model, resampled.toward);
  const double mean = arx.input_mean[resampled.toward] / regressor_scale(model, resampled.toward);
  for (std::size_t k = 0; k < program.wind.size(); ++k) program.wind[k] = bounded(resampled.winds[k] * unit - mean);
  const auto lags = static_cast<double>(resampled.lags.size());
  program.tolerance = bounded(lags * resampled.tolerance / regressor_scale(model, resampled.toward));
  program.margin = bounded(resampled.margin / regressor_scale(model, resampled.toward));
  std::copy(resampled.lags.begin(), resampled.lags.end(), program.lags.begin());
  const auto before = static_cast<std::uint32_t>(program.depth - 1);
  each_row(resampled, [&](std::uint32_t row, std::uint32_t, std::uint32_t stretch) {
    program.now[row] = row + (stretch + 1) * before;
    float sum = 0;
    for (std::uint32_t lag : program.lags) sum = sum + program.wind[program.now[row] - lag];
    program.turned[row] = program.mirrors() && sum < 0 ? 1 : 0;
  });
}

// Builds a balanced k-d tree (J. L. Bentley, Communications of the ACM 18 (1975)) over the rows' input pasts.
class PastTree {
 public:
  explicit PastTree(ResampledProgram& program) : program_(program) {}

  void fill(std::size_t node, std::size_t begin, std::size_t end) {
    if (node >= program_.nodes.size()) return;
    const std::uint32_t lag = widest(begin, end);
    // Rows of equal input are shuffled, so that a leaf holds calm rows of several stretches: calm rows of one stretch
    // may all be excluded as just played. Heap sort takes little code and no memory.
    const auto scattered = [](std::uint32_t row) { return row * 0x9E3779B1U; };
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const float x = past(a, lag), y = past(b, lag);
      return x < y || (x == y && scattered(a) < scattered(b));
    };
    const auto first = program_.order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = program_.order.begin() + static_cast<std::ptrdiff_t>(end);
    std::make_heap(first, last, before);
    std::sort_heap(first, last, before);
    const std::size_t middle = begin + (end - begin) / 2;
    const float low = past(program_.order[middle - 1], lag);
    const float high = past(program_.order[middle], lag);
    program_.nodes[node] = {0.5f * (low + high), lag};
    fill(2 * node + 1, begin, middle);
    fill(2 * node + 2, middle, end);
  }

 private:
  float past(std::uint32_t row, std::uint32_t lag) const {
    const float wind = program_.wind[program_.now[row] - program_.lags[lag]];
    return program_.turned[row] != 0 ? -wind : wind;
  }

  std::uint32_t widest(std::size_t begin, std::size_t end) const {
    std::uint32_t best = 0;
    float most = -1;
    for (std::uint32_t lag = 0; lag < program_.lags.size(); ++lag) {
      float lowest = past(program_.order[begin], lag), highest = lowest;
      for (std::size_t k = begin; k < end; ++k) {
        const float value = past(program_.order[k], lag);
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
      }
      if (!(highest - lowest > most)) continue;
      most = highest - lowest;
      best = lag;
    }
    return best;
  }

  ResampledProgram& program_;
};

// Fills in the leaves below a node, whose rows are order[begin … end): all data of a comparison are contiguous.
void fill_leaves(ResampledProgram& program, std::size_t node, std::size_t begin, std::size_t end) {
  if (node < program.nodes.size()) {
    const std::size_t middle = begin + (end - begin) / 2;
    fill_leaves(program, 2 * node + 1, begin, middle);
    fill_leaves(program, 2 * node + 2, middle, end);
    return;
  }
  const std::size_t leaf = node - program.nodes.size(), lags = program.lags.size();
  Candidates& candidates = program.leaves[leaf];
  candidates.count = static_cast<std::uint32_t>(end - begin);
  const auto winds = program.leaf_wind.subspan(leaf * lags * kCandidates, lags * kCandidates);
  std::fill(winds.begin(), winds.end(), std::numeric_limits<float>::infinity());
  for (std::size_t k = 0; k < candidates.count; ++k) {
    const std::uint32_t row = program.order[begin + k];
    const bool turned = program.turned[row] != 0;
    candidates.row[k] = static_cast<float>(row);
    candidates.place[k] = 2 * row + (turned ? 1 : 0);
    for (std::size_t lag = 0; lag < lags; ++lag) {
      const float wind = program.wind[program.now[row] - program.lags[lag]];
      winds[lag * kCandidates + k] = turned ? -wind : wind;
    }
  }
}

void fill_tree(const ResampledResiduals& resampled, ResampledProgram& program) {
  const std::uint32_t least = max_left(resampled);
  std::size_t next = 0;
  each_row(resampled, [&](std::uint32_t row, std::uint32_t left, std::uint32_t) {
    if (left >= least) program.order[next++] = row;
  });
  PastTree(program).fill(0, 0, program.order.size());
  fill_leaves(program, 0, 0, program.order.size());
}

void fill_rows(const Model& model, const ResampledResiduals& resampled, ResampledProgram& program) {
  const std::vector<ValueRange> ranges = moved_ranges(model);
  for (std::size_t k = 0; k < resampled.rows.size(); ++k) {
    const std::size_t i = k % resampled.scale.size();
    const double unit = channel_scale(ranges[i].lowest, ranges[i].highest);
    program.rows[k] = bounded(resampled.rows[k] * (resampled.scale[i] / unit));
  }
  each_row(resampled, [&](std::uint32_t row, std::uint32_t left, std::uint32_t) { program.left[row] = left; });
}

void fill_sides(const Model& model, const ResampledResiduals& resampled, ResampledProgram& program) {
  const auto ny = static_cast<std::size_t>(program.columns());
  const std::vector<ValueRange> ranges = moved_ranges(model);
  const auto unit = [&](std::size_t i) { return channel_scale(ranges[i].lowest, ranges[i].highest); };
  for (std::size_t k = 0; k < program.unit.size(); ++k) {
    program.unit[k] = bounded(unit(ny - program.unit.size() + k) / unit(ny + k));
  }
  for (std::size_t i = 0; i < ny; ++i) {
    program.from[i] = static_cast<std::uint16_t>(i);
    program.factor[i] = 1.0f;
  }
  for (std::size_t i = 0; program.mirrors() && i < resampled.mirror.size(); ++i) {
    const auto from = static_cast<std::size_t>(std::abs(resampled.mirror[i]) - 1);
    program.from[ny + i] = static_cast<std::uint16_t>(from);
    program.factor[ny + i] = bounded((resampled.mirror[i] < 0 ? -1 : 1) * unit(from) / unit(i));
  }
  if (!program.mirrors()) return;
  // Units are powers of two, so mirroring here gives the same bits as mirroring during play.
  const std::size_t half = program.rows.size() / 2;
  for (std::size_t row = 0; row < half; row += ny) {
    for (std::size_t i = 0; i < ny; ++i) {
      program.rows[half + row + i] = program.factor[ny + i] * program.rows[row + program.from[ny + i]];
    }
  }
}

// Values chosen on four films (docs/studies/still-flames.md).
constexpr double kShortestSeconds = 0.4;  // least time between jumps
constexpr double kLongestSeconds = 1.2;   // greatest time between jumps
constexpr double kBesideSeconds = 0.3;    // rows within this time of the next recorded row are no jump targets
constexpr double kRecentSeconds = 0.7;    // rows played within this time before a jump are no targets
constexpr double kAheadSeconds = 0.5;     // usage of a target: play counts at 1/4 and 3/4 of this time after the target
constexpr double kCoverage = 2;           // cost of usage if all rows are played equally often
constexpr double kMaxSteps = 1e6;
constexpr double kMaxPosition = 1e6;

std::uint32_t steps_of(double seconds, const Model& model) {
  return static_cast<std::uint32_t>(std::clamp(std::round(seconds * model.rate_hz), 1.0, kMaxSteps));
}

// Returns the outputs' deviations (rows × outputs) when each stretch is played from its first row on, beginning at 0.
std::vector<double> states_of(const ArxModel& arx, std::span<const std::uint32_t> left) {
  const ResampledResiduals& resampled = arx.noise.resampled;
  const std::size_t ny = resampled.scale.size();
  std::vector<double> out(resampled.rows.size());
  std::size_t begin = 0;
  for (std::size_t row = 0; row < left.size(); ++row) {
    for (std::size_t i = 0; i < ny; ++i) {
      double sum = arx.constant[i] + resampled.rows[row * ny + i] * resampled.scale[i];
      for (std::size_t j = 0; j < ny; ++j) {
        const auto past = arx.a(static_cast<int>(i), static_cast<int>(j));
        for (std::size_t lag = 1; lag <= past.size() && lag <= row - begin; ++lag) {
          sum = sum - past[lag - 1] * out[(row - lag) * ny + j];
        }
      }
      out[row * ny + i] = sum;
    }
    if (left[row] == 0) begin = row + 1;
  }
  return out;
}

// Returns how far a unit of each output moves the outline: the norm of its basis vector; 1 for a model without a shape.
std::vector<double> weights_of(const Model& model, std::size_t count) {
  const auto* view = std::get_if<OutlineView>(&model.view);
  if (!view || view->shape.empty()) return std::vector<double>(count, 1.0);
  const ShapeComponents& shape = view->shape;
  std::vector<double> squares(count, 0.0);
  std::size_t at = 0;
  for (std::size_t i = 0; i < 2 * shape.points(); ++i) {
    const bool symmetric = i < shape.points();
    const std::size_t first = symmetric ? 0 : shape.symmetric,
                      end = shape.symmetric + (symmetric ? 0 : shape.antisymmetric);
    for (std::size_t k = first; k < end; ++k, ++at) squares[k] += shape.basis[at] * shape.basis[at];
  }
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

void fill_positions(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                    LookupProgram& program) {
  const std::size_t ny = arx.noise.resampled.scale.size(), traits = static_cast<std::size_t>(program.traits);
  const std::vector<double> states = states_of(arx, left), weights = weights_of(model, ny);
  const auto rows = static_cast<double>(left.size());
  std::vector<double> variance(ny);
  double position = 0, speed = 0;
  for (std::size_t k = 0; k < ny; ++k) {
    double sum = 0, square = 0, steps = 0;
    for (std::size_t row = 0; row < left.size(); ++row) {
      const double value = weights[k] * states[row * ny + k];
      sum = sum + value;
      square = square + value * value;
      if (left[row] == 0) continue;
      const double step = weights[k] * states[(row + 1) * ny + k] - value;
      steps = steps + step * step;
    }
    variance[k] = std::max(0.0, square / rows - sum / rows * (sum / rows));
    position = position + variance[k];
    speed = speed + steps / rows;
  }
  std::vector<std::size_t> order(ny);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return variance[a] > variance[b]; });
  const double scale = position > 0 ? 1 / std::sqrt(position) : 0;
  program.quickness = speed > 0 ? static_cast<float>(std::min(std::sqrt(position / speed), kMaxSteps)) : 0;
  for (std::size_t row = 0; row < left.size(); ++row) {
    for (std::size_t k = 0; k < traits; ++k) {
      const double value = states[row * ny + order[k]] * weights[order[k]] * scale;
      program.position[row * traits + k] = static_cast<float>(std::clamp(value, -kMaxPosition, kMaxPosition));
    }
  }
}

// Returns the rows from which a stretch still has at least `shortest` rows, that row included (or as many as the
// longest stretch has), evenly subsampled to at most kMaxPlaces.
std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& ends, std::uint32_t shortest) {
  std::uint32_t longest = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) longest = std::max(longest, ends[k] - (k > 0 ? ends[k - 1] : 0));
  const std::uint32_t least = std::min(longest, shortest);
  std::vector<std::uint32_t> all, out;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    for (std::uint32_t row = k > 0 ? ends[k - 1] : 0; row + least <= ends[k]; ++row) all.push_back(row);
  }
  const std::size_t count = std::min<std::size_t>(all.size(), kMaxPlaces);
  for (std::size_t k = 0; k < count; ++k) out.push_back(all[k * all.size() / count]);
  return out;
}

void fill_places(const Model& model, std::span<const std::uint32_t> left, LookupProgram& program) {
  const std::uint32_t ahead = steps_of(kAheadSeconds, model);
  const auto rows = static_cast<std::uint32_t>(left.size()), traits = static_cast<std::uint32_t>(program.traits);
  for (std::uint32_t k = 0; k < program.places; ++k) {
    const std::uint32_t row = program.row[k];
    const std::uint32_t before = row > 0 && left[row - 1] > 0 ? row - 1 : row;
    program.ahead[2 * k] = static_cast<std::uint8_t>(std::min(row + ahead / 4, rows - 1) / program.part_rows);
    program.ahead[2 * k + 1] = static_cast<std::uint8_t>(std::min(row + 3 * ahead / 4, rows - 1) / program.part_rows);
    float* place = program.place.data() + k / kPlacesAtOnce * 2 * traits * kPlacesAtOnce + k % kPlacesAtOnce;
    for (std::uint32_t t = 0; t < traits; ++t) {
      const float at = program.position[before * traits + t];
      place[t * kPlacesAtOnce] = at;
      place[(traits + t) * kPlacesAtOnce] = program.quickness * (program.position[row * traits + t] - at);
    }
  }
}

// Compiles the lookup without a driving input. `left`: per row, how many follow in its stretch; empty while measuring.
LookupProgram make_lookup_program(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                                  Arena& arena) {
  const ResampledResiduals& resampled = arx.noise.resampled;
  const auto rows = static_cast<std::uint32_t>(resampled.row_count());
  LookupProgram program;
  program.traits = std::min(static_cast<int>(resampled.scale.size()), kMaxTraits);
  program.shortest = steps_of(kShortestSeconds, model);
  program.longest = steps_of(kLongestSeconds, model);
  program.beside = steps_of(kBesideSeconds, model);
  program.recent = steps_of(kRecentSeconds, model);
  const std::vector<std::uint32_t> places = places_of(resampled.ends, program.shortest);
  program.places = static_cast<std::uint32_t>(places.size());
  program.part_rows = (rows + kPlayedParts - 1) / kPlayedParts;
  program.coverage = static_cast<float>(kCoverage * rows / (2.0 * program.part_rows));
  const auto traits = static_cast<std::size_t>(program.traits);
  program.position = arena.take<float>(rows * traits);
  program.place = arena.take<float>(program.groups() * 2 * traits * kPlacesAtOnce);
  program.row = arena.take<std::uint32_t>(program.places);
  program.ahead = arena.take<std::uint8_t>(2 * static_cast<std::size_t>(program.places));
  if (arena.measures()) return program;
  std::copy(places.begin(), places.end(), program.row.begin());
  fill_positions(model, arx, left, program);
  fill_places(model, left, program);
  return program;
}

}  // namespace

ResampledProgram make_resampled_program(const Model& model, const ArxModel& arx, Arena& arena) {
  const ResampledResiduals& resampled = arx.noise.resampled;
  ResampledProgram program;
  if (resampled.empty()) return program;
  program.outputs = arx.orders.outputs();
  program.across = resampled.across;
  program.toward = resampled.toward;
  program.longest = static_cast<std::uint32_t>(resampled.longest);
  program.sides = resampled.mirror.empty() || !program.driven() ? 1 : 2;
  program.depth = resampled.lags.empty() ? 1 : static_cast<int>(resampled.lags.back()) + 1;
  const std::size_t rows = resampled.row_count(), past = program.driven() ? rows : 0;
  const std::size_t targets = program.driven() ? count_targets(resampled) : 0;
  program.lags = arena.take<std::uint32_t>(resampled.lags.size());
  const std::size_t numbers = static_cast<std::size_t>(program.sides) * resampled.rows.size();
  const auto padded = arena.take<float>(numbers + 3);  // rows are read four numbers at a time
  program.rows = padded.first(padded.empty() ? 0 : numbers);
  program.left = arena.take<std::uint32_t>(rows);
  program.wind = arena.take<float>(resampled.winds.size());
  program.now = arena.take<std::uint32_t>(past);
  program.turned = arena.take<std::uint8_t>(past);
  const std::size_t nodes = program.driven() ? count_nodes(targets) : 0, leaves = program.driven() ? nodes + 1 : 0;
  program.nodes = arena.take<PastNode>(nodes);
  program.leaves = arena.take<Candidates>(leaves);
  program.leaf_wind = arena.take<float>(leaves * resampled.lags.size() * kCandidates);
  program.order = arena.take<std::uint32_t>(targets);
  program.from = arena.take<std::uint16_t>(static_cast<std::size_t>(program.sides) * program.columns());
  program.factor = arena.take<float>(static_cast<std::size_t>(program.sides) * program.columns());
  program.unit = arena.take<float>(static_cast<std::size_t>(program.across));
  if (!arena.measures()) fill_rows(model, resampled, program);
  if (!program.driven()) {
    program.lookup = make_lookup_program(model, arx, program.left, arena);
    program.longest = program.lookup.longest;
  }
  if (arena.measures()) return program;
  fill_sides(model, resampled, program);
  if (!program.driven()) return program;
  fill_winds(model, arx, resampled, program);
  fill_tree(resampled, program);
  return program;
}

// The tree is determined by the other fields, so it is not hashed.
std::uint64_t hash_of(const ResampledProgram& program, std::uint64_t before) {
  if (program.empty()) return before;
  std::uint64_t hash = before;
  hash = hash_number(static_cast<std::uint32_t>(program.toward), hash);
  hash = hash_number(program.longest, hash);
  if (program.across > 0) hash = hash_number(static_cast<std::uint32_t>(program.across), hash);
  for (std::uint32_t lag : program.lags) hash = hash_number(lag, hash);
  for (std::uint32_t left : program.left) hash = hash_number(left, hash);
  for (std::uint16_t from : program.from) hash = hash_number(std::uint32_t{from}, hash);
  const float bounds[] = {program.tolerance, program.margin};
  for (const auto numbers :
       {std::span<const float>(bounds), std::span<const float>(program.rows).first(program.rows.size() / program.sides),
        std::span<const float>(program.wind), std::span<const float>(program.factor)}) {
    hash = hash_floats(numbers, hash);
  }
  return hash;
}

}  // namespace wisp
