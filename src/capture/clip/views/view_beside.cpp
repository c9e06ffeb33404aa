#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

#include "base/statistics.hpp"
#include "capture/clip/views/view_join.hpp"
#include "record/loudness.hpp"
#include "record/verdict.hpp"
#include "wisp/model/shape_components.hpp"

namespace wisp {
namespace {

constexpr double kCalm = 0.05;                              // wind above which a blow is present
constexpr double kPauseSeconds = 0.25, kLagSeconds = 0.05;  // longest pause within a blow; lag of flame behind wind

struct Blow {
  std::size_t begin = 0, end = 0;  // rows [begin, end)
  double x = 1, z = 0;             // direction, unit vector
  double alike = 0, answer = 0;    // agreement of the lean's directions, 0 to 1; lean per wind, px
  double strength = 0;             // mean wind, weighted by the wind's square
  double azimuth() const { return std::atan2(-z, x); }
};

std::vector<Blow> blows_of(const std::vector<double>& wind, double rate_hz) {
  std::vector<Blow> out;
  for (std::size_t row = 0; row < wind.size(); ++row) {
    if (!(wind[row] > kCalm)) continue;
    if (out.empty() || static_cast<double>(row - out.back().end) > kPauseSeconds * rate_hz) out.push_back({row, row});
    out.back().end = row + 1;
  }
  return out;
}

// Returns the displacements from the median of the calm rows, or of all rows if at most ten are calm.
std::vector<double> displaced(std::vector<double> place, const std::vector<double>& wind) {
  std::vector<double> calm, any;
  for (std::size_t row = 0; row < place.size(); ++row) {
    if (std::isnan(place[row])) continue;
    any.push_back(place[row]);
    if (!(wind[row] > kCalm)) calm.push_back(place[row]);
  }
  const double rest = median(calm.size() > 10 ? std::move(calm) : std::move(any));
  for (double& value : place) value -= rest;
  return place;
}

// Sets a blow's direction (that of the mean tip displacement, weighted by the wind), `alike`, `answer`, `strength`.
void direct(const std::vector<double>& wind, const std::vector<double>& x, const std::vector<double>& z,
            std::size_t lag, Blow& blow) {
  double sum_x = 0, sum_z = 0, all = 0, square = 0, cube = 0;
  for (std::size_t row = blow.begin; row < blow.end && row + lag < x.size(); ++row) {
    const double dx = wind[row] * x[row + lag], dz = wind[row] * z[row + lag];
    if (std::isnan(dx + dz)) continue;
    sum_x += dx, sum_z += dz, all += std::hypot(dx, dz), square += wind[row] * wind[row];
    cube += std::pow(wind[row], 3);
  }
  const double length = std::hypot(sum_x, sum_z);
  if (length > 0)
    blow.x = sum_x / length, blow.z = sum_z / length, blow.alike = length / all, blow.answer = length / square;
  if (square > 0) blow.strength = cube / square;
}

std::vector<double> heard_along(const Recording* film, double first_row, std::size_t rows) {
  std::vector<double> wind(rows, 0.0);
  if (!film) return wind;
  const auto& heard = film->channels[channels_with_role(*film, Role::kInput).front()].samples;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto nearest = static_cast<std::size_t>(std::max(0.0, std::round(first_row + static_cast<double>(row))));
    wind[row] = heard[std::min(nearest, heard.size() - 1)];
  }
  return wind;
}

// Returns a report on the blows. Stores in the recording how far the flame deviates from rotational symmetry.
ReportSection wind_section(const std::vector<Blow>& blows, Recording& rings) {
  ReportTable table{"blows",
                    "Blows",
                    {{"begin", "begin", "s"},
                     {"seconds", "for", "s"},
                     {"azimuth", "towards", "°"},
                     {"alike", "of the lean that way"},
                     {"answer", "lean for each 1 of wind", "px"}},
                    {}};
  std::vector<BlowAnswer> answers;
  for (const Blow& blow : blows) {
    if (blow.answer > 0) answers.push_back({blow.azimuth(), blow.strength, blow.answer});
    table.rows.push_back({static_cast<double>(blow.begin) / rings.rate_hz,
                          static_cast<double>(blow.end - blow.begin) / rings.rate_hz,
                          blow.azimuth() * 180 / std::numbers::pi, blow.alike, blow.answer});
  }
  if (const auto found = asymmetry_of(answers)) set_numbers_attribute(rings, "symmetry", *found);
  return {"Wind", {{"blows.count", blows.size(), "blows", ""}, symmetry_entry(rings)}, {std::move(table)}};
}

// Maximum harmonics() of ones at the blows' directions: 0 for evenly distributed directions, at least 0.87 for two
// directions, 4 for a single one.
constexpr double kMaxDirectionPower = 0.95;

// Returns the mean square over all directions of the first two harmonics fitted to `numbers`, one per blow.
double harmonics(std::span<const BlowAnswer> blows, std::span<const double> numbers) {
  double power = 0;
  for (const int times : {1, 2}) {
    std::complex<double> sum;
    for (std::size_t k = 0; k < blows.size(); ++k) sum += numbers[k] * std::polar(1.0, times * blows[k].azimuth);
    power += std::norm(sum);
  }
  return 2 * power / static_cast<double>(blows.size() * blows.size());
}

}  // namespace

