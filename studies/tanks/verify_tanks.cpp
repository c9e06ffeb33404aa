// The cascaded tanks of the nonlinear benchmarks (M. Schoukens, P. Mattsson, T. Wigren & J.-P. Noël, 2016): one table
// of ARX and Markov-switched ARX on a recording that learning has not seen. Prints it; exit status 1 where a bound is
// missed, 0 with a word where the recordings are not there.
//
//   wisp_verify_tanks
//
// The recordings are cascaded_tanks_est.csv and cascaded_tanks_val.csv in the folder sysid of WISP_DATA. Simulations of
// the second start from its first measured samples, as many as the model looks back; the error is counted from there
// on. The benchmark's own state may be found from the first samples likewise.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/markov/markov_rows.hpp"
#include "learn/shared_files.hpp"
#include "studies/value_or_abort.hpp"
#include "studies/verify_bounds.hpp"

namespace wisp::verify {
namespace {

const ChannelChoice kChannels{{"u1"}, {"y1"}};
constexpr int kModes = 4;

struct Tanks {
  Recording learn;
  Recording validate;
};

ArxOrders orders_of(int n) { return {OrderMatrix(1, 1, n), OrderMatrix(1, 1, n), OrderMatrix(1, 1, 1)}; }

struct Range {
  double lowest;
  double highest;
};

Range range_of(const Recording& recording, const std::string& name) {
  const auto& samples = recording.channels[*find_channel(recording, name)].samples;
  const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end());
  return {*lowest, *highest};
}

double rms_error(const std::vector<double>& simulated, const Recording& recording) {
  const auto& measured = recording.channels[*find_channel(recording, "y1")].samples;
  double sum = 0, rows = 0;
  for (std::size_t t = 0; t < measured.size(); ++t) {
    if (!std::isfinite(simulated[t])) continue;
    sum += (measured[t] - simulated[t]) * (measured[t] - simulated[t]);
    ++rows;
  }
  return std::sqrt(sum / rows);
}

/// A linear model.
struct Simulated {
  double free = 0;     ///< root mean square error in volt
  double clipped = 0;  ///< the same with every output held to the range seen in learning, which feeds back
};

// Simulation step by step with the output held to what was seen: the overflow, as a bound of the output.
double clipped_error(const ArxModel& model, const Recording& recording, Range seen) {
  const auto& u = recording.channels[*find_channel(recording, "u1")].samples;
  const auto& y = recording.channels[*find_channel(recording, "y1")].samples;
  const auto history = static_cast<std::size_t>(model.orders.history());
  std::vector<double> made(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(history));
  made.resize(y.size());
  const auto a = model.a(0, 0), b = model.b(0, 0);
  for (std::size_t t = history; t < y.size(); ++t) {
    double sum = model.output_mean[0] + model.constant[0];
    for (std::size_t l = 0; l < a.size(); ++l) sum -= a[l] * (made[t - 1 - l] - model.output_mean[0]);
    const auto delay = static_cast<std::size_t>(model.orders.nk(0, 0));
    for (std::size_t l = 0; l < b.size(); ++l) sum += b[l] * (u[t - delay - l] - model.input_mean[0]);
    made[t] = std::clamp(sum, seen.lowest, seen.highest);
  }
  std::fill_n(made.begin(), history, std::numeric_limits<double>::quiet_NaN());
  return rms_error(made, recording);
}

Simulated linear(const Tanks& tanks, int n) {
  ArxOptions arx;
  arx.orders = orders_of(n);
  const auto fit = value_or_abort(fit_arx({&tanks.learn, 1}, kChannels, arx));
  const auto simulated = value_or_abort(predict(fit.model, tanks.validate, kChannels, {.steps = kFreeRun}));
  return {rms_error(simulated[0], tanks.validate),
          clipped_error(fit.model, tanks.validate, range_of(tanks.learn, "y1"))};
}

double switched(const Tanks& tanks, int n, int modes) {
  const auto fit = value_or_abort(markov::fit({&tanks.learn, 1}, kChannels, {.orders = orders_of(n), .modes = modes}));
  const auto simulated = value_or_abort(markov::predict(fit.model, tanks.validate, kChannels, kFreeRun));
  return rms_error(simulated[0], tanks.validate);
}

void print_linear(const Tanks& tanks) {
  std::printf(
      "\nRoot mean square error of free simulation on what was not learned from, volt\n   n   ARX    held to the "
      "range\n");
  for (int n = 2; n <= 4; ++n) {
    const Simulated plain = linear(tanks, n);
    std::printf("   %d  %.3f    %.3f\n", n, plain.free, plain.clipped);
  }
}

double print_switched(const Tanks& tanks) {
  double best = std::numeric_limits<double>::infinity();
  std::printf("\nMarkov-switched ARX, volt\n   n   modes 2, 3, …\n");
  for (int n = 2; n <= 4; ++n) {
    std::printf("   %d ", n);
    for (int modes = 2; modes <= kModes; ++modes) {
      const double error = switched(tanks, n, modes);
      best = std::min(best, error);
      std::printf("  %.3f", error);
    }
    std::printf("\n");
  }
  return best;
}

}  // namespace
}  // namespace wisp::verify

int main() {
  using namespace wisp;
  using namespace wisp::verify;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (!std::filesystem::exists(shared::data("sysid/cascaded_tanks_val.csv"))) {
    std::printf("the recordings of the cascaded tanks are not there; WISP_DATA names their folder\n");
    return 0;
  }
  const Tanks tanks{shared::read_sysid("cascaded_tanks_est"), shared::read_sysid("cascaded_tanks_val")};
  std::printf("== Cascaded tanks\n");
  print_linear(tanks);
  const double best = print_switched(tanks);
  Bounds bounds;
  std::printf("\n");
  bounds.at_most("ARX of order 4, volt", linear(tanks, 4).free, 0.66);
  bounds.at_most("the best Markov-switched ARX, volt", best, 0.8);
  return bounds.missed() == 0 ? 0 : 1;
}
