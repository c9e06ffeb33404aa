#include "learn/fidelity/fidelity_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace wisp {
namespace {

bool complete(const Recording& recording, std::span<const std::size_t> channels, std::size_t row) {
  return std::none_of(channels.begin(), channels.end(),
                      [&](std::size_t c) { return std::isnan(recording.channels[c].samples[row]); });
}

Stretch rows_of(const Stretch& stretch, std::size_t first, std::size_t last) {
  const auto begin = stretch.values.begin();
  return {stretch.channels, {begin + first * stretch.channels, begin + last * stretch.channels}};
}

}  // namespace

std::vector<double> Stretch::channel(std::size_t index) const {
  std::vector<double> samples(rows());
  for (std::size_t t = 0; t < samples.size(); ++t) samples[t] = (*this)(t, index);
  return samples;
}

Result<std::vector<Stretch>> stretches_of(const Recording& recording, std::span<const std::string> channels) {
  std::vector<std::size_t> indices;
  for (const std::string& name : channels) {
    const auto index = find_channel(recording, name);
    if (!index) return Error{recording.source + ": there is no channel " + name};
    indices.push_back(*index);
  }
  std::vector<Stretch> stretches;
  for (const Episode& episode : episodes(recording)) {
    bool open = false;
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      if (!complete(recording, indices, row)) {
        open = false;
        continue;
      }
      if (!open) stretches.push_back({indices.size(), {}});
      open = true;
      for (std::size_t c : indices) stretches.back().values.push_back(recording.channels[c].samples[row]);
    }
  }
  return stretches;
}

std::size_t total_rows(std::span<const Stretch> stretches) {
  return std::accumulate(stretches.begin(), stretches.end(), std::size_t{0},
                         [](std::size_t sum, const Stretch& stretch) { return sum + stretch.rows(); });
}

std::vector<Stretch> cut_to(std::span<const Stretch> stretches, std::size_t max_rows) {
  std::vector<Stretch> pieces;
  for (const Stretch& stretch : stretches) {
    for (std::size_t first = 0; first < stretch.rows(); first += max_rows) {
      pieces.push_back(rows_of(stretch, first, std::min(stretch.rows(), first + max_rows)));
    }
  }
  return pieces;
}

Halves halves_of(std::span<const Stretch> stretches) {
  Halves halves;
  std::size_t left = total_rows(stretches) / 2;
  for (const Stretch& stretch : stretches) {
    const std::size_t before = std::min(left, stretch.rows());
    if (before > 0) halves.first.push_back(rows_of(stretch, 0, before));
    if (before < stretch.rows()) halves.second.push_back(rows_of(stretch, before, stretch.rows()));
    left -= before;
  }
  return halves;
}

std::vector<Stretch> shuffled(std::span<const Stretch> stretches, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Stretch> out;
  for (const Stretch& stretch : stretches) {
    std::vector<std::size_t> order(stretch.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    shuffle(std::span(order), random);
    Stretch& mixed = out.emplace_back(Stretch{stretch.channels, {}});
    mixed.values.reserve(stretch.values.size());
    for (std::size_t t : order) {
      const auto row = stretch.row(t);
      mixed.values.insert(mixed.values.end(), row.begin(), row.end());
    }
  }
  return out;
}

}  // namespace wisp
