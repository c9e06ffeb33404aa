// A stable linear model that is driven by periodic shocks has one periodic orbit (for instance W. J. Rugh, Linear
// System Theory, 2nd ed., chapter 5): the free response to the mismatch of the ends, summed over all rounds, leads to
// it.

#include "export/orbit.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::exporting {
namespace {

// y(t) = Σ weight · y'(t − lag) for one output of one mode.
struct Tap {
  std::size_t output = 0;
  std::size_t lag = 1;
  double weight = 0;
};
using Rows = std::vector<std::vector<Tap>>;  // per output

Rows taps_of(const ArxModel& arx) {
  Rows rows(static_cast<std::size_t>(arx.orders.outputs()));
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    for (int j = 0; j < arx.orders.outputs(); ++j) {
      const auto a = arx.a(i, j);
      for (std::size_t lag = 0; lag < a.size(); ++lag) {
        if (a[lag] != 0) rows[i].push_back({static_cast<std::size_t>(j), lag + 1, -a[lag]});
      }
    }
  }
  return rows;
}

std::vector<Rows> taps_of(const Model& model) {
  std::vector<Rows> modes;
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) modes.push_back(taps_of(*arx));
  if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    for (std::size_t mode = 0; mode < switched->modes.size(); ++mode) {
      modes.push_back(taps_of(mode_model(*switched, mode)));
    }
  }
  return modes;
}

// One more row of the response without shocks.
void respond(const Rows& taps, std::size_t row, std::vector<double>& response) {
  const std::size_t outputs = taps.size();
  for (std::size_t i = 0; i < outputs; ++i) {
    double sum = 0;
    for (const Tap& tap : taps[i]) sum += tap.weight * response[(row - tap.lag) * outputs + tap.output];
    response[row * outputs + i] = sum;
  }
}

}  // namespace

std::size_t output_lags(const Model& model) {
  std::size_t longest = 1;
  for (const Rows& rows : taps_of(model)) {
    for (const auto& taps : rows) {
      for (const Tap& tap : taps) longest = std::max(longest, tap.lag);
    }
  }
  return longest;
}

bool close_orbit(const Model& model, std::span<const std::size_t> mode, std::size_t lags, std::vector<double>& rows) {
  constexpr double kClosed = 1e-12;  // of the largest number: far below what single precision shows
  constexpr std::size_t kMaxRows = 20'000'000;
  const auto modes = taps_of(model);
  const std::size_t outputs = model.outputs.size(), count = rows.size() / outputs, frames = count - lags;
  double largest = 0;
  for (double value : rows) largest = std::max(largest, std::abs(value));
  std::vector<double> response(rows.size(), 0.0);
  for (std::size_t done = 0; done < kMaxRows; done += count) {
    // The rows with which the loop begins are to be those that end it.
    double change = 0;
    for (std::size_t k = 0; k < lags * outputs; ++k) {
      const std::size_t end = k + frames * outputs;
      const double needed = rows[end] + response[end] - rows[k];
      change = std::max(change, std::abs(needed - response[k]));
      response[k] = needed;
    }
    for (std::size_t row = lags; row < count; ++row) respond(modes[modes.size() > 1 ? mode[row] : 0], row, response);
    if (!(change > kClosed * largest)) {
      for (std::size_t k = 0; k < rows.size(); ++k) rows[k] += response[k];
      return true;
    }
  }
  return false;
}

}  // namespace wisp::exporting
