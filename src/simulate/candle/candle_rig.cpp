#include "simulate/candle/candle_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "simulate/candle/candle_flow.hpp"
#include "simulate/option_range.hpp"

namespace wisp {
namespace {

constexpr double kMaxWind = 10;  // m/s
constexpr double kLighterSeconds = 0.25;
constexpr double kLitShare = 0.1;

Result<void> check_options(const CandleRigOptions& o) {
  return flow::check_ranges("candle rig", {
                                              {"columns", double(o.columns), 16, 1024},
                                              {"rows", double(o.rows), 16, 1024},
                                              {"cell_mm", o.cell_mm, 0.1, 2},
                                              {"rate_hz", o.rate_hz, 1, 1000},
                                              {"steps_a_second", o.steps_a_second, 100, 100000},
                                              {"position", o.position, 0.1, 0.9},
                                              {"candle_width_mm", o.candle_width_mm, 1, 100},
                                              {"candle_height_mm", o.candle_height_mm, 1, 100},
                                              {"wick_gap_mm", o.wick_gap_mm, 0, 50},
                                              {"wick_width_mm", o.wick_width_mm, 1, 50},
                                              {"wick_height_mm", o.wick_height_mm, 1, 50},
                                              {"wick_damping", o.wick_damping, 0, 10000},
                                              {"wick_time", o.wick_time, 0.001, 10},
                                              {"wick_cold", o.wick_cold, 300, 2000},
                                              {"wick_warm", o.wick_warm, o.wick_cold + 1, 3000},
                                              {"fuel_rate", o.fuel_rate, 0, 1e-2},
                                              {"fuel_temperature", o.fuel_temperature, 300, 1500},
                                              {"diffusivity", o.diffusivity, 1e-6, 1e-4},
                                              {"viscosity", o.viscosity, 1e-6, 1e-4},
                                              {"stoichiometric", o.stoichiometric, 0.01, 0.5},
                                              {"flame_heating", o.flame_heating, 0, 3000},
                                              {"reaction_rate", o.reaction_rate, 0, 1e5},
                                              {"ignition_low", o.ignition_low, 400, 2000},
                                              {"ignition_high", o.ignition_high, o.ignition_low + 1, 3000},
                                              {"updraught", o.updraught, 0, 2},
                                              {"max_expansion", o.max_expansion, 100, 1e5},
                                              {"wind_share", o.wind_share, 0, 1},
                                              {"wind_rate", o.wind_rate, 0, 1000},
                                              {"soot_rate", o.soot_rate, 0, 1e4},
                                              {"soot_burnout", o.soot_burnout, 0, 1e4},
                                              {"exposure", o.exposure, 1e-3, 1},
                                              {"pressure_tolerance", o.pressure_tolerance, 1e-3, 100},
                                          });
}

Result<void> check_fit(const CandleRigOptions& o) {
  const double width = o.columns * o.cell_mm;
  const double axis = o.position * width;
  const double half = std::max(o.candle_width_mm, o.wick_width_mm) / 2 + 2 * o.cell_mm;
  if (axis - half < 0 || axis + half > width)
    return Error{"candle rig: a candle " + std::to_string(o.candle_width_mm) + " mm wide at " + std::to_string(axis) +
                 " mm does not fit into a grid " + std::to_string(width) + " mm wide; use more columns"};
  const double top = o.candle_height_mm + o.wick_gap_mm + o.wick_height_mm + 2 * o.cell_mm;
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

int steps_per_frame(const CandleRigOptions& options) {
  return std::max(1, static_cast<int>(std::lround(options.steps_a_second / options.rate_hz)));
}

CandleRigOptions candle_rig_options(CandleGrid grid) {
  CandleRigOptions options;
  if (grid == CandleGrid::kFine) {
    options.columns = 112;
    options.rows = 192;
    options.cell_mm = 1.25 / 3;
    options.steps_a_second = 600;
    options.wick_damping = 250;
    options.wick_cold = 450;
    options.wick_warm = 750;
    options.fuel_rate = 1.4e-4;
  }
  return options;
}

struct CandleRig::Parts {
  explicit Parts(const CandleRigOptions& o) : options(o), flow(o) {
    light.columns = o.columns;
    light.rows = o.rows;
    light.cell_mm = o.cell_mm;
    light.wick_x_mm = static_cast<double>(flow.body().axis) * 1e3;
    light.wick_y_mm = static_cast<double>(flow.body().rim) * 1e3;
    light.soot.resize(static_cast<std::size_t>(o.columns) * o.rows);
    light.blue = light.soot;
  }

  CandleRigOptions options;
  flow::CandleFlow flow;
  FlameLight light;
  long long frames = 0;
  int lighter_steps = 0;
  double wind = 0;
  double burning = 0;
  double iterations = 0;
};

CandleRig::CandleRig(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
CandleRig::CandleRig(CandleRig&&) noexcept = default;
CandleRig& CandleRig::operator=(CandleRig&&) noexcept = default;
CandleRig::~CandleRig() = default;

Result<CandleRig> CandleRig::create(const CandleRigOptions& options) {
  if (auto ranges = check_options(options); !ranges) return ranges.error();
  if (auto fit = check_fit(options); !fit) return fit.error();
  CandleRig rig(std::make_unique<Parts>(options));
  rig.light();
  return rig;
}

void CandleRig::light() {
  const CandleRigOptions& o = parts_->options;
  parts_->lighter_steps = static_cast<int>(std::ceil(kLighterSeconds * o.rate_hz * steps_per_frame(o)));
}

void CandleRig::step_frame(double wind) {
  Parts& p = *parts_;
  const double next = std::isnan(wind) ? 0.0 : std::clamp(wind, -kMaxWind, kMaxWind);
  const int steps = steps_per_frame(p.options);
  const int closed = steps - std::max(1, static_cast<int>(std::lround(p.options.exposure * steps)));
  p.flow.clear_light();
  double burnt = 0;
  double iterations = 0;
  for (int s = 0; s < steps; ++s) {
    const double now = p.wind + (next - p.wind) * (s + 1) / steps;
    if (p.lighter_steps > 0) {
      p.flow.hold_flame_to_wick();
      --p.lighter_steps;
    }
    const flow::FlowStep step = p.flow.step(static_cast<float>(now), s >= closed);
    burnt += step.burnt;
    iterations += step.pressure.iterations;
  }
  p.wind = next;
  p.burning = burnt / steps / std::max(p.options.fuel_rate, 1e-12);
  p.iterations = iterations / steps;
  ++p.frames;
  const float share = 1.0F / static_cast<float>(p.flow.exposed_steps());
  copy_light(p.flow.grid(), p.flow.glow(), share, p.light.soot);
  copy_light(p.flow.grid(), p.flow.blue(), share, p.light.blue);
}

CandleState CandleRig::state() const {
  const Parts& p = *parts_;
  CandleState state;
  state.seconds = static_cast<double>(p.frames) / p.options.rate_hz;
  state.lit = p.burning >= kLitShare;
  state.fuel = static_cast<double>(p.flow.fuel()) / std::max(p.options.fuel_rate, 1e-12);
  state.burning = p.burning;
  state.wick_temperature = static_cast<double>(p.flow.wick_temperature());
  state.hottest = static_cast<double>(p.flow.hottest());
  state.fastest = static_cast<double>(p.flow.fastest());
  state.finite = p.flow.finite();
  state.pressure_iterations = p.iterations;
  return state;
}

const CandleRigOptions& CandleRig::options() const { return parts_->options; }
const FlameLight& CandleRig::light_of_frame() const { return parts_->light; }

}  // namespace wisp
