#include "learn/outline/resampled_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "learn/judge/prediction.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_shape.hpp"

namespace wisp {
namespace {

// Lags at which input histories are compared: over 0.15 s, denser at recent times, which matter most. Earlier wind acts
// through the state of the dynamics; comparing it too would cause more jumps, each of which adds unrecorded noise.
constexpr double kLagSeconds[] = {0, 1.0 / 60, 3.0 / 60, 5.0 / 60, 9.0 / 60};
constexpr double kTolerance = 0.2;       // in units of wind: smaller causes more jumps, larger a worse match of wind
constexpr double kLongestSeconds = 1.5;  // maximum time between jumps, so that play does not visibly repeat the film
constexpr double kCalm = 0.04;           // in units of wind: weaker wind does not move a flame at rest
constexpr double kMargin = 0.01;   // in units of wind: differences below it, a microphone's resolution, count as 0
constexpr double kMinSeconds = 1;  // with inputs and fewer rows, nothing is resampled
constexpr std::size_t kCurveSamples = 60;  // points per outline in the check for self-intersection
constexpr double kLargestWind = 32767;
constexpr std::size_t kMaxBytes = 256 * 1024;  // maximum size of all rows; beyond it every stretch is shortened

// Residuals and wind of one row, NaN where missing.
struct Row {
  std::vector<double> residual;
  double wind = 0;

  bool complete() const {
    return std::isfinite(wind) &&
           std::all_of(residual.begin(), residual.end(), [](double x) { return std::isfinite(x); });
  }
};

// Consecutive rows, and the wind before them.
struct RowStretch {
  std::vector<double> before;
  std::vector<Row> rows;
};

// Signed samples of the first input; zeros without inputs.
std::vector<double> signed_input(const Recording& recording, const PreparedOutlines& prepared) {
  if (prepared.inputs.empty()) return std::vector<double>(recording.rows(), 0.0);
  return samples_of(recording, prepared.inputs.front().name);
}

// Returns whether wind begins after calm, where a stretch must end: otherwise the play of a lasting calm could continue
// into a recorded gust within the tolerance, and move by the gust's residuals.
bool begins_to_blow(const Row& before, const Row& now) {
  return std::abs(before.wind) <= kCalm && std::abs(now.wind) > kCalm;
}

// Appends a row to the last stretch, or to a new one if the last one does not go on.
void add_row(const std::vector<double>& wind, std::size_t row, std::size_t past, Row one,
             std::vector<RowStretch>& stretches, bool& goes_on) {
  const auto before = wind.begin() + static_cast<std::ptrdiff_t>(row);
  const std::vector<double> heard(before - static_cast<std::ptrdiff_t>(past), before);
  const bool known = std::all_of(heard.begin(), heard.end(), [](double x) { return std::isfinite(x); });
  if (!one.complete() || !known) {
    goes_on = false;
    return;
  }
  if (!goes_on || begins_to_blow(stretches.back().rows.back(), one)) stretches.push_back({heard, {}});
  stretches.back().rows.push_back(std::move(one));
  goes_on = true;
}

// Flags per row: whether its outline may be played, that is, has no self-intersection.
std::vector<bool> simple_outlines(const Recording& given, const PreparedOutlines& prepared) {
  const OutlineCurve curve(prepared.layout.knots, kCurveSamples);
  std::vector<bool> out;
  for (std::size_t row = 0; row < given.rows(); ++row) {
    const std::vector<double> control = whole_row(given, prepared.layout, row);
    out.push_back(!control.empty() && !crosses_itself(curve.polyline(control)));
  }
  return out;
}

// Residuals of the complete rows whose outlines do not cross themselves, in stretches of two rows or more.
Result<std::vector<RowStretch>> stretches_left(const OutlineDynamics& dynamics, const Recording& given,
                                               const PreparedOutlines& prepared, std::size_t past) {
  const Recording recording = moved_recording(dynamics.shape, given, prepared);
  const ChannelChoice channels = moved_channels(dynamics.shape, prepared);
  const auto predicted = predict(dynamics.arx, recording, channels, {.steps = 1});
  if (!predicted) return predicted.error();
  const std::vector<double> wind = signed_input(recording, prepared);
  const std::vector<bool> simple = simple_outlines(given, prepared);
  std::vector<RowStretch> out;
  for (const Episode& episode : episodes(recording)) {
    bool goes_on = false;
    for (std::size_t row = episode.begin + past; row < episode.end; ++row) {
      Row one{{}, wind[row]};
      for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
        one.residual.push_back(simple[row] ? recording.channels[i].samples[row] - (*predicted)[i][row] : kMissing);
      }
      add_row(wind, row, past, std::move(one), out, goes_on);
    }
  }
  std::erase_if(out, [](const RowStretch& stretch) { return stretch.rows.size() < 2; });
  return out;
}

std::size_t row_count(const std::vector<RowStretch>& stretches) {
  std::size_t rows = 0;
  for (const RowStretch& stretch : stretches) rows += stretch.rows.size();
  return rows;
}

// Shortens all stretches by the same share, at their ends, so that at most `rows` rows remain.
void keep_at_most(std::vector<RowStretch>& stretches, std::size_t rows) {
  const auto all = static_cast<double>(row_count(stretches));
  if (all <= static_cast<double>(rows)) return;
  for (RowStretch& stretch : stretches) {
    const auto size = static_cast<double>(stretch.rows.size());
    stretch.rows.resize(static_cast<std::size_t>(size * static_cast<double>(rows) / all));
  }
  std::erase_if(stretches, [](const RowStretch& stretch) { return stretch.rows.size() < 2; });
}

void find_scales(const std::vector<RowStretch>& stretches, ResampledResiduals& out) {
  out.scale.assign(stretches.front().rows.front().residual.size(), 0.0);
  const auto hear = [&](double wind) { out.wind_scale = std::max(out.wind_scale, std::abs(wind) / kLargestWind); };
  for (const RowStretch& stretch : stretches) {
    for (double wind : stretch.before) hear(wind);
    for (const Row& row : stretch.rows) {
      hear(row.wind);
      for (std::size_t i = 0; i < out.scale.size(); ++i)
        out.scale[i] = std::max(out.scale[i], std::abs(row.residual[i]) / kLargestStored);
    }
  }
}

void store_rows(const std::vector<RowStretch>& stretches, ResampledResiduals& out) {
  find_scales(stretches, out);
  const auto hear = [&](double wind) {
    if (out.toward >= 0) out.winds.push_back(static_cast<std::int16_t>(stored(wind, out.wind_scale, kLargestWind)));
  };
  for (const RowStretch& stretch : stretches) {
    for (double wind : stretch.before) hear(wind);
    for (const Row& row : stretch.rows) {
      for (std::size_t i = 0; i < out.scale.size(); ++i)
        out.rows.push_back(static_cast<std::int8_t>(stored(row.residual[i], out.scale[i])));
      hear(row.wind);
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.row_count() + stretch.rows.size()));
  }
}

