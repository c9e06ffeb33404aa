#include "learn/chain/chain_seconds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "base/statistics.hpp"
#include "learn/fidelity/fidelity_distance.hpp"
#include "learn/fidelity/fidelity_stretch.hpp"
#include "learn/numeric/constants.hpp"

namespace wisp::chain {
namespace {

constexpr std::array kLags = {0.5, 1.0, 2.0};                                            // seconds
constexpr std::array kBandEdges = {0.25, 0.75, 1.25, 2.25, 3.75, 5.75, 8.75, 12.25};     // Hz
constexpr double kUnseenMetres = 0.3e-3, kUnseenRadians = 0.2 * std::numbers::pi / 180;  // no eye sees less
constexpr double kTailValues[] = {0.001, 0.01, 0.99, 0.999};
constexpr double kNormalValues[] = {-3.0902, -2.3263, 2.3263, 3.0902};  // of a normal distribution, in deviations

using Pieces = std::vector<const MotionPiece*>;

Pieces pieces_of(const Motion& motion) {
  Pieces out;
  for (const MotionPiece& piece : motion.pieces) out.push_back(&piece);
  return out;
}

// Every other fall to a side.
std::array<Pieces, 2> halves_of(const Motion& motion) {
  std::array<Pieces, 2> halves;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) halves[k % 2].push_back(&motion.pieces[k]);
  return halves;
}

// One signal of a piece, and in what unit nothing below is seen: metres, or radians.
struct Signal {
  std::vector<double> values;
  double unseen = 0;
  bool is_rate = true;  // a velocity of what is unseen
};

std::vector<Signal> signals_of(const MotionPiece& piece) {
  std::vector<Signal> out(2);
  for (Signal& one : out) one.unseen = kUnseenMetres;
  for (const Triple& v : piece.velocity) {
    out[0].values.push_back(v[2]);
    out[1].values.push_back(std::hypot(v[0], v[1]));
  }
  if (piece.orientation.empty()) return out;
  Signal up{{}, kUnseenRadians, false};
  std::array<Signal, 3> velocity, spin;
  for (Signal& one : velocity) one.unseen = kUnseenMetres;
  for (Signal& one : spin) one.unseen = kUnseenRadians;
  for (std::size_t row = 0; row < piece.rows(); ++row) {
    up.values.push_back(std::abs(in_world_axes(piece.orientation[row], {0, 0, 1})[2]));
    const Triple v = in_body_axes(piece.orientation[row], piece.velocity[row]);
    const Triple w = in_body_axes(piece.orientation[row], piece.spin[row]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      velocity[axis].values.push_back(v[axis]);
      spin[axis].values.push_back(w[axis]);
    }
  }
  out.push_back(std::move(up));
  for (Signal& one : velocity) out.push_back(std::move(one));
  for (Signal& one : spin) out.push_back(std::move(one));
  return out;
}

// Power of a stretch at a frequency, tapered by Hann's window; of a sine of height 1 it is 1.
double power_at(std::span<const double> values, double mean, double cycles) {
  const auto rows = static_cast<double>(values.size());
  double real = 0, imaginary = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(row) / rows;
    const double x = (values[row] - mean) * (1 - std::cos(turn));
    real += x * std::cos(cycles * turn);
    imaginary += x * std::sin(cycles * turn);
  }
  return (real * real + imaginary * imaginary) * 4 / (rows * rows);
}

void add_bands(const Signal& signal, std::size_t first, std::size_t rows, double rate_hz, std::vector<double>& out) {
  const auto part = std::span(signal.values).subspan(first, rows);
  const double seconds = static_cast<double>(rows) / rate_hz, middle = mean(part);
  for (std::size_t band = 0; band + 1 < kBandEdges.size(); ++band) {
    double power = 0;
    for (double cycle = std::ceil(kBandEdges[band] * seconds); cycle < kBandEdges[band + 1] * seconds; ++cycle) {
      const double unseen = signal.unseen * (signal.is_rate ? 2 * std::numbers::pi * cycle / seconds : 1);
      power += power_at(part, middle, cycle) + unseen * unseen;
    }
    out.push_back(std::log(power + 1e-30));
  }
}

// The rows of all signals in one random order.
void mix(std::vector<Signal>& signals, std::mt19937_64& random) {
  std::vector<std::size_t> order(signals.front().values.size());
  std::iota(order.begin(), order.end(), 0U);
  shuffle(std::span(order), random);
  for (Signal& signal : signals) {
    const std::vector<double> before = signal.values;
    for (std::size_t row = 0; row < order.size(); ++row) signal.values[row] = before[order[row]];
  }
}

// Windows end to end; the features are log powers in bands of all signals. A block is a piece.
FeatureWindows spectral_windows(const Pieces& pieces, double rate_hz, std::size_t rows,
                                std::mt19937_64* random = nullptr) {
  FeatureWindows out;
  for (std::size_t block = 0; block < pieces.size(); ++block) {
    auto signals = signals_of(*pieces[block]);
    if (random) mix(signals, *random);
    for (std::size_t first = 0; first + rows <= pieces[block]->rows(); first += rows) {
      const std::size_t before = out.values.size();
      for (const Signal& signal : signals) add_bands(signal, first, rows, rate_hz, out.values);
      out.features = out.values.size() - before;
      out.blocks.push_back(block);
    }
  }
  return out;
}

