// A segment's lead is the sum of the mean ways of all that may follow it: V(s) = E[D(c) − v T(c) + V(c)] over its
// successors c, D being way and T duration, solved by iterating (R. Bellman, Dynamic Programming, 1957). What a step of
// the walk then adds that could not be foreseen has no memory, and its variance is what the walk spreads by.
//
// Transitions of order one and successors alike stand for the chain: steering needs no more.
#include "learn/chain/chain_drift.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>

namespace wisp::chain {
namespace {

constexpr int kRounds = 40;          // segments: more than direction is kept for
constexpr int kSettlingRounds = 60;  // until segments are visited as often as in a long walk
constexpr std::size_t kAnyOf = 8;    // of a mode whose segments all follow alike
constexpr double kMaxStored = 32767;
constexpr double kMinSpread = 1e-9;

using Complex = std::complex<double>;

struct Way {
  Complex ground;
  double height = 0;
};

// One thing that may follow a segment.
struct Next {
  std::size_t segment;
  double probability;
  Complex turn;  // that it is placed with
};

class Walk {
 public:
  Walk(const ChainModel& chain, double rate_hz) : chain_(chain), first_(segment_rows(chain.segments)) {
    const auto transitions = chain.transitions();
    for (std::size_t s = 0; s < size(); ++s) {
      seconds_.push_back(chain.segments.steps[s] / rate_hz);
      ways_.push_back(way(s));
      next_.push_back(successors(s, transitions));
    }
  }

  std::size_t size() const { return chain_.segments.size(); }
  double seconds(std::size_t s) const { return seconds_[s]; }
  const Way& stored_way(std::size_t s) const { return ways_[s]; }
  std::span<const Next> next(std::size_t s) const { return next_[s]; }

  // How often each segment is visited.
  std::vector<double> visits() const {
    std::vector<double> share(size(), 1.0 / static_cast<double>(size()));
    for (int round = 0; round < kSettlingRounds; ++round) {
      std::vector<double> after(size());
      for (std::size_t s = 0; s < size(); ++s) {
        for (const Next& next : next_[s]) after[next.segment] += share[s] * next.probability;
      }
      share = std::move(after);
    }
    return share;
  }

 private:
  const std::int16_t* row(std::size_t s, bool end) const {
    const std::size_t at = end ? first_[s + 1] - 1 : first_[s];
    return chain_.segments.rows.data() + at * static_cast<std::size_t>(channel_count(chain_.motion));
  }

  Way way(std::size_t s) const {
    const std::int16_t* end = row(s, true);
    const double scale = chain_.segments.row_scale[0];
    return {{scale * end[0], scale * end[1]}, scale * end[2]};
  }

  Complex turn(std::size_t from, std::size_t to) const {
    if (!chain_.heading_free) return 1;
    if (chain_.motion == ChainMotion::kPosition) {
      const std::int16_t *a = &chain_.segments.rates[from * 6 + 3], *b = &chain_.segments.rates[to * 6];
      const Complex along = Complex(a[0], a[1]) * std::conj(Complex(b[0], b[1]));
      return std::abs(along) > 0 ? along / std::abs(along) : 1;
    }
    const std::int16_t *p = row(from, true) + 3, *q = row(to, false) + 3;
    const Complex half(1.0 * p[0] * q[0] + 1.0 * p[1] * q[1] + 1.0 * p[2] * q[2] + 1.0 * p[3] * q[3],
                       1.0 * p[3] * q[0] - 1.0 * p[0] * q[3] + 1.0 * p[2] * q[1] - 1.0 * p[1] * q[2]);
    return std::abs(half) > 0 ? half * half / std::norm(half) : 1;
  }

