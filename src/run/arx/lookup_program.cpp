#include "run/arx/lookup_program.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "run/state/channels.hpp"

namespace wisp {
namespace {

// Chosen on four films (docs/studies/still-flames.md): from a jump to the next at least and at most; rows to which
// no jump leads; how far ahead the play of a place is counted; and what that weighs beside distances.
constexpr double kShortestSeconds = 0.4;
constexpr double kLongestSeconds = 1.2;
constexpr double kBesideSeconds = 0.3;
constexpr double kRecentSeconds = 0.7;
constexpr double kAheadSeconds = 0.5;
constexpr double kCoverage = 2;
constexpr double kMaxSteps = 1e6;
constexpr double kMaxPosition = 1e6;

std::uint32_t steps_of(double seconds, const Model& model) {
  return static_cast<std::uint32_t>(std::clamp(std::round(seconds * model.rate_hz), 1.0, kMaxSteps));
}

// Rows × outputs: deviations from the operating point as each row is played, after the rows of its stretch before it.
std::vector<double> states_of(const ArxModel& arx, std::span<const std::uint32_t> left) {
  const ResampledResiduals& resampled = arx.noise.resampled;
  const auto ny = static_cast<std::size_t>(arx.orders.outputs());
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

// How much each component of the state moves what is seen.
std::vector<double> weights_of(const Model& model, std::size_t count) {
  const auto* view = std::get_if<OutlineView>(&model.view);
  if (!view || view->shape.empty()) return std::vector<double>(count, 1.0);
  const ShapeComponents& shape = view->shape;
  std::vector<double> squares(count, 0.0);
  std::size_t at = 0;
  for (std::size_t i = 0; i < shape.rest.size(); ++i) {
    const bool symmetric = i < shape.points();
    const std::size_t first = symmetric ? 0 : shape.symmetric, end = symmetric ? shape.symmetric : shape.count();
    for (std::size_t k = first; k < end; ++k, ++at) squares[k] += shape.basis[at] * shape.basis[at];
  }
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

void fill_positions(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                    LookupProgram& program) {
  const auto ny = static_cast<std::size_t>(arx.orders.outputs()), traits = static_cast<std::size_t>(program.traits);
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

// Rows after which as many follow as the shortest block has, or as the longest stretch has; of many those at even
// distances.
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

}  // namespace

LookupProgram make_lookup_program(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                                  Arena& arena) {
  const ResampledResiduals& resampled = arx.noise.resampled;
  const auto rows = static_cast<std::uint32_t>(resampled.row_count());
  LookupProgram program;
  program.traits = std::min(arx.orders.outputs(), kMaxTraits);
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

}  // namespace wisp
