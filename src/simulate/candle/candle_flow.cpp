#include "simulate/candle/candle_rig.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/candle/flow_equations.hpp"

namespace wisp::flow {
namespace {

constexpr float kGravity = 9.81F;
constexpr float kLighterTemperature = 1500.0F;  // K
constexpr float kLighterFuel = 0.6F;  // minimum fuel while the lighter heats the wick, as a share of fuel_rate
constexpr int kMaxIterations = 40;
constexpr float kWickTime = 0.15F;          // s, calibrated: time constant of the fuel's response to the wick's heat
constexpr float kFuelTemperature = 600.0F;  // K
constexpr float kDiffusivity = 2.0e-5F;     // m²/s at 300 K; grows as T^1.75
constexpr float kViscosity = 1.5e-5F;       // m²/s at 300 K
constexpr float kUpdraught = 0.25F;         // m/s, calibrated: speed of the rising air around a candle
constexpr float kMaxExpansion = 1500.0F;    // 1/s: bound of ∇·u
constexpr float kWindShare = 0.4F;          // calibrated: share of the wind at the flame; the rest flows around it
constexpr float kWindRate = 20.0F;          // 1/s, calibrated: rate at which the air at the flame adopts the wind
constexpr float kPressureTolerance = 0.5F;  // 1/s, root mean square of the remaining divergence error
constexpr Float4 kDiffuses = {1.0F, 1.0F, 1.0F, 0.0F};  // soot does not diffuse

constexpr double kNearWickMm = 2;
constexpr double kReach = 1.7;  // size of the hump's ellipse relative to the box

struct Box {
  double left, right, bottom, top;
};

// Returns the mean over cell (i, j) of a smooth hump over an ellipse of kReach times the box's size: 0 outside, 1 in
// the middle. With a plain box in place of the hump its corners would be visible in the flame's base in wind.
double hump(int i, int j, const Box& box) {
  constexpr int kSamples = 4;
  const double across = kReach * (box.right - box.left) / 2;
  const double upward = kReach * (box.top - box.bottom) / 2;
  double sum = 0;
  for (int a = 0; a < kSamples; ++a)
    for (int b = 0; b < kSamples; ++b) {
      const double x = (i + (a + 0.5) / kSamples - (box.left + box.right) / 2) / across;
      const double y = (j + (b + 0.5) / kSamples - (box.bottom + box.top) / 2) / upward;
      sum += std::pow(std::max(0.0, 1 - x * x - y * y), 2);
    }
  return sum / (kSamples * kSamples);
}

bool inside(int i, int j, const Box& box) {
  return i + 0.5 > box.left && i + 0.5 < box.right && j + 0.5 > box.bottom && j + 0.5 < box.top;
}

// Returns the x of the candle's axis, in cells: between two cells if the wax is an even number of cells wide, otherwise
// in the middle of a cell, so that the wax is symmetric about it.
double axis_of(const FlowGrid& grid, const CandleRigOptions& options) {
  const int width = static_cast<int>(std::lround(kCandleWidthMm / options.cell_mm));
  const double wanted = options.position * grid.nx;
  return width % 2 == 0 ? std::round(wanted) : std::floor(wanted) + 0.5;
}

CandleBody candle_body(const FlowGrid& grid, const CandleRigOptions& o) {
  const double cells = 1 / o.cell_mm;
  const double axis = axis_of(grid, o);
  const double rim = std::round(kCandleHeightMm * cells);
  const double foot = rim + kWickGapMm * cells;
  const Box wax = {axis - kCandleWidthMm * cells / 2, axis + kCandleWidthMm * cells / 2, 0, rim};
  const Box wick = {axis - kWickWidthMm * cells / 2, axis + kWickWidthMm * cells / 2, foot,
                    foot + kWickHeightMm * cells};
  const double near = kNearWickMm * cells;
  const Box near_wick = {wick.left - near, wick.right + near, wick.bottom - near, wick.top + near};

  CandleBody body;
  body.open_x = body.open_y = body.fuel_share = body.drag = Plane(grid.size(), 0.0F);
  const auto solid = [&](int i, int j) { return inside(i, j, wax); };
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const int cell = grid.at(i, j);
      body.open_x[cell] = j < grid.ny && !solid(i, j) && !solid(i - 1, j) ? 1.0F : 0.0F;
      body.open_y[cell] = i < grid.nx && !solid(i, j) && !solid(i, j - 1) ? 1.0F : 0.0F;
      if (i == grid.nx || j == grid.ny || solid(i, j)) continue;
      body.drag[cell] = static_cast<float>(hump(i, j, wick));
      if (body.drag[cell] > 0) body.fuel_cells.push_back(cell);
      if (inside(i, j, near_wick)) body.near_wick.push_back(cell);
    }
  double sum = 0;
  for (const int cell : body.fuel_cells) sum += static_cast<double>(body.drag[cell]);
  const double area = sum * static_cast<double>(grid.h) * static_cast<double>(grid.h);
  for (const int cell : body.fuel_cells)
    body.fuel_share[cell] = static_cast<float>(static_cast<double>(body.drag[cell]) / area);
  body.axis = static_cast<float>(axis) * grid.h;
  body.rim = static_cast<float>(rim) * grid.h;
  return body;
}

}  // namespace

