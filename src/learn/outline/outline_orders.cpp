// Source: L.-M. Reissell and D. K. Pai (2001), sections 3.4 and 5.1: orders are compared by their fit to data that was
// not learned from, or by Akaike's final prediction error where there is none; and since high orders gain little to the
// eye, a lower one is taken when it is nearly as good.

#include "learn/outline/outline_orders.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "learn/arx/rows/arx_orders.hpp"
#include "learn/arx/search/order_search.hpp"
#include "learn/outline/outline_verdict.hpp"

namespace wisp {
namespace {

// Every order where it matters, then wider apart: neighbouring high orders are alike. 25 is the paper's best.
constexpr int kOrders[] = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32};
constexpr double kLongestDelay = 0.25;       // seconds: beyond any flame's answer and a camera's lag
constexpr double kNearlyAsGood = 1.02;       // in root mean square error: below what an eye can distinguish
constexpr std::size_t kMinHeldOutRows = 60;  // beside the longest history

// Channels that move at all: a search has no use for the others.
struct Moving {
  std::vector<int> outputs;
  std::vector<int> inputs;
  ChannelChoice channels;
};

bool moves(std::span<const Recording> recordings, const std::string& name) {
  std::optional<double> first;
  for (const Recording& recording : recordings) {
    for (double value : recording.channels[*find_channel(recording, name)].samples) {
      if (std::isnan(value)) continue;
      if (first && value != *first) return true;
      first = value;
    }
  }
  return false;
}

Moving moving_channels(std::span<const Recording> learned, const ChannelChoice& channels) {
  Moving out;
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    if (!moves(learned, channels.outputs[i])) continue;
    out.outputs.push_back(static_cast<int>(i));
    out.channels.outputs.push_back(channels.outputs[i]);
  }
  for (std::size_t k = 0; k < channels.inputs.size(); ++k) {
    if (!moves(learned, channels.inputs[k])) continue;
    out.inputs.push_back(static_cast<int>(k));
    out.channels.inputs.push_back(channels.inputs[k]);
  }
  return out;
}

ArxOrders reduced(const ArxOrders& orders, const Moving& moving) {
  const auto ny = static_cast<int>(moving.outputs.size());
  const auto nu = static_cast<int>(moving.inputs.size());
  ArxOrders out{OrderMatrix(ny, ny), OrderMatrix(ny, nu), OrderMatrix(ny, nu)};
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) out.na(i, j) = orders.na(moving.outputs[i], moving.outputs[j]);
    for (int k = 0; k < nu; ++k) {
      out.nb(i, k) = orders.nb(moving.outputs[i], moving.inputs[k]);
      out.nk(i, k) = orders.nk(moving.outputs[i], moving.inputs[k]);
    }
  }
  return out;
}

// What is compared, and the order matrices beside it.
struct Candidates {
  std::vector<OutlineCandidate> list;
  std::vector<ArxOrders> orders;
};

Candidates candidates_for(std::size_t rows, const PreparedOutlines& prepared, const Moving& moving,
                          const OutlineRecipe& options) {
  const double rate_hz = prepared.recordings.front().rate_hz;
  const int first = options.delay.value_or(0);
  const bool search_delay = !options.delay && !moving.inputs.empty();
  const int last = search_delay ? std::max(1, static_cast<int>(std::lround(kLongestDelay * rate_hz))) : first;
  Candidates out;
  const auto add = [&](int order, int delay) {
    ArxOrders orders = reduced(outline_orders(order, delay, *options.coupling, prepared), moving);
    const auto wanted = static_cast<std::size_t>(kMinRowsACoefficient * max_coefficients(orders));
    if (!out.list.empty() && rows < wanted + static_cast<std::size_t>(orders.history())) return;
    out.list.push_back({order, delay, 0, 0});
    out.orders.push_back(std::move(orders));
  };
  std::vector<int> tried(std::begin(kOrders), std::end(kOrders));
  if (options.order) tried = {*options.order};
  for (int order : tried) {
    for (int delay = first; delay <= last; ++delay) add(order, delay);
  }
  return out;
}

// The geometric mean over channels of a root mean square.
double error_of(const std::vector<double>& mean_squares) {
  double sum = 0;
  for (double square : mean_squares) sum += std::log(std::max(square, 1e-300));
  return std::exp(0.5 * sum / static_cast<double>(std::max<std::size_t>(1, mean_squares.size())));
}

const char* shown(OutlineCriterion by) {
  switch (by) {
    case OutlineCriterion::kGiven:
      return "as given";
    case OutlineCriterion::kFpe:
      return "the final prediction error";
    case OutlineCriterion::kHeldOutStep:
      return "the held-out error one step ahead";
    case OutlineCriterion::kHeldOutFreeRun:
      return "the held-out error of free simulation";
  }
  return "";
}

std::string reason_for(const OutlineChoice& choice, const OutlineCandidate& best) {
  char text[256];
  const OutlineCandidate& taken = choice.candidates[choice.chosen];
  std::snprintf(text, sizeof text, "order %d, delay %d of %zu candidates by %s", taken.order, taken.delay,
                choice.candidates.size(), shown(choice.by));
  std::string reason = text;
  if (taken.order == best.order && taken.delay == best.delay) return reason + ": the best";
  std::snprintf(text, sizeof text, ": order %d, delay %d is only %.1f %% better", best.order, best.delay,
                100 * (taken.error / best.error - 1));
  return reason + text;
}