  std::vector<Next> successors(std::size_t s, const std::vector<double>& transitions) const {
    const ChainSegments& segments = chain_.segments;
    const auto modes = static_cast<std::size_t>(chain_.modes), breadth = static_cast<std::size_t>(segments.breadth);
    const auto chance = std::span(transitions).subspan(segments.mode[s] * modes, modes);
    std::vector<Next> out;
    for (std::size_t mode = 0; mode < modes; ++mode) {
      const double probability = chance[mode];
      if (probability == 0) continue;
      std::vector<std::size_t> those;
      if (breadth > 0) {
        const auto best = segments.follow.begin() + static_cast<long>((s * modes + mode) * breadth);
        those.assign(best, best + static_cast<long>(breadth));
      } else {
        const auto [low, high] = std::equal_range(segments.mode.begin(), segments.mode.end(), mode);
        const auto members = static_cast<std::size_t>(high - low);
        for (std::size_t k = 0; k < std::min(members, kAnyOf); ++k) {
          those.push_back(static_cast<std::size_t>(low - segments.mode.begin()) + (s + k * members / kAnyOf) % members);
        }
      }
      for (std::size_t to : those) {
        out.push_back({to, probability / static_cast<double>(those.size()), turn(s, to)});
      }
    }
    return out;
  }

  const ChainModel& chain_;
  std::vector<std::uint32_t> first_;
  std::vector<double> seconds_;
  std::vector<Way> ways_;
  std::vector<std::vector<Next>> next_;
};

// What follows a segment on average, beyond the mean velocity.
std::vector<Way> leads_of(const Walk& walk, const Way& drift, const std::vector<double>& visits, double& memory) {
  std::vector<Way> lead(walk.size());
  std::vector<double> size;  // root-mean-square, after each round
  double mean_seconds = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) mean_seconds += visits[s] * walk.seconds(s);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Way> after(walk.size());
    double square = 0;
    for (std::size_t s = 0; s < walk.size(); ++s) {
      for (const Next& next : walk.next(s)) {
        const Way &way = walk.stored_way(next.segment), &beyond = lead[next.segment];
        const double seconds = walk.seconds(next.segment);
        after[s].ground += next.probability * (next.turn * (way.ground + beyond.ground) - drift.ground * seconds);
        after[s].height += next.probability * (way.height + beyond.height - drift.height * seconds);
      }
      square += visits[s] * std::norm(after[s].ground);
    }
    // Heights are known but for a constant.
    double mean = 0;
    for (std::size_t s = 0; s < walk.size(); ++s) mean += visits[s] * after[s].height;
    for (Way& one : after) one.height -= mean;
    lead = std::move(after);
    size.push_back(std::sqrt(square));
  }
  const auto grown = std::find_if(size.begin(), size.end(), [&](double x) { return x >= 0.5 * size.back(); });
  memory = mean_seconds * static_cast<double>(1 + grown - size.begin());
  return lead;
}

}  // namespace

ChainDrift drift_of(const ChainModel& chain, double rate_hz) {
  const Walk walk(chain, rate_hz);
  const auto visits = walk.visits();
  Way way;
  double seconds = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) {
    if (!chain.heading_free) way.ground += visits[s] * walk.stored_way(s).ground;
    way.height += visits[s] * walk.stored_way(s).height;
    seconds += visits[s] * walk.seconds(s);
  }
  const Way drift{way.ground / seconds, way.height / seconds};
  ChainDrift out;
  out.drift = {drift.ground.real(), drift.ground.imag(), drift.height};
  const auto lead = leads_of(walk, drift, visits, out.memory_seconds);
  double most = 0, ground = 0, height = 0;
  for (std::size_t s = 0; s < walk.size(); ++s) {
    for (double x : {lead[s].ground.real(), lead[s].ground.imag(), lead[s].height}) most = std::max(most, std::abs(x));
    for (const Next& next : walk.next(s)) {
      const Way &step = walk.stored_way(next.segment), &beyond = lead[next.segment];
      const double own = walk.seconds(next.segment), weight = visits[s] * next.probability;
      ground += weight * std::norm(next.turn * (step.ground + beyond.ground) - drift.ground * own - lead[s].ground);
      const double up = step.height + beyond.height - drift.height * own - lead[s].height;
      height += weight * up * up;
    }
  }
  out.spread_ground = std::max(ground / 2 / seconds, kMinSpread);
  out.spread_height = std::max(height / seconds, kMinSpread);
  out.lead_scale = most > 0 ? most / kMaxStored : 1 / kMaxStored;
  for (const Way& one : lead) {
    for (double x : {one.ground.real(), one.ground.imag(), one.height}) {
      out.lead.push_back(static_cast<std::int16_t>(std::lround(x / out.lead_scale)));
    }
  }
  return out;
}

}  // namespace wisp::chain
