#include "run/arx/drawn_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "run/bank/channels.hpp"
#include "run/bank/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMostUnits = 1e9;  // of a residual or a wind, in ranges: no sum overflows

float bounded(double value) {
  if (std::abs(value) < kLeastCoefficient) return 0.0f;
  return static_cast<float>(std::clamp(value, -kMostUnits, kMostUnits));
}

void fill_left(const DrawnResiduals& drawn, DrawnProgram& program) {
  std::uint32_t begin = 0;
  for (std::uint32_t end : drawn.ends) {
    for (std::uint32_t row = begin; row < end; ++row) program.left[row] = end - 1 - row;
    begin = end;
  }
}

// In the regressor's channel units, as deviations from its mean where the channel is one.
void fill_winds(const Model& model, const ArxModel& arx, const DrawnResiduals& drawn, DrawnProgram& program) {
  const double unit = drawn.wind_scale / regressor_scale(model, drawn.toward);
  const double mean = (arx.input_mean[drawn.toward] - (drawn.against < 0 ? 0 : arx.input_mean[drawn.against])) /
                      regressor_scale(model, drawn.toward);
  for (std::size_t row = 0; row < program.wind.size(); ++row) {
    program.wind[row] = bounded(drawn.winds[2 * row] * unit - mean);
    program.trend[row] = bounded(drawn.winds[2 * row + 1] * unit);
  }
  program.tolerance = bounded(drawn.tolerance / regressor_scale(model, drawn.toward));
  std::iota(program.order.begin(), program.order.end(), 0U);
  const auto key = [&](std::uint32_t row) {
    return program.mirrors() ? std::abs(program.wind[row]) : program.wind[row];
  };
  // Those alike stay in their order. As a heap, since that takes little code and no memory.
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); };
  std::make_heap(program.order.begin(), program.order.end(), before);
  std::sort_heap(program.order.begin(), program.order.end(), before);
}

// In the regressor's channel units too, so that they can be added to what the wind is apart by.
void fill_leans(const Model& model, const DrawnResiduals& drawn, DrawnProgram& program) {
  const double weight = drawn.lean_weight / regressor_scale(model, drawn.toward);
  for (std::size_t k = 0; k < drawn.leans.size(); ++k) {
    program.leans[k] = bounded(drawn.leans[k] * drawn.lean_scale * weight);
  }
  for (std::size_t k = 0; k < drawn.lean_of.size(); ++k) {
    const Output& out = model.outputs[drawn.lean_of[k]];
    program.lean_of[k] = drawn.lean_of[k];
    program.lean[k] = bounded(channel_scale(out.lowest, out.highest) * weight);
  }
}

void fill_rows(const Model& model, const DrawnResiduals& drawn, DrawnProgram& program) {
  for (std::size_t k = 0; k < program.rows.size(); ++k) {
    const std::size_t i = k % drawn.scale.size();
    const Output& out = model.outputs[i];
    program.rows[k] = bounded(drawn.rows[k] * (drawn.scale[i] / channel_scale(out.lowest, out.highest)));
  }
}

void fill_sides(const Model& model, const DrawnResiduals& drawn, DrawnProgram& program) {
  const auto ny = static_cast<std::size_t>(program.outputs);
  const auto unit = [&](std::size_t i) { return channel_scale(model.outputs[i].lowest, model.outputs[i].highest); };
  for (std::size_t i = 0; i < ny; ++i) {
    program.from[i] = static_cast<std::uint16_t>(i);
    program.factor[i] = 1.0f;
  }
  for (std::size_t i = 0; i < drawn.mirror.size(); ++i) {
    const auto from = static_cast<std::size_t>(std::abs(drawn.mirror[i]) - 1);
    program.from[ny + i] = static_cast<std::uint16_t>(from);
    program.factor[ny + i] = bounded((drawn.mirror[i] < 0 ? -1 : 1) * unit(from) / unit(i));
  }
}

}  // namespace

DrawnProgram make_drawn_program(const Model& model, const ArxModel& arx, Arena& arena) {
  const DrawnResiduals& drawn = arx.noise.drawn;
  DrawnProgram program;
  if (drawn.empty()) return program;
  program.outputs = arx.orders.outputs();
  program.toward = drawn.toward;
  program.against = drawn.against;
  program.trend_steps = drawn.trend_steps;
  program.shortest = static_cast<std::uint32_t>(drawn.shortest);
  program.longest = static_cast<std::uint32_t>(drawn.longest);
  const std::size_t rows = drawn.row_count();
  const std::size_t winds = program.driven() ? rows : 0;
  program.sides = drawn.mirror.empty() ? 1 : 2;
  program.rows = arena.take<float>(drawn.rows.size());
  program.left = arena.take<std::uint32_t>(rows);
  program.wind = arena.take<float>(winds);
  program.trend = arena.take<float>(winds);
  program.leans = arena.take<float>(drawn.leans.size());
  program.order = arena.take<std::uint32_t>(winds);
  program.from = arena.take<std::uint16_t>(static_cast<std::size_t>(program.sides) * program.outputs);
  program.factor = arena.take<float>(static_cast<std::size_t>(program.sides) * program.outputs);
  if (arena.measures()) return program;
  fill_rows(model, drawn, program);
  fill_left(drawn, program);
  fill_sides(model, drawn, program);
  if (program.driven()) {
    fill_winds(model, arx, drawn, program);
    fill_leans(model, drawn, program);
  }
  return program;
}

bool residuals_mirror(const DrawnProgram& program, int a, int b) {
  const auto ny = static_cast<std::size_t>(program.outputs);
  for (std::size_t row = 0; row < program.rows.size(); row += ny) {
    for (std::size_t side = 0; side < program.from.size(); side += ny) {
      const auto taken = [&](int output) {
        const std::size_t place = side + static_cast<std::size_t>(output);
        return program.factor[place] * program.rows[row + program.from[place]];
      };
      if (taken(a) != -taken(b)) return false;
    }
  }
  return true;
}

std::uint64_t hash_of(const DrawnProgram& program, std::uint64_t before) {
  if (program.empty()) return before;
  std::uint64_t hash = before;
  for (int number : {program.toward, program.against, program.trend_steps}) {
    hash = hash_number(static_cast<std::uint32_t>(number), hash);
  }
  for (std::uint32_t number : {program.shortest, program.longest}) hash = hash_number(number, hash);
  for (std::uint32_t left : program.left) hash = hash_number(left, hash);
  for (std::uint16_t from : program.from) hash = hash_number(std::uint32_t{from}, hash);
  const float tolerance[] = {program.tolerance};
  for (const auto numbers : {std::span<const float>(tolerance), std::span<const float>(program.rows),
                             std::span<const float>(program.wind), std::span<const float>(program.trend),
                             std::span<const float>(program.factor), std::span<const float>(program.leans)}) {
    hash = hash_floats(numbers, hash);
  }
  if (program.leans.empty()) return hash;
  for (int of : program.lean_of) hash = hash_number(static_cast<std::uint32_t>(of), hash);
  return hash_floats(program.lean, hash);
}

}  // namespace wisp
