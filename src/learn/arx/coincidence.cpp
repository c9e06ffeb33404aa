// Sources: C. Granger, Econometrica 37 (1969): a cause improves on the prediction from the output's own past. C.
// Granger and P. Newbold, J. Econometrics 2 (1974): channels that only drift alike explain each other.

#include <algorithm>
#include <cmath>

#include "learn/arx/learn_arx.hpp"
#include "learn/choose/search_fit.hpp"
#include "learn/judge/held_out.hpp"
#include "learn/numeric/chi_squared.hpp"

namespace wisp::arx {

std::optional<PastEffect> effect_of_past(std::span<const Recording> recordings, const ChannelChoice& channels,
                                         const std::vector<std::vector<LaggedChannel>>& sets, int own_lags) {
  const auto signals = gather_signals(recordings, channels, ArxOffset::kMean);
  if (!signals) return std::nullopt;
  std::vector<LaggedChannel> used;
  for (int lag = 1; lag <= own_lags; ++lag) used.push_back({0, lag});
  for (const auto& set : sets) used.insert(used.end(), set.begin(), set.end());
  const LagLayout layout(1, signals->inputs, used);
  SearchWindows windows(*signals, layout, layout.history(), layout.history());
  PastEffect effect{double(windows.rows(layout.history()))};
  if (effect.rows <= layout.size()) return std::nullopt;
  const int target = layout.target(0);
  std::vector<int> base{0};
  effect.size = left_by(windows, layout.history(), base, {target}).squaredNorm();
  for (int lag = 1; lag <= own_lags; ++lag) base.push_back(layout.find({0, lag}));
  effect.own = left_by(windows, layout.history(), base, {target}).squaredNorm();
  for (const auto& set : sets) {
    std::vector<int> beside = base;
    for (const LaggedChannel& column : set) beside.push_back(layout.find(column));
    effect.both.push_back(left_by(windows, layout.history(), beside, {target}).squaredNorm());
  }
  return effect;
}

std::optional<Remark> coincidence(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOrders& orders) {
  constexpr int kShifts = 10, kMinBehind = 8, kMinShift = 40, kLags = 2;
  constexpr double kChance = 1e-3, kExact = 1e-9;
  const std::vector<Recording> some = middles_of(recordings, 8192);  // more rows would not change the answer
  std::size_t longest = 0;
  for (const Recording& recording : some) longest = std::max(longest, recording.rows());
  const int last = int(longest / 4), first = std::min(kMinShift, last / 2), own_lags = std::min(20, last / 5);
  for (int i = 0; i < orders.outputs(); ++i) {
    std::vector<std::vector<LaggedChannel>> sets(1 + kShifts);
    for (int s = 0; s <= kShifts; ++s) {
      const int shift = s == 0 ? 0 : first + (last - first) * (s - 1) / (kShifts - 1);
      for (int k = 0; k < orders.inputs(); ++k) {
        for (int lag = 0; lag < std::min(orders.nb(i, k), kLags); ++lag)
          sets[std::size_t(s)].push_back({1 + k, orders.nk(i, k) + lag + shift});
      }
    }
    const ChannelChoice alone{channels.inputs, {channels.outputs[std::size_t(i)]}};
    auto effect = sets.front().empty() ? std::nullopt : effect_of_past(some, alone, sets, own_lags);
    if (effect && effect->own <= kExact * effect->size) effect = effect_of_past(some, alone, sets, orders.na(i, i));
    if (!effect) continue;
    const double limit = chi_squared_quantile(1 - kChance, double(sets.front().size()));
    const auto behind = [&](double left) {
      const double trace = 0.1 * kExact * effect->size;
      return effect->rows * std::log((left + trace) / (effect->both.front() + trace)) > limit;
    };
    if (std::count_if(effect->both.begin() + 1, effect->both.end(), behind) >= kMinBehind) continue;
    const auto best = std::min_element(effect->both.begin() + 1, effect->both.end()) - effect->both.begin();
    const int shift = sets[std::size_t(best)].front().lag - sets.front().front().lag;
    return Remark{
        RemarkKind::kExcitation, alone.outputs[0],
        "the inputs explain '" + alone.outputs[0] + "' no better than they do as they were " + std::to_string(shift) +
            " samples before: a drift or a period, which unrelated channels may share, explains as much",
        "record with an input that moves by itself, at uneven intervals; --prepare detrend takes off a drift"};
  }
  return std::nullopt;
}

}  // namespace wisp::arx
