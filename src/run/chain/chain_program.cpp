#include "run/chain/chain_program.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "run/chain/rigid.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kWords = 4294967296.0;  // 2^32
constexpr double kMinScale = 1e-12;
constexpr double kMaxScale = 1e6;
constexpr float kMinUnit = 1e-6f;
constexpr double kMaxStored = 32767;
constexpr double kReturnShare = 0.2;  // max_return as a share of the usual step: the return is then barely visible

void fill_thresholds(std::span<const double> probability, std::span<std::uint32_t> out) {
  double sum = 0;
  std::size_t last = 0;
  for (std::size_t mode = 0; mode < out.size(); ++mode) {
    sum += probability[mode];
    out[mode] = static_cast<std::uint32_t>(std::min(sum * kWords, kWords - 1));
    if (probability[mode] > 0) last = mode;
  }
  // The highest words belong to the last mode with positive probability, whatever the rounding of the sum.
  for (std::size_t mode = last; mode < out.size(); ++mode) out[mode] = 0xffffffffU;
}

// Returns the root-mean-square length, times `scale`, of the vectors at `offset` in each group of rates.
float unit_of(const ChainProgram& program, std::size_t offset, float scale) {
  const auto stride = static_cast<std::size_t>(program.rate_count);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = offset; k + 3 <= program.rates.size(); k += stride, ++count) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += static_cast<double>(program.rates[k + axis]) * program.rates[k + axis];
  }
  const auto unit = static_cast<float>(std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)))) * scale;
  return std::max(unit, kMinUnit);
}

// Returns the root-mean-square displacement from row to row, metres.
double usual_step(const ChainProgram& program) {
  double sum = 0;
  for (std::uint32_t segment = 0; segment < program.segments(); ++segment) {
    for (std::uint32_t row = program.first_row[segment]; row + 1 < program.first_row[segment + 1]; ++row) {
      const std::int16_t* at = program.rows.data() + static_cast<std::size_t>(row) * program.channels;
      for (std::size_t axis = 0; axis < 3; ++axis) sum += std::pow(at[program.channels + axis] - at[axis], 2);
    }
  }
  const auto steps = program.first_row[program.segments()] - program.segments();
  return program.position_scale * std::sqrt(sum / steps);
}

// Solves for the second differences a and b of the two halves, of m and n steps. The first difference begins at slope +
// a/2, then grows m − 1 times by a and n times by b. The sum of all first differences and the last slope are given.
ChainSpread spread_over(std::uint32_t steps) {
  const double m = first_half(steps), n = steps - m;
  const double way[] = {m * m / 2 + n * (m - 0.5), n * (n + 1) / 2}, slope[] = {m - 0.5, n + 0.5};
  const double whole = way[0] * slope[1] - way[1] * slope[0];
  const auto share = [&](double x) { return static_cast<float>(-x / whole); };
  return {{share(slope[1]), share(-slope[0])},
          {share(-way[1]), share(way[0])},
          steps > 1 ? static_cast<float>(-1.0 / (n + m - 1)) : 0.0f};
}

// Normalises stored quaternions to the length kMaxStored, which orientation_scale converts to 1.
void make_unit(ChainProgram& program) {
  for (std::size_t at = 3; at < program.rows.size(); at += 7) {
    std::int16_t* q = program.rows.data() + at;
    double square = 0;
    for (std::size_t k = 0; k < 4; ++k) square += static_cast<double>(q[k]) * q[k];
    const double factor = square > 0 ? kMaxStored / std::sqrt(square) : 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double x = factor * q[k];
      q[k] = static_cast<std::int16_t>(x < 0 ? x - 0.5 : x + 0.5);
    }
  }
}

// Fills in the change of the stored quaternion in half a step, at both ends of each segment.
void fill_changes(ChainProgram& program) {
  float* out = program.changes.data();
  for (std::uint32_t segment = 0; segment < program.segments(); ++segment) {
    for (std::uint32_t end : {0U, 1U}) {
      const std::uint32_t at = program.first_row[segment] + end * program.steps(segment);
      const std::int16_t* q = program.rows.data() + std::size_t{7} * at + 3;
      const std::int16_t* rate = program.rates.data() + std::size_t{6} * (std::size_t{2} * segment + end) + 3;
      Vector3<float> spin;
      for (std::size_t k = 0; k < 3; ++k) spin[k] = static_cast<float>(rate[k]) * program.spin_scale;
      Quaternion<float> orientation;
      for (std::size_t k = 0; k < 4; ++k) orientation[k] = static_cast<float>(q[k]);
      const auto change = scaled(quaternion_rate(spin, orientation), 0.5f * program.step_seconds);
      out = std::copy(change.begin(), change.end(), out);
    }
  }
}

GustProgram gust_program(const GustResponse& gust, double wind_unit) {
  const auto filled = [&](const GustResponse::Axis& axis) {
    return std::array{static_cast<float>(axis.change), static_cast<float>(axis.wind * wind_unit),
                      static_cast<float>(4 * axis.press * wind_unit)};
  };
  return {true, filled(gust.ground), filled(gust.vertical)};
}

void take_drift(const ChainDrift& drift, ChainProgram& program) {
  program.lead_scale = static_cast<float>(drift.lead_scale);
  for (std::size_t axis = 0; axis < 3; ++axis) program.drift[axis] = static_cast<float>(drift.drift[axis]);
  program.spread_ground = static_cast<float>(drift.spread_ground);
  program.spread_height = static_cast<float>(drift.spread_height);
  program.memory = static_cast<float>(drift.memory_seconds);
}

