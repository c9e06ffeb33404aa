#include "round_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wisp::flow {
namespace {

constexpr float kGravity = 9.81F, kUpdraught = 0.1F;
constexpr float kFuelRate = 2.5e-6F;  // m³/s of cold vapour, calibrated to a flame of some 34 mm
constexpr float kFuelTemperature = 600, kWickDamping = 80;
constexpr float kWickHeat =
    1350;  // K: a grid as coarse as this one does not hold a flame's edge at its wick, so that does
constexpr float kDiffusivity = 2.0e-5F, kViscosity = 1.5e-5F;  // m²/s at 300 K
constexpr float kWindShare = 0.4F, kWindRate = 20.0F, kMaxExpansion = 1500;
constexpr double kRimMm = 4, kWickHighMm = 6, kWickHalfMm = 3.2, kWickTallMm = 3.0;
constexpr int kRounds = 6;           // of over-relaxation, from the last step's pressure
constexpr float kRelaxation = 1.7F;  // of it

}  // namespace

RoundFlow::RoundFlow(const RoundOptions& options)
    : options_(options),
      side_(options.side),
      high_(2 * options.side),
      grid_{side_, side_ * high_, static_cast<float>(options.cell_mm * 1e-3)},
      step_(static_cast<float>(1 / options.steps_a_second)),
      combustion_(step_) {
  cells_ = cells_scratch_ = ScalarPlane(grid_.size(), kAmbient);
  air_ = air_scratch_ = ScalarPlane(grid_.size(), Float4{0, kUpdraught, 0, 0});
  moved_temperature_ = theta_ = phi_ = right_ = source_ = share_ = Plane(grid_.size(), 0.0F);
  keep_ = Plane(grid_.size(), 1.0F);
  place_wick();
}

template <class Visit>
void RoundFlow::each_inner(Visit visit) const {
  for (int j = 1; j + 1 < high_; ++j)
    for (int k = 1; k + 1 < side_; ++k)
      for (int i = 1, cell = at(1, j, k); i + 1 < side_; ++i, ++cell) visit(cell);
}

// A smooth hump of fuel and of drag.
void RoundFlow::place_wick() {
  const double middle = (side_ - 1) / 2.0, h = options_.cell_mm;
  double sum = 0;
  for (int j = 1; j + 1 < high_; ++j)
    for (int k = 1; k + 1 < side_; ++k)
      for (int i = 1; i + 1 < side_; ++i) {
        const double x = (i - middle) * h, z = (k - middle) * h, y = j * h - kWickHighMm - kWickTallMm / 2;
        const double away = (x * x + z * z) / (kWickHalfMm * kWickHalfMm) + std::pow(y / kWickTallMm, 2);
        if (away < 2) near_wick_.push_back(at(i, j, k));
        if (away >= 1) continue;
        const double hump = std::pow(1 - away, 2);
        fuel_cells_.push_back(at(i, j, k));
        share_[at(i, j, k)] = static_cast<float>(hump);
        keep_[at(i, j, k)] = static_cast<float>(std::exp(-kWickDamping * hump * static_cast<double>(step_)));
        sum += hump;
      }
  const double volume = sum * std::pow(h * 1e-3, 3);
  for (const int cell : fuel_cells_) share_[cell] = static_cast<float>(static_cast<double>(share_[cell]) / volume);
}

Float4 RoundFlow::sample(const ScalarPlane& plane, float x, float y, float z) const {
  const auto top = static_cast<float>(side_ - 1) - 1e-3F, high = static_cast<float>(high_ - 1) - 1e-3F;
  x = std::clamp(x, 0.0F, top), y = std::clamp(y, 0.0F, high), z = std::clamp(z, 0.0F, top);
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j), c = z - static_cast<float>(k);
  const int deep = grid_.stride(), up = side_ * deep;
  const Float4* p = plane.data() + at(i, j, k);
  const auto line = [&](int n) { return p[n] + a * (p[n + 1] - p[n]); };
  const Float4 low = line(0) + c * (line(deep) - line(0));
  const Float4 over = line(up) + c * (line(up + deep) - line(up));
  return low + b * (over - low);
}