int steps_per_frame(const CandleRigOptions& options) {
  return std::max(1, static_cast<int>(std::lround(options.steps_a_second / options.rate_hz)));
}

CandleFlow::CandleFlow(const CandleRigOptions& options)
    : options_(options),
      grid_{options.columns, options.rows, static_cast<float>(options.cell_mm * 1e-3)},
      step_(static_cast<float>(1 / (options.rate_hz * steps_per_frame(options)))),
      body_(candle_body(grid_, options)),
      combustion_(step_),
      pressure_(grid_) {
  const Plane zero(grid_.size(), 0.0F);
  u_ = v_ = u_scratch_ = v_scratch_ = way_x_ = way_y_ = zero;
  conductance_ = corner_ = flux_x_ = flux_y_ = scale_ = fuel_source_ = glow_ = blue_ = zero;
  temperature_ = moved_temperature_ = Plane(grid_.size(), kAmbientTemperature);
  cells_ = cells_scratch_ = ScalarPlane(grid_.size(), kAmbient);
  for (int j = 0; j <= grid_.ny; ++j)
    for (int i = 0; i < grid_.nx; ++i) v_[grid_.at(i, j)] = kUpdraught * body_.open_y[grid_.at(i, j)];
  set_drag();
}

// Sets the factors of the wick's drag on velocity in one step; 0 on the wax.
void CandleFlow::set_drag() {
  keep_u_ = body_.open_x;
  keep_v_ = body_.open_y;
  const double damping = options_.wick_damping * static_cast<double>(step_);
  for (int j = 0; j <= grid_.ny; ++j)
    for (int i = 0; i <= grid_.nx; ++i) {
      const int face = grid_.at(i, j);
      const float wick_x = 0.5F * (body_.drag[face] + body_.drag[face - 1]);
      const float wick_y = 0.5F * (body_.drag[face] + body_.drag[face - grid_.stride()]);
      keep_u_[face] *= static_cast<float>(std::exp(-damping * static_cast<double>(wick_x)));
      keep_v_[face] *= static_cast<float>(std::exp(-damping * static_cast<double>(wick_y)));
    }
}

double CandleFlow::step(float wind, bool exposed) {
  feed_wick();
  move();
  mix();
  release_fuel();
  const double burnt = combustion_.burn(grid_, cells_, exposed ? &blue_ : nullptr) * static_cast<double>(grid_.h) *
                       static_cast<double>(grid_.h) / static_cast<double>(step_);
  take_temperature();
  push(wind);
  project();
  if (exposed) {
    combustion_.add_glow(grid_, cells_, glow_);
    ++exposed_steps_;
  }
  return burnt;
}

