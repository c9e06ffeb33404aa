#include "learn/chain/modes/mode_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace wisp::chain {
namespace {

using History = std::vector<std::uint16_t>;

// What followed a history: how often each mode, and what that is worth.
struct Followed {
  std::vector<std::size_t> seen;
  std::vector<double> worth;
};
using Counts = std::map<History, Followed>;

constexpr double kMinProbability = 1e-6;
constexpr double kGain = 0.002;  // nats a segment: a longer history must be worth as much
constexpr int kParts = 5;

double worth_of(const ModeWeights& weights, std::size_t sequence, std::size_t at) {
  return weights.empty() ? 1.0 : weights[sequence][at];
}

Counts count_followers(const ModeSequences& sequences, const ModeWeights& weights, int modes, int longest) {
  Counts counts;
  for (std::size_t k = 0; k < sequences.size(); ++k) {
    const auto& sequence = sequences[k];
    for (std::size_t at = 0; at < sequence.size(); ++at) {
      const auto most = std::min(at, static_cast<std::size_t>(longest));
      for (std::size_t length = at == 0 ? 0 : 1; length <= most; ++length) {
        const auto end = sequence.begin() + static_cast<long>(at);
        auto& row = counts[History(end - static_cast<long>(length), end)];
        row.seen.resize(static_cast<std::size_t>(modes));
        row.worth.resize(static_cast<std::size_t>(modes));
        ++row.seen[sequence[at]];
        row.worth[sequence[at]] += worth_of(weights, k, at);
      }
    }
  }
  return counts;
}

std::vector<double> frequencies(const ModeSequences& sequences, const ModeWeights& weights, int modes) {
  std::vector<double> share(static_cast<std::size_t>(modes), 0.0);
  double total = 0;
  for (std::size_t k = 0; k < sequences.size(); ++k) {
    for (std::size_t at = 0; at < sequences[k].size(); ++at) {
      const double worth = worth_of(weights, k, at);
      share[sequences[k][at]] += worth;
      total += worth;
    }
  }
  for (double& p : share) p /= total;
  return share;
}

// Counts as probabilities over those of the shorter history.
std::vector<double> mixed(const std::vector<double>& counts, const std::vector<double>& shorter, bool back_off) {
  double total = 0, kinds = 0;
  for (double count : counts) {
    total += count;
    kinds += count > 0 ? 1 : 0;
  }
  if (total == 0) return shorter;
  if (!back_off) kinds = 0;
  std::vector<double> out;
  for (std::size_t mode = 0; mode < counts.size(); ++mode) {
    out.push_back((counts[mode] + kinds * shorter[mode]) / (total + kinds));
  }
  return out;
}

const std::vector<double>& shorter_of(const std::map<History, std::vector<double>>& known, History history,
                                      const std::vector<double>& overall) {
  while (!history.empty()) {
    history.erase(history.begin());
    const auto found = known.find(history);
    if (found != known.end()) return found->second;
  }
  return overall;
}

std::size_t total_of(const std::vector<std::size_t>& counts) {
  std::size_t total = 0;
  for (std::size_t count : counts) total += count;
  return total;
}

// The longest history that the chain knows and that these modes end in.
const ChainContext* context_of(const std::map<History, const ChainContext*>& known, std::span<const std::uint16_t> past,
                               std::size_t longest) {
  for (std::size_t length = std::min(past.size(), longest); length > 0; --length) {
    const auto end = past.last(length);
    const auto found = known.find(History(end.begin(), end.end()));
    if (found != known.end()) return found->second;
  }
  return nullptr;
}

double held_out_likelihood(const ModeSequences& sequences, int modes, const ModeChainOptions& options) {
  double sum = 0, count = 0;
  for (int part = 0; part < kParts; ++part) {
    ModeSequences learned, judged;
    for (std::size_t k = 0; k < sequences.size(); ++k) {
      (static_cast<int>(k % kParts) == part ? judged : learned).push_back(sequences[k]);
    }
    if (learned.empty() || judged.empty()) continue;
    const double mean = log_likelihood(estimate_chain(learned, modes, options), judged);
    if (std::isnan(mean)) continue;
    sum += mean;
    ++count;
  }
  return count > 0 ? sum / count : -std::numeric_limits<double>::infinity();
}

}  // namespace

ModeChain estimate_chain(const ModeSequences& sequences, int modes, const ModeChainOptions& options,
                         const ModeWeights& weights) {
  const Counts counts = count_followers(sequences, weights, modes, options.history);
  const std::vector<double> overall = frequencies(sequences, weights, modes);
  ModeChain chain;
  const auto size = static_cast<std::size_t>(modes);
  const auto begins = counts.find({});
  chain.initial = begins == counts.end() ? overall : mixed(begins->second.worth, overall, options.back_off);
  chain.counts.assign(size * size, 0);
  std::map<History, std::vector<double>> known;
  const auto add = [&](const History& history, std::vector<double> probability) {
    chain.contexts.push_back({history, probability});
    known[history] = std::move(probability);
  };
  for (std::size_t k = 0; k < size; ++k) {
    const auto mode = static_cast<std::uint16_t>(k);
    const auto found = counts.find({mode});
    const Followed row =
        found == counts.end() ? Followed{std::vector<std::size_t>(size), std::vector<double>(size)} : found->second;
    std::copy(row.seen.begin(), row.seen.end(), chain.counts.begin() + static_cast<long>(k * size));
    add({mode}, mixed(row.worth, overall, options.back_off));
  }
  for (std::size_t length = 2; length <= static_cast<std::size_t>(options.history); ++length) {
    for (const auto& [history, row] : counts) {
      if (history.size() != length || total_of(row.seen) < options.min_count) continue;
      add(history, mixed(row.worth, shorter_of(known, history, overall), options.back_off));
    }
  }
  return chain;
}

double log_likelihood(const ModeChain& chain, const ModeSequences& sequences) {
  std::map<History, const ChainContext*> known;
  std::size_t longest = 0;
  for (const ChainContext& context : chain.contexts) {
    known[context.history] = &context;
    longest = std::max(longest, context.history.size());
  }
  double sum = 0, count = 0;
  for (const auto& sequence : sequences) {
    for (std::size_t at = 1; at < sequence.size(); ++at) {
      const ChainContext* context = context_of(known, std::span(sequence).first(at), longest);
      sum += std::log(std::max(kMinProbability, context->probability[sequence[at]]));
      ++count;
    }
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

ModeChainOptions best_history(const ModeSequences& sequences, int modes, int most) {
  ModeChainOptions best{.history = 1, .back_off = true};
  double highest = held_out_likelihood(sequences, modes, best);
  for (int history = 2; history <= most; ++history) {
    const ModeChainOptions tried{.history = history, .back_off = true};
    const double likelihood = held_out_likelihood(sequences, modes, tried);
    if (!(likelihood > highest + kGain)) continue;
    highest = likelihood;
    best = tried;
  }
  return best;
}

}  // namespace wisp::chain
