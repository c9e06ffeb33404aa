#include "simulate/candle/candle_rig.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "simulate/option_range.hpp"

namespace wisp {
namespace {

constexpr double kMaxWind = 10;  // m/s
constexpr double kLighterSeconds = 0.25;
constexpr double kLitShare = 0.1;
constexpr double kExposure = 0.5;  // exposure time as a share of the frame's duration

Result<void> check_options(const CandleRigOptions& o) {
  return flow::check_ranges("candle rig", {
                                              {"columns", double(o.columns), 16, 1024},
                                              {"rows", double(o.rows), 16, 1024},
                                              {"cell_mm", o.cell_mm, 0.1, 2},
                                              {"rate_hz", o.rate_hz, 1, 1000},
                                              {"steps_a_second", o.steps_a_second, 100, 100000},
                                              {"position", o.position, 0.1, 0.9},
                                              {"wick_damping", o.wick_damping, 0, 10000},
                                              {"wick_cold", o.wick_cold, 300, 2000},
                                              {"wick_warm", o.wick_warm, o.wick_cold + 1, 3000},
                                              {"fuel_rate", o.fuel_rate, 0, 1e-2},
                                          });
}

Result<void> check_fit(const CandleRigOptions& o) {
  const double width = o.columns * o.cell_mm;
  const double axis = o.position * width;
  const double half = std::max(flow::kCandleWidthMm, flow::kWickWidthMm) / 2 + 2 * o.cell_mm;
  if (axis - half < 0 || axis + half > width)
    return Error{"candle rig: a candle " + std::to_string(flow::kCandleWidthMm) + " mm wide at " +
                 std::to_string(axis) + " mm does not fit into a grid " + std::to_string(width) +
                 " mm wide; use more columns"};
  const double top = flow::kCandleHeightMm + flow::kWickGapMm + flow::kWickHeightMm + 2 * o.cell_mm;
  if (top > o.rows * o.cell_mm)
    return Error{"candle rig: candle and wick reach up to " + std::to_string(top) + " mm in a grid " +
                 std::to_string(o.rows * o.cell_mm) + " mm high; use more rows"};
  return {};
}

void copy_light(const flow::FlowGrid& grid, const flow::Plane& from, float factor, std::vector<float>& to) {
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) to[static_cast<std::size_t>(j) * grid.nx + i] = factor * from[grid.at(i, j)];
}

}  // namespace

CandleRig::CandleRig(const CandleRigOptions& o) : options_(o), flow_(o) {
  light_.columns = o.columns;
  light_.rows = o.rows;
  light_.cell_mm = o.cell_mm;
  light_.wick_x_mm = static_cast<double>(flow_.body().axis) * 1e3;
  light_.wick_y_mm = static_cast<double>(flow_.body().rim) * 1e3;
  light_.soot.resize(static_cast<std::size_t>(o.columns) * o.rows);
  light_.blue = light_.soot;
}

Result<CandleRig> CandleRig::create(const CandleRigOptions& options) {
  if (auto ranges = check_options(options); !ranges) return ranges.error();
  if (auto fit = check_fit(options); !fit) return fit.error();
  CandleRig rig(options);
  rig.light();
  return rig;
}

void CandleRig::light() {
  lighter_steps_ = static_cast<int>(std::ceil(kLighterSeconds * options_.rate_hz * flow::steps_per_frame(options_)));
}

void CandleRig::step_frame(double wind) {
  const double next = std::isnan(wind) ? 0.0 : std::clamp(wind, -kMaxWind, kMaxWind);
  const int steps = flow::steps_per_frame(options_);
  const int closed = steps - std::max(1, static_cast<int>(std::lround(kExposure * steps)));
  flow_.clear_light();
  double burnt = 0;
  for (int s = 0; s < steps; ++s) {
    const double now = wind_ + (next - wind_) * (s + 1) / steps;
    if (lighter_steps_ > 0) {
      flow_.hold_flame_to_wick();
      --lighter_steps_;
    }
    burnt += flow_.step(static_cast<float>(now), s >= closed);
  }
  wind_ = next;
  burning_ = burnt / steps / std::max(options_.fuel_rate, 1e-12);
  const float share = 1.0F / static_cast<float>(flow_.exposed_steps());
  copy_light(flow_.grid(), flow_.glow(), share, light_.soot);
  copy_light(flow_.grid(), flow_.blue(), share, light_.blue);
}

CandleState CandleRig::state() const {
  CandleState state;
  state.lit = burning_ >= kLitShare;
  state.fuel = static_cast<double>(flow_.fuel()) / std::max(options_.fuel_rate, 1e-12);
  state.burning = burning_;
  state.hottest = static_cast<double>(flow_.hottest());
  state.fastest = static_cast<double>(flow_.fastest());
  state.finite = flow_.finite();
  return state;
}

}  // namespace wisp