float CandleFlow::wick_temperature() const {
  float sum = 0;
  for (const int cell : body_.near_wick) sum += cells_[cell][kTemperature];
  return sum / static_cast<float>(body_.near_wick.size());
}

void CandleFlow::feed_wick() {
  const float most = static_cast<float>(options_.fuel_rate);
  const auto cold = static_cast<float>(options_.wick_cold);
  const auto warm = static_cast<float>(options_.wick_warm);
  const float wanted = most * std::clamp((wick_temperature() - cold) / (warm - cold), 0.0F, 1.0F);
  fuel_ += step_ / kWickTime * (wanted - fuel_);
}

void CandleFlow::hold_flame_to_wick() {
  for (const int cell : body_.near_wick)
    cells_[cell][kTemperature] = std::max(cells_[cell][kTemperature], kLighterTemperature);
  fuel_ = std::max(fuel_, kLighterFuel * static_cast<float>(options_.fuel_rate));
}

void CandleFlow::move() {
  trace(grid_, u_, v_, step_, way_x_, way_y_, u_scratch_, v_scratch_);
  advect(grid_, way_x_, way_y_, cells_, cells_scratch_);
  cells_.swap(cells_scratch_);
  advect_u(grid_, way_x_, way_y_, u_, u_scratch_);
  u_.swap(u_scratch_);
  advect_v(grid_, way_x_, way_y_, v_, v_scratch_);
  v_.swap(v_scratch_);
  take_temperature();
  moved_temperature_ = temperature_;
}

void CandleFlow::take_temperature() {
  for (int j = 0; j < grid_.ny; ++j)
    for (int k = grid_.at(0, j), end = k + grid_.nx; k < end; ++k) temperature_[k] = cells_[k][kTemperature];
  for (int j = 0; j < grid_.ny; ++j) {
    temperature_[grid_.at(-1, j)] = temperature_[grid_.at(0, j)];
    temperature_[grid_.at(grid_.nx, j)] = temperature_[grid_.at(grid_.nx - 1, j)];
  }
  std::copy_n(temperature_.begin() + grid_.at(0, grid_.ny - 1), grid_.nx, temperature_.begin() + grid_.at(0, grid_.ny));
}

// Sets the conductance (T/T0)^0.75 of cells and corners; 0 outside, so that nothing diffuses through the rim.
void CandleFlow::set_conductance() {
  const int stride = grid_.stride();
  for (int j = 0; j < grid_.ny; ++j) {
    const float* __restrict t = temperature_.data() + grid_.at(0, j);
    float* __restrict out = conductance_.data() + grid_.at(0, j);
    for (int i = 0; i < grid_.nx; ++i) {
      const float theta = t[i] * (1.0F / kAmbientTemperature);
      out[i] = std::sqrt(theta * std::sqrt(theta));
    }
  }
  for (int j = 1; j < grid_.ny; ++j) {
    const float* __restrict g = conductance_.data() + grid_.at(0, j);
    float* __restrict out = corner_.data() + grid_.at(0, j);
    for (int i = 1; i < grid_.nx; ++i) out[i] = 0.25F * ((g[i] + g[i - 1]) + (g[i - stride] + g[i - stride - 1]));
  }
}

void CandleFlow::set_scalar_fluxes() {
  const int stride = grid_.stride();
  for (int j = 0; j <= grid_.ny; ++j) {
    const int row = grid_.at(0, j);
    const float* __restrict g = conductance_.data() + row;
    const float* __restrict open_x = body_.open_x.data() + row;
    const float* __restrict open_y = body_.open_y.data() + row;
    float* __restrict x = flux_x_.data() + row;
    float* __restrict y = flux_y_.data() + row;
    for (int i = 0; i <= grid_.nx; ++i) {
      x[i] = 0.5F * open_x[i] * (g[i - 1] + g[i]);
      y[i] = 0.5F * open_y[i] * (g[i - stride] + g[i]);
    }
    x[0] = x[grid_.nx] = 0.0F;
    if (j == 0 || j == grid_.ny) std::fill_n(y, grid_.nx + 1, 0.0F);
  }
}