void RoundFlow::move() {
  const float way = step_ / grid_.h;
  for (int j = 0; j < high_; ++j)
    for (int k = 0; k < side_; ++k)
      for (int i = 0; i < side_; ++i) {
        const int cell = at(i, j, k);
        const auto x = static_cast<float>(i), y = static_cast<float>(j), z = static_cast<float>(k);
        const Float4 v = air_[cell];
        const Float4 half = sample(air_, x - 0.5F * way * v[0], y - 0.5F * way * v[1], z - 0.5F * way * v[2]);
        const float fx = x - way * half[0], fy = y - way * half[1], fz = z - way * half[2];
        air_scratch_[cell] = sample(air_, fx, fy, fz);
        const bool rim = i == 0 || k == 0 || j == 0 || i == side_ - 1 || k == side_ - 1;
        cells_scratch_[cell] = rim ? kAmbient : sample(cells_, fx, fy, fz);
      }
  air_.swap(air_scratch_);
  cells_.swap(cells_scratch_);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) moved_temperature_[cell] = cells_[cell][kTemperature];
}

void RoundFlow::mix() {
  float most = kAmbientTemperature;
  for (const Float4& cell : cells_) most = std::max(most, cell[kTemperature]);
  const float unit = step_ / (grid_.h * grid_.h);
  const auto spread = [&](float t) { return std::pow(t / kAmbientTemperature, 1.75F); };
  const int stages = std::max(1, static_cast<int>(std::ceil(6.5F * unit * kDiffusivity * spread(most))));
  each_inner([&](int cell) { theta_[cell] = unit / static_cast<float>(stages) * spread(cells_[cell][kTemperature]); });
  const int deep = grid_.stride(), up = side_ * deep;
  const Float4 heat = {kDiffusivity, kDiffusivity, kDiffusivity, 0}, drag = {kViscosity, kViscosity, kViscosity, 0};
  for (int stage = 0; stage < stages; ++stage) {
    cells_scratch_ = cells_;
    air_scratch_ = air_;
    each_inner([&](int c) {
      const auto round = [&](const ScalarPlane& p) {
        return p[c - 1] + p[c + 1] + p[c - deep] + p[c + deep] + p[c - up] + p[c + up] - 6.0F * p[c];
      };
      if (theta_[c] * static_cast<float>(stages) < 1.3F * unit) return;  // cold: the grid mixes it more than enough
      const float share = theta_[c];
      cells_[c] = cells_scratch_[c] + share * heat * round(cells_scratch_);
      air_[c] = air_scratch_[c] + share * drag * round(air_scratch_);
    });
  }
}

void RoundFlow::feed() {
  for (const int cell : near_wick_) cells_[cell][kTemperature] = std::max(cells_[cell][kTemperature], kWickHeat);
  for (const int cell : fuel_cells_) {
    source_[cell] = share_[cell] * kFuelRate * cells_[cell][kTemperature] / kAmbientTemperature;
    const float share = source_[cell] * step_ / (1 + source_[cell] * step_), soot = cells_[cell][kSoot];
    cells_[cell] += share * (Float4{1, 1, kFuelTemperature, 0} - cells_[cell]);
    cells_[cell][kSoot] = soot;
  }
}

void RoundFlow::burn_and_push(float wind_x, float wind_z) {
  combustion_.burn(grid_, cells_, nullptr);
  const float share = 1 - 1 / (1 + kWindRate * step_), lift = step_ * kGravity / kAmbientTemperature;
  for (int row = 0; row < grid_.ny; ++row)
    for (int i = 0; i < side_; ++i) {
      const int cell = grid_.at(i, row);
      Float4& v = air_[cell];
      v[0] += share * (kWindShare * wind_x - v[0]);
      v[2] += share * (kWindShare * wind_z - v[2]);
      v[1] += lift * (cells_[cell][kTemperature] - kAmbientTemperature);
      v *= keep_[cell];
      theta_[cell] = cells_[cell][kTemperature] / kAmbientTemperature;
      if (row < side_) v[1] = kUpdraught;
    }
}