// The lowest order that is nearly as good as the best, at its own best delay.
void choose(OutlineChoice& choice) {
  const auto less = [](const OutlineCandidate& a, const OutlineCandidate& b) { return a.error < b.error; };
  const OutlineCandidate best = *std::min_element(choice.candidates.begin(), choice.candidates.end(), less);
  int order = best.order;
  for (const OutlineCandidate& one : choice.candidates) {
    if (one.error <= kNearlyAsGood * best.error) order = std::min(order, one.order);
  }
  std::optional<std::size_t> chosen;
  for (std::size_t c = 0; c < choice.candidates.size(); ++c) {
    if (choice.candidates[c].order != order) continue;
    if (!chosen || choice.candidates[c].error < choice.candidates[*chosen].error) chosen = c;
  }
  choice.chosen = *chosen;
  choice.reason = reason_for(choice, best);
}

OutlineCriterion criterion_for(std::span<const Recording> held_out, const Moving& moving,
                               const Candidates& candidates) {
  int history = 0;
  for (const ArxOrders& orders : candidates.orders) history = std::max(history, orders.history());
  if (complete_rows(held_out, moving.channels) < kMinHeldOutRows + static_cast<std::size_t>(history)) {
    return OutlineCriterion::kFpe;
  }
  return moving.inputs.empty() ? OutlineCriterion::kHeldOutStep : OutlineCriterion::kHeldOutFreeRun;
}

}  // namespace

ArxOrders outline_orders(int order, int delay, OutlineCoupling coupling, const PreparedOutlines& prepared) {
  UniformOrders uniform;
  uniform.outputs = static_cast<int>(prepared.channels.outputs.size());
  uniform.inputs = static_cast<int>(prepared.channels.inputs.size());
  uniform.na = uniform.nb = order;
  uniform.nk = delay;
  uniform.group = 2;
  switch (coupling) {
    case OutlineCoupling::kCoordinate:
      uniform.group = 1;
      uniform.coupling = Coupling::kDiagonal;
      break;
    case OutlineCoupling::kPoint:
      uniform.coupling = Coupling::kDiagonal;
      break;
    case OutlineCoupling::kBand:
      uniform.coupling = Coupling::kBand;
      break;
    case OutlineCoupling::kFull:
      uniform.coupling = Coupling::kFull;
      break;
  }
  ArxOrders orders = make_orders(uniform);
  if (coupling != OutlineCoupling::kFull) return orders;
  // The last point is the first one mirrored about the base: together they would be a regressor twice.
  for (int i = 0; i < uniform.outputs; ++i) {
    for (int j = uniform.outputs - 2; j < uniform.outputs; ++j) orders.na(i, j) = 0;
    if (!prepared.shape.powers) continue;
    // Twice the lags for an input itself, whose delay no few poles make; its root and its square begin one later.
    for (int k = 0; k < uniform.inputs; ++k) {
      const bool power = k % 3 != 0;
      orders.nb(i, k) = power ? order : 2 * order;
      orders.nk(i, k) = delay + (power ? 1 : 0);
    }
  }
  return orders;
}

Result<OutlineChoice> choose_orders(std::span<const Recording> learned, std::span<const Recording> held_out,
                                    const PreparedOutlines& prepared, const OutlineRecipe& options) {
  OutlineChoice choice;
  if (options.order && (options.delay || prepared.inputs.empty())) {
    choice.candidates = {{*options.order, options.delay.value_or(0), 0, 0}};
    choice.reason = "as given";
    return choice;
  }
  const Moving moving = moving_channels(learned, prepared.channels);
  Candidates candidates = candidates_for(complete_rows(learned, moving.channels), prepared, moving, options);
  choice.by = criterion_for(held_out, moving, candidates);
  const bool by_fpe = choice.by == OutlineCriterion::kFpe;
  SearchOptions search{.candidates = candidates.orders,
                       .by = by_fpe ? OrderCriterion::kFpe : OrderCriterion::kValidation,
                       .steps = choice.by == OutlineCriterion::kHeldOutFreeRun ? kFreeRun : 1,
                       .common_start = true};
  const auto found = search_orders(learned, by_fpe ? std::span<const Recording>() : held_out, moving.channels, search);
  if (!found) return found.error();
  choice.candidates = std::move(candidates.list);
  const auto outputs = static_cast<double>(moving.outputs.size());
  for (std::size_t c = 0; c < choice.candidates.size(); ++c) {
    const OrderCandidate& candidate = found->candidates[c];
    choice.candidates[c].fpe = candidate.fpe;
    // The final prediction error is a determinant: a power of what a channel's error is.
    choice.candidates[c].error = by_fpe ? std::pow(candidate.fpe, 0.5 / outputs) : error_of(candidate.loss_validation);
    if (!std::isfinite(choice.candidates[c].error)) {
      choice.candidates[c].error = std::numeric_limits<double>::max();
    }
  }
  choose(choice);
  return choice;
}

}  // namespace wisp