std::vector<int> lags_of(double rate_hz) {
  std::vector<int> lags;
  for (double seconds : kLagSeconds) {
    const int lag = static_cast<int>(std::lround(seconds * rate_hz));
    if (lags.empty() || lag > lags.back()) lags.push_back(lag);
  }
  return lags;
}

// Numbers of the components, from 1; those of antisymmetric components are negative: reflection changes their sign.
std::vector<int> mirror_image(const ShapeComponents& shape) {
  std::vector<int> out;
  for (int k = 1; k <= static_cast<int>(shape.count()); ++k) {
    out.push_back(k <= static_cast<int>(shape.symmetric) ? k : -k);
  }
  return out;
}

}  // namespace

double stored(double value, double scale, double largest) {
  const double units = scale > 0 ? std::round(value / scale) : 0;
  return std::clamp(units, -largest, largest);
}

Result<ResampledResiduals> resampled_residuals(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                               const PreparedOutlines& prepared) {
  const double rate = recordings.front().rate_hz;
  const bool driven = !prepared.inputs.empty();
  ResampledResiduals out;
  if (driven) out.lags = lags_of(rate);
  const auto past = static_cast<std::size_t>(driven ? out.lags.back() : 0);
  std::vector<RowStretch> stretches;
  for (const Recording& recording : recordings) {
    auto found = stretches_left(dynamics, recording, prepared, past);
    if (!found) return found.error();
    for (RowStretch& stretch : *found) stretches.push_back(std::move(stretch));
  }
  keep_at_most(stretches, kMaxBytes / dynamics.shape.count());
  if (stretches.empty()) {
    return Error{recordings.front().source +
                 ": has no two complete rows with their past after each other; record longer"};
  }
  if (driven && static_cast<double>(row_count(stretches)) < kMinSeconds * rate) return ResampledResiduals{};
  if (driven) out.toward = 3;  // index of the signed input, after its size, square root and square
  if (driven) out.mirror = mirror_image(dynamics.shape);
  if (driven) out.tolerance = kTolerance;
  if (driven) out.margin = kMargin;
  if (driven) out.longest = std::max(1, static_cast<int>(std::lround(kLongestSeconds * rate)));
  store_rows(stretches, out);
  return out;
}

}  // namespace wisp