ReportSection see_from_beside(const Recording* film, double first_row, Recording& rings) {
  const std::size_t rows = rings.rows(), ring_parts = rings.channels.size(), points = ring_parts / 3;
  const std::vector<double> wind = heard_along(film, first_row, rows);
  std::vector<std::vector<double>> parts;  // x, y, z, r, tx, tz of each ring; x, z, tx, tz relative to rest
  for (std::size_t k = 0; k < ring_parts; ++k) {
    const auto& samples = rings.channels[k].samples;
    parts.push_back(k % 6 == 1 || k % 6 == 3 ? samples : displaced(samples, wind));
  }
  std::vector<Blow> blows = blows_of(wind, rings.rate_hz);
  const auto lag = static_cast<std::size_t>(kLagSeconds * rings.rate_hz);
  for (Blow& blow : blows) direct(wind, parts[ring_parts - 6], parts[ring_parts - 4], lag, blow);
  Channel wind_x{"wind.x", "", Role::kMotion, wind}, wind_z{"wind.z", "", Role::kMotion, wind};
  std::vector<Channel> outline;
  for (std::size_t k = 0; k < 2 * points; ++k)
    outline.push_back(
        {"p" + std::to_string(k / 2) + (k % 2 == 0 ? ".x" : ".y"), "px", Role::kOutput, std::vector<double>(rows)});
  rings.episode_ids.assign(rows, 0);
  for (std::size_t row = 0, at = 0; row < rows; ++row) {
    while (at + 1 < blows.size() && row >= blows[at + 1].begin) ++at;
    const Blow now = blows.empty() ? Blow{} : blows[at];
    std::vector<double> even, odd;
    for (std::size_t k = 0; k < ring_parts; k += 6) {
      even.insert(even.end(), {parts[k + 3][row], parts[k + 1][row]});
      for (const std::size_t level : {k, k + 4}) {
        const std::size_t across = level == k ? k + 2 : k + 5;
        odd.push_back(parts[level][row] * now.x + parts[across][row] * now.z);
      }
    }
    even.insert(even.end(), odd.begin(), odd.end());
    const std::vector<double> control = control_points(even);
    for (std::size_t k = 0; k < control.size(); ++k) outline[k].samples[row] = k % 2 == 0 ? control[k] : -control[k];
    wind_x.samples[row] *= now.x, wind_z.samples[row] *= now.z;
    rings.episode_ids[row] = static_cast<std::int64_t>(at);
  }
  if (film) {
    Channel along = film->channels[channels_with_role(*film, Role::kInput).front()];
    along.samples = wind;
    if (const auto loud = one_rms(*film, along.name); loud && *loud) set_one_rms(rings, along.name, **loud);
    outline.insert(outline.begin(), std::move(along));
  }
  outline.insert(outline.end(), {std::move(wind_x), std::move(wind_z)});
  rings.channels.insert(rings.channels.begin(), outline.begin(), outline.end());
  return wind_section(blows, rings);
}

std::optional<std::array<double, 3>> asymmetry_of(std::span<const BlowAnswer> blows) {
  const std::size_t n = blows.size();
  if (n < kMinSymmetryBlows || harmonics(blows, std::vector<double>(n, 1.0)) > kMaxDirectionPower) return {};
  double strength = 0, lean = 0, both = 0, square = 1e-12;
  const auto count = static_cast<double>(n);
  for (const BlowAnswer& blow : blows) strength += blow.strength / count, lean += blow.lean / count;
  for (const BlowAnswer& blow : blows) {
    both += (blow.strength - strength) * (blow.lean - lean), square += std::pow(blow.strength - strength, 2);
  }
  std::vector<double> rest, by_chance;
  for (const BlowAnswer& blow : blows)
    rest.push_back((blow.lean - lean - both / square * (blow.strength - strength)) / lean);
  const double seen = harmonics(blows, rest), lost = count / (count - 2);
  std::mt19937 generator(1);
  for (int k = 0; k < 1000; ++k) {
    for (std::size_t left = n; left > 1; --left) std::swap(rest[left - 1], rest[generator() % left]);
    by_chance.push_back(lost * harmonics(blows, rest));
  }
  const double reach = std::sqrt(quantile(by_chance, 0.95)), share = std::sqrt(seen);
  // Permuted leans still contain the dependence on direction: 4 / n of its power counts as chance.
  return std::array{100 * std::sqrt(std::max(0.0, seen - mean(by_chance)) / (1 - 4 / count)),
                    100 * std::max(0.0, share - reach), 100 * (share + reach)};
}

}  // namespace wisp
