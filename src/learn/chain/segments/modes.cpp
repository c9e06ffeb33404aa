#include "learn/chain/segments/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/numeric/clustering.hpp"

namespace wisp::chain {
namespace {

constexpr double kNoLength = 1e-9;  // metres: a shorter line has no direction

Triple line_of(const MotionPiece& piece, const Segment& segment) {
  const Triple from = at_row(piece.position, segment.begin), to = at_row(piece.position, segment.end);
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

// Direction over ground from a segment's start to its end, as an angle from x; 0 where the two coincide.
double heading_of(const Motion& motion, const Segment& segment) {
  const Triple line = line_of(motion.pieces[segment.piece], segment);
  return std::hypot(line[0], line[1]) > kNoLength ? std::atan2(line[1], line[0]) : 0.0;
}

void add_features(const MotionPiece& piece, const Segment& segment, double heading, std::vector<double>& out) {
  const auto add = [&](const Triple& vector) {
    for (double x : turned_about_z(vector, -heading)) out.push_back(x);
  };
  for (double end : {segment.begin, segment.end}) add(at_row(piece.velocity, end));
  const Triple line = line_of(piece, segment);
  const double length = length_of(line);
  const double share = length > kNoLength ? 1 / length : 0;
  out.push_back(length);
  add({line[0] * share, line[1] * share, line[2] * share});
}

void standardise(FeatureTable& table) {
  for (std::size_t k = 0; k < table.features; ++k) {
    std::vector<double> column;
    for (std::size_t at = k; at < table.values.size(); at += table.features) column.push_back(table.values[at]);
    const double middle = mean(column), spread = deviation(column);
    for (std::size_t at = k; at < table.values.size(); at += table.features) {
      double& value = table.values[at];
      value = spread > 1e-12 * (1 + std::abs(middle)) ? (value - middle) / spread : 0;
    }
  }
}

constexpr double kMinProbability = 1e-6;

std::uint16_t nearest(const KMeans& found, std::span<const double> row) {
  std::uint16_t best = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < found.sizes.size(); ++k) {
    double distance = 0;
    for (std::size_t i = 0; i < row.size(); ++i) distance += std::pow(row[i] - found.centroids[k * row.size() + i], 2);
    if (distance >= least) continue;
    least = distance;
    best = static_cast<std::uint16_t>(k);
  }
  return best;
}

// Row of the probabilities that applies to mode `at` of a sequence, given the modes before it. Precondition: at >= 1.
std::size_t row_after(std::span<const std::uint16_t> sequence, std::size_t at, std::size_t modes, int history) {
  const std::size_t last = sequence[at - 1];
  return history < 2 || at < 2 ? last : modes + sequence[at - 2] * modes + last;
}

// Normalises counts to probabilities; where all counts are 0, copies `instead`.
void normalise(std::span<double> counts, std::span<const double> instead) {
  double total = 0;
  for (double count : counts) total += count;
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = total > 0 ? counts[k] / total : instead[k];
}

}  // namespace

MotionPiece cut_out(const Motion& motion, const Segment& segment, bool heading_free) {
  const MotionPiece& from = motion.pieces[segment.piece];
  const double heading = heading_free ? heading_of(motion, segment) : 0;
  const auto last = static_cast<double>(from.rows() - 1);
  const double begin = std::min(std::round(segment.begin), last - segment.steps);
  const Triple origin = at_row(from.position, begin);
  MotionPiece piece;
  for (int step = 0; step <= segment.steps; ++step) {
    const double row = begin + step;
    const Triple at = at_row(from.position, row);
    piece.position.push_back(turned_about_z(Triple{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]}, -heading));
    piece.velocity.push_back(turned_about_z(at_row(from.velocity, row), -heading));
    if (!motion.has_orientation) continue;
    piece.orientation.push_back(turned_about_z(at_row(from.orientation, row), -heading));
    piece.spin.push_back(turned_about_z(at_row(from.spin, row), -heading));
  }
  return piece;
}

FeatureTable segment_features(const Motion& motion, std::span<const Segment> segments, bool heading_free) {
  FeatureTable table;
  for (const Segment& segment : segments) {
    add_features(motion.pieces[segment.piece], segment, heading_free ? heading_of(motion, segment) : 0, table.values);
  }
  if (segments.empty()) return table;
  table.features = table.values.size() / segments.size();
  standardise(table);
  return table;
}

Result<Modes> sorted_into_modes(const FeatureTable& table, std::size_t learned, int modes, std::uint64_t seed) {
  const std::span values(table.values);
  const auto found = k_means(values.first(learned * table.features), table.features, {.clusters = modes, .seed = seed});
  if (!found) return found.error();
  Modes out{modes, found->cluster, found->sizes,
            silhouette(values.first(learned * table.features), table.features, *found)};
  for (std::size_t row = learned; row < table.rows(); ++row) {
    out.of.push_back(nearest(*found, values.subspan(row * table.features, table.features)));
  }
  return out;
}

ModeChain counted_chain(const ModeSequences& sequences, int modes, int history) {
  const auto count = static_cast<std::size_t>(modes);
  ModeChain chain{history, std::vector<double>(count),
                  std::vector<double>((history > 1 ? count + count * count : count) * count)};
  std::vector<double> overall(count);
  for (const auto& sequence : sequences) {
    for (std::size_t at = 0; at < sequence.size(); ++at) {
      ++overall[sequence[at]];
      if (at == 0) {
        ++chain.initial[sequence[at]];
        continue;
      }
      // Pairs also count for their last mode alone, for use after a single mode and after pairs never followed.
      ++chain.probabilities[sequence[at - 1] * count + sequence[at]];
      if (history > 1 && at > 1) ++chain.probabilities[row_after(sequence, at, count, history) * count + sequence[at]];
    }
  }
  normalise(overall, overall);
  normalise(chain.initial, overall);
  const std::span all(chain.probabilities);
  for (std::size_t row = 0; row * count < all.size(); ++row) {
    const std::size_t last = row % count;
    normalise(all.subspan(row * count, count),
              row < count ? std::span<const double>(overall) : all.subspan(last * count, count));
  }
  return chain;
}

double log_likelihood(const ModeChain& chain, const ModeSequences& sequences) {
  const std::size_t count = chain.initial.size();
  double sum = 0, transitions = 0;
  for (const auto& sequence : sequences) {
    for (std::size_t at = 1; at < sequence.size(); ++at) {
      const std::size_t row = row_after(sequence, at, count, chain.history);
      sum += std::log(std::max(chain.probabilities[row * count + sequence[at]], kMinProbability));
      ++transitions;
    }
  }
  return sum / transitions;
}

}  // namespace wisp::chain