template <class Value>
std::span<Value> copy_of(const std::vector<Value>& values, Arena& arena, std::size_t beyond = 0) {
  const auto out = arena.take<Value>(values.size() + beyond);
  if (arena.measures()) return out;
  std::copy(values.begin(), values.end(), out.begin());
  return out.first(values.size());
}

}  // namespace

ChainProgram make_chain_program(const ChainModel& chain, double rate_hz, double wind_unit, Arena& arena) {
  const auto modes = static_cast<std::size_t>(chain.modes);
  const std::size_t states = chain.probabilities.size() / modes + 1;
  const ChainSegments& segments = chain.segments;
  const bool pose = chain.motion == ChainMotion::kPose;
  ChainProgram program;
  program.channels = channel_count(chain.motion);
  program.rate_count = rate_count(chain.motion);
  program.modes = chain.modes;
  program.breadth = segments.breadth;
  program.history = chain.history;
  program.heading_free = chain.heading_free;
  program.position_scale = static_cast<float>(segments.row_scale[0]);
  program.velocity_scale = static_cast<float>(segments.rate_scale[0]);
  program.orientation_scale = pose ? static_cast<float>(1 / kMaxStored) : 0.0f;
  program.spin_scale = pose ? static_cast<float>(segments.rate_scale[1]) : 0.0f;
  program.step_seconds = static_cast<float>(1.0 / rate_hz);
  program.blend_steps = static_cast<std::uint32_t>(chain.blend_steps);
  if (chain.gust) program.gust = gust_program(*chain.gust, wind_unit);
  program.rows = copy_of(segments.rows, arena, kRowReach);
  program.rates = copy_of(segments.rates, arena, kRowReach);
  program.first_row = copy_of(segment_rows(segments), arena);
  program.mode = copy_of(segments.mode, arena);
  program.follow = copy_of(segments.follow, arena);
  program.height = copy_of(segments.height, arena);
  program.height_scale = static_cast<float>(segments.height_scale);
  if (chain.drift) {
    take_drift(*chain.drift, program);
    program.lead = copy_of(chain.drift->lead, arena);
    const auto count = static_cast<float>(segments.size());
    program.mean_steps = static_cast<float>(segment_rows(segments).back()) / count - 1.0f;
  }
  program.first_of_mode = arena.take<std::uint32_t>(modes + 1);
  program.threshold = arena.take<std::uint32_t>(states * modes);
  if (program.blend_steps > 0) program.spread = arena.take<ChainSpread>(2 * program.blend_steps + 1);
  if (pose) program.changes = arena.take<float>(8 * segments.size());
  if (arena.measures()) return program;
  for (std::uint32_t steps = 1; steps < program.spread.size(); ++steps) program.spread[steps] = spread_over(steps);
  if (pose) {
    make_unit(program);
    fill_changes(program);
  }
  for (std::uint16_t mode : segments.mode) ++program.first_of_mode[mode + 1U];
  for (std::size_t mode = 0; mode < modes; ++mode) program.first_of_mode[mode + 1] += program.first_of_mode[mode];
  fill_thresholds(chain.initial, program.threshold.first(modes));
  for (std::size_t row = 1; row < states; ++row) {
    fill_thresholds(std::span(chain.probabilities).subspan((row - 1) * modes, modes),
                    program.threshold.subspan(row * modes, modes));
  }
  program.speed_unit = unit_of(program, 0, program.velocity_scale);
  program.max_return = static_cast<float>(kReturnShare * usual_step(program));
  if (pose) program.spin_unit = unit_of(program, 3, program.spin_scale);
  return program;
}

void take_size(const View& view, ChainProgram& program) {
  const auto* pose = std::get_if<PoseView>(&view);
  if (!pose) return;
  program.half_width = static_cast<float>(pose->half_width);
  program.half_length = static_cast<float>(pose->half_length);
}

std::uint64_t hash_of(const ChainProgram& program, std::uint64_t before) {
  const auto flag = program.heading_free ? 1.0f : 0.0f;
  std::uint64_t hash = hash_floats(
      {static_cast<float>(program.channels), static_cast<float>(program.breadth), flag, program.position_scale,
       program.orientation_scale, program.velocity_scale, program.spin_scale, program.half_width, program.half_length},
      before);
  hash = hash_number(program.blend_steps, hash);
  for (const auto& axis : {program.gust.ground, program.gust.vertical}) {
    hash = hash_floats({axis[0], axis[1], 0.25f * axis[2]}, hash);
  }
  const auto add = [&](const auto& numbers) {
    for (const auto number : numbers) hash = hash_number(std::uint32_t{static_cast<std::uint16_t>(number)}, hash);
  };
  add(program.rows);
  add(program.rates);
  add(program.lead);
  hash = hash_floats({program.lead_scale, program.drift[0], program.drift[1], program.drift[2], program.spread_ground,
                      program.spread_height, program.memory},
                     hash);
  add(program.follow);
  add(program.height);
  if (!program.height.empty()) hash = hash_floats({program.height_scale}, hash);
  for (std::uint32_t number : program.threshold) hash = hash_number(number, hash);
  return hash_number(static_cast<std::uint32_t>(program.history), hash);
}

Result<void> check_chain_program(const ChainModel& chain) {
  for (const auto* scales : {&chain.segments.row_scale, &chain.segments.rate_scale}) {
    for (double scale : *scales) {
      if (scale < kMinScale || scale > kMaxScale) {
        return Error{"a scale of the chain's segments is " + std::to_string(scale) +
                     ", expected 1e-12 to 1e6: learn it in another unit"};
      }
    }
  }
  return {};
}

}  // namespace wisp