// Sets scale = material · step / h² · T/T0, with T the mean of two cells `offset` apart; 0 on closed faces.
void CandleFlow::set_scale(float material, int offset, const Plane* open) {
  const float strength = material * step_ / (grid_.h * grid_.h) * (0.5F / kAmbientTemperature);
  for (int j = 0; j <= grid_.ny; ++j) {
    const int row = grid_.at(0, j);
    const float* __restrict t = temperature_.data() + row;
    float* __restrict out = scale_.data() + row;
    for (int i = 0; i <= grid_.nx; ++i) out[i] = strength * (t[i] + t[i - offset]);
    if (!open) continue;
    const float* __restrict mask = open->data() + row;
    for (int i = 0; i <= grid_.nx; ++i) out[i] *= mask[i];
  }
}

void CandleFlow::mix() {
  set_conductance();
  set_scalar_fluxes();
  const float theta = hottest() / kAmbientTemperature;
  const float spread = theta * std::sqrt(theta * std::sqrt(theta)) * step_ / (grid_.h * grid_.h);
  const int nx = grid_.nx;
  const int ny = grid_.ny;

  set_scale(kDiffusivity, 0, nullptr);
  diffuse(grid_, {nx, ny, flux_x_.data(), flux_y_.data()}, scale_, rkl1_stages(spread * kDiffusivity), kDiffuses,
          cells_, cells_scratch_);

  const int stages = rkl1_stages(spread * kViscosity);
  set_scale(kViscosity, 1, &body_.open_x);
  diffuse(grid_, {nx + 1, ny, conductance_.data() - 1, corner_.data()}, scale_, stages, u_, u_scratch_);
  set_scale(kViscosity, grid_.stride(), &body_.open_y);
  diffuse(grid_, {nx, ny + 1, corner_.data(), conductance_.data() - grid_.stride()}, scale_, stages, v_, v_scratch_);
}

// Adds fuel vapour at the wick. It displaces hot gas, so its volume source has the factor T/T0; without this factor a
// cooled wick would emit three times too much fuel.
void CandleFlow::release_fuel() {
  const Float4 vapour = {1.0F, 1.0F, kFuelTemperature, 0.0F};
  for (const int k : body_.fuel_cells) {
    const float theta = cells_[k][kTemperature] * (1.0F / kAmbientTemperature);
    const float source = body_.fuel_share[k] * fuel_ * theta;
    const float share = source * step_ / (1.0F + source * step_);
    const float soot = cells_[k][kSoot];
    cells_[k] += share * (vapour - cells_[k]);
    cells_[k][kSoot] = soot;
    fuel_source_[k] = source;
  }
}

void CandleFlow::push(float wind) {
  const int stride = grid_.stride();
  const float share = 1.0F - 1.0F / (1.0F + kWindRate * step_);
  const float target = kWindShare * wind;
  const float lift = 0.5F * step_ * kGravity / kAmbientTemperature;
  for (int j = 0; j <= grid_.ny; ++j) {
    const int row = grid_.at(0, j);
    const float* __restrict t = temperature_.data() + row;
    const float* __restrict keep_u = keep_u_.data() + row;
    const float* __restrict keep_v = keep_v_.data() + row;
    float* __restrict u = u_.data() + row;
    float* __restrict v = v_.data() + row;
    for (int i = 0; i <= grid_.nx; ++i) {
      u[i] = keep_u[i] * (u[i] + share * (target - u[i]));
      v[i] = keep_v[i] * (v[i] + lift * ((t[i] - kAmbientTemperature) + (t[i - stride] - kAmbientTemperature)));
    }
  }
  for (int k = grid_.at(0, 0), end = k + grid_.nx; k < end; ++k) v_[k] = kUpdraught * body_.open_y[k];
}