double distance_of(FeatureWindows x, FeatureWindows y, std::size_t most, std::uint64_t seed) {
  x = thinned(x, most);
  y = thinned(y, most);
  if (x.size() < 2 || y.size() < 2) return kMissing;
  standardise(x, y);
  return energy_test(x, y, 0, seed).distance;
}

// Mean squared distance over ground after so many rows.
double spread_of(const Pieces& pieces, std::size_t lag) {
  double sum = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = lag; row < piece->rows(); ++row, ++count) {
      const Triple &from = piece->position[row - lag], &to = piece->position[row];
      sum += (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]);
    }
  }
  return count > 0 ? sum / count : kMissing;
}

std::size_t rows_in(double seconds, double rate_hz) { return static_cast<std::size_t>(std::lround(seconds * rate_hz)); }

FallExtremes extremes_of(const Pieces& pieces, double rate_hz) {
  FallExtremes out;
  std::vector<double> speed, acceleration;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = 1; row + 1 < piece->rows(); ++row) {
      speed.push_back(piece->velocity[row][2]);
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](std::size_t k) { return piece->position[k][axis]; };
        square += std::pow(at(row + 1) - 2 * at(row) + at(row - 1), 2);
      }
      acceleration.push_back(std::sqrt(square) * rate_hz * rate_hz);
    }
  }
  const auto share_of = [](std::vector<double>& values, double share) {
    return values.empty() ? kMissing : quantile_in_place(std::span(values), share);
  };
  for (std::size_t k = 0; k < 4; ++k) out.vertical_speed[k] = share_of(speed, kTailValues[k]);
  for (std::size_t k = 0; k < 2; ++k) out.acceleration[k] = share_of(acceleration, kTailValues[2 + k]);
  for (std::size_t k = 0; k < kLags.size(); ++k) out.spread[k] = spread_of(pieces, rows_in(kLags[k], rate_hz));
  return out;
}

// The largest relative deviation of a percentile: of the two low ones of vertical speed, and of accelerations.
double tails_apart(const FallExtremes& a, const FallExtremes& b) {
  double most = 0;
  const auto add = [&](double x, double y) {
    const double off = std::abs(y / x - 1);
    if (!(off <= most)) most = off;  // what can't be told of one stays so
  };
  for (std::size_t k = 0; k < 2; ++k) add(a.vertical_speed[k], b.vertical_speed[k]);
  for (std::size_t k = 0; k < 2; ++k) add(a.acceleration[k], b.acceleration[k]);
  return most;
}

// The extremes of vertical speed that a normal distribution of the same mean and deviation has.
FallExtremes normal_like(const Pieces& pieces, FallExtremes out) {
  double sum = 0, square = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (const Triple& v : piece->velocity) sum += v[2], square += v[2] * v[2], ++count;
  }
  const double mean = sum / count, deviation = std::sqrt(std::max(0.0, square / count - mean * mean));
  for (std::size_t k = 0; k < 4; ++k) out.vertical_speed[k] = mean + kNormalValues[k] * deviation;
  return out;
}

// The spread of the same steps in random order, which is that of a random walk.
double shuffled_spread(const Pieces& pieces, std::size_t lag) {
  double square = 0, count = 0;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = 1; row < piece->rows(); ++row, ++count) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        square += std::pow(piece->position[row][axis] - piece->position[row - 1][axis], 2);
    }
  }
  return static_cast<double>(lag) * square / count;
}

}  // namespace

SecondsFidelity seconds_fidelity(const Motion& real, const Motion& synthesized, std::size_t max_windows,
                                 std::uint64_t seed) {
  const double rate = real.rate_hz;
  const std::size_t rows = rows_in(kLongWindowSeconds, rate);
  const Pieces all = pieces_of(real), made = pieces_of(synthesized);
  const auto halves = halves_of(real);
  SecondsFidelity out;
  const auto apart_by_spectra = [&](const Pieces& a, const Pieces& b, std::mt19937_64* random = nullptr) {
    return distance_of(spectral_windows(a, rate, rows), spectral_windows(b, rate, rows, random), max_windows, seed);
  };
  std::mt19937_64 random(seed);
  out.spectra = {apart_by_spectra(all, made), apart_by_spectra(halves[0], halves[1]),
                 apart_by_spectra(all, all, &random)};
  out.real = extremes_of(all, rate);
  out.synthesized = extremes_of(made, rate);
  const FallExtremes half = extremes_of(halves[0], rate), other = extremes_of(halves[1], rate);
  out.tails = {tails_apart(out.real, out.synthesized), tails_apart(half, other),
               tails_apart(out.real, normal_like(all, out.real))};
  const auto apart = [](double a, double b) {
    return a > kUnseenMetres * kUnseenMetres ? std::abs(b / a - 1)
                                             : kMissing;  // what does not spread has no share of it
  };
  out.spread = {apart(out.real.spread[2], out.synthesized.spread[2]), apart(half.spread[2], other.spread[2]),
                apart(out.real.spread[2], shuffled_spread(all, rows))};
  return out;
}

}  // namespace wisp::chain