// ∇·u = ln(T/T_moved)/Δt + source, by an approximate projection of what lies in the middle of cells.
void RoundFlow::project() {
  const int deep = grid_.stride(), up = side_ * deep;
  const float h = grid_.h;
  each_inner([&](int c) {
    const float ratio = std::log(cells_[c][kTemperature] / moved_temperature_[c]) / step_;
    const float wanted = std::clamp(ratio, -kMaxExpansion, kMaxExpansion) + source_[c];
    const float is =
        (air_[c + 1][0] - air_[c - 1][0] + air_[c + up][1] - air_[c - up][1] + air_[c + deep][2] - air_[c - deep][2]) /
        (2 * h);
    right_[c] = h * h * (is - wanted);
  });
  for (int round = 0; round < 2 * kRounds; ++round)
    for (int j = 1; j + 1 < high_; ++j)
      for (int k = 1; k + 1 < side_; ++k)
        for (int i = 1 + (j + k + round) % 2; i + 1 < side_; i += 2) {
          const int c = at(i, j, k);
          float sum = 0, weights = 0;
          for (const int n : {c - 1, c + 1, c - deep, c + deep, j == 1 ? c : c - up, c + up}) {
            if (n == c) continue;
            const float weight = 0.5F * (theta_[c] + theta_[n]);
            sum += weight * phi_[n];
            weights += weight;
          }
          phi_[c] += kRelaxation * ((sum - right_[c]) / weights - phi_[c]);
        }
  each_inner([&](int c) {
    const float scale = theta_[c] / (2 * h);
    const float below = c - up < at(0, 1, 0) ? phi_[c] : phi_[c - up];
    air_[c] -= scale * Float4{phi_[c + 1] - phi_[c - 1], phi_[c + up] - below, phi_[c + deep] - phi_[c - deep], 0};
  });
}

void RoundFlow::step(float wind_x, float wind_z) {
  feed();
  move();
  mix();
  burn_and_push(wind_x, wind_z);
  project();
}

double RoundFlow::glow_of(int cell) const {
  const double t = static_cast<double>(cells_[cell][kTemperature]);
  return t > 900 ? static_cast<double>(cells_[cell][kSoot]) * std::exp(-9000 * (1 / t - 1.0 / 1800)) : 0;
}

RigLight RoundFlow::seen_from(double azimuth_degrees) const {
  const double angle = azimuth_degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const double middle = (side_ - 1) / 2.0;
  constexpr double kDeepMm = 6;  // of glow of 1 that is as bright as the plane rig's
  RigLight light{side_, high_, options_.cell_mm, side_ / 2.0 * options_.cell_mm, kRimMm, {}, {}};
  light.soot.assign(static_cast<std::size_t>(side_) * high_, 0.0F);
  light.blue = light.soot;
  for (int j = 0; j < high_; ++j)
    for (int k = 0; k < side_; ++k)
      for (int i = 0; i < side_; ++i) {
        const double glow = glow_of(at(i, j, k)) * options_.cell_mm / kDeepMm;
        if (glow < 1e-5) continue;
        const double place = std::clamp((i - middle) * c - (k - middle) * s + middle, 0.0, side_ - 1.001);
        const int left = static_cast<int>(place);
        float* out = light.soot.data() + static_cast<std::size_t>(j) * side_ + left;
        out[0] += static_cast<float>(glow * (1 - place + left));
        out[1] += static_cast<float>(glow * (place - left));
      }
  return light;
}

std::vector<RoundSection> RoundFlow::sections() const {
  const double h = options_.cell_mm, middle = (side_ - 1) / 2.0;
  std::vector<RoundSection> out;
  double most = 0;
  for (int j = 0; j < high_; ++j) {
    double sum = 0, x = 0, z = 0, square = 0;
    for (int k = 0; k < side_; ++k)
      for (int i = 0; i < side_; ++i) {
        const double glow = glow_of(at(i, j, k));
        sum += glow, x += glow * i, z += glow * k, square += glow * (double(i) * i + double(k) * k);
      }
    if (sum <= 0) continue;
    x /= sum, z /= sum;
    most = std::max(most, sum);
    // Of an even disc the mean square distance is half of the radius's square.
    const double radius = std::sqrt(std::max(0.0, square / sum - x * x - z * z));
    out.push_back({(j + 0.5) * h - kRimMm, (x - middle) * h, (z - middle) * h, radius * h});
    if (sum < most / 5 && out.back().y > 10) {
      out.pop_back();
      break;
    }
  }
  return out;
}

double RoundFlow::hottest() const {
  float most = 0;
  for (const Float4& cell : cells_) most = std::max(most, cell[kTemperature]);
  return static_cast<double>(most);
}

}  // namespace wisp::flow