// Sets the right side −h² (∇·u − expansion) and the coefficients T/T0.
void CandleFlow::set_divergence() {
  const int stride = grid_.stride();
  const float h = grid_.h;
  const float rate = 1.0F / step_;
  constexpr float kHalf = 0.5F / kAmbientTemperature;
  for (int j = 0; j <= grid_.ny; ++j) {
    const int row = grid_.at(0, j);
    const float* __restrict t = temperature_.data() + row;
    const float* __restrict moved = moved_temperature_.data() + row;
    const float* __restrict fuel = fuel_source_.data() + row;
    const float* __restrict u = u_.data() + row;
    const float* __restrict v = v_.data() + row;
    const float* __restrict open_x = body_.open_x.data() + row;
    const float* __restrict open_y = body_.open_y.data() + row;
    float* __restrict beta_x = pressure_.beta_x().data() + row;
    float* __restrict beta_y = pressure_.beta_y().data() + row;
    float* __restrict right = pressure_.right_side().data() + row;
    for (int i = 0; i <= grid_.nx; ++i) {
      beta_x[i] = kHalf * open_x[i] * (t[i] + t[i - 1]);
      beta_y[i] = kHalf * open_y[i] * (t[i] + t[i - stride]);
    }
    if (j == 0) std::fill_n(beta_y, grid_.nx + 1, 0.0F);
    if (j == grid_.ny) break;
    for (int i = 0; i < grid_.nx; ++i) {
      const float ratio = (t[i] - moved[i]) / (t[i] + moved[i]);
      const float square = ratio * ratio;
      const float expansion = rate * 2.0F * ratio * (1.0F + square * (1.0F / 3 + square * 0.2F));
      const float held = std::min(std::max(expansion, -kMaxExpansion), kMaxExpansion) + fuel[i];
      right[i] = h * (h * held - ((u[i + 1] - u[i]) + (v[i + stride] - v[i])));
    }
  }
}

void CandleFlow::apply_pressure() {
  const int stride = grid_.stride();
  const float per_cell = 1.0F / grid_.h;
  for (int j = 0; j <= grid_.ny; ++j) {
    const int row = grid_.at(0, j);
    const float* __restrict phi = pressure_.phi().data() + row;
    const float* __restrict beta_x = pressure_.beta_x().data() + row;
    const float* __restrict beta_y = pressure_.beta_y().data() + row;
    float* __restrict u = u_.data() + row;
    float* __restrict v = v_.data() + row;
    for (int i = 0; i <= grid_.nx; ++i) {
      u[i] -= per_cell * beta_x[i] * (phi[i] - phi[i - 1]);
      v[i] -= per_cell * beta_y[i] * (phi[i] - phi[i - stride]);
    }
  }
}

void CandleFlow::project() {
  set_divergence();
  pressure_.prepare();
  const float tolerance = kPressureTolerance * grid_.h * grid_.h;
  pressure_.solve(tolerance, kMaxIterations);
  apply_pressure();
}

float CandleFlow::hottest() const {
  float most = kAmbientTemperature;
  for (int j = 0; j < grid_.ny; ++j)
    for (int k = grid_.at(0, j), end = k + grid_.nx; k < end; ++k) most = std::max(most, temperature_[k]);
  return most;
}

float CandleFlow::fastest() const {
  float most = 0;
  for (int j = 0; j < grid_.ny; ++j)
    for (int k = grid_.at(0, j), end = k + grid_.nx; k < end; ++k) most = std::max(most, u_[k] * u_[k] + v_[k] * v_[k]);
  return std::sqrt(most);
}

bool CandleFlow::finite() const {
  // A sum propagates any NaN or infinity.
  float sum = 0;
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const Float4 c = cells_[k];
    sum += (c[kMixture] + c[kFuel]) + (c[kTemperature] + c[kSoot]) + (u_[k] + v_[k]) + pressure_.phi()[k];
  }
  return std::isfinite(sum);
}

void CandleFlow::clear_light() {
  std::fill(glow_.begin(), glow_.end(), 0.0F);
  std::fill(blue_.begin(), blue_.end(), 0.0F);
  exposed_steps_ = 0;
}

}  // namespace wisp::flow
