#pragma once
// Plays residuals as they were (ResampledResiduals), lane by lane. An instance's state is the row that it is at, how
// long ago it jumped there, the blocks that it played before, and its input's recent past. Jumps are decided by
// comparisons and taken by counted random words. Where nothing drives it, it jumps after a drawn time to where the
// outputs were alike (lookup_lanes.hpp).
//
// Where an input drives it, where a jump leads is a search for the rows whose input's past is nearest (D. Kovar, M.
// Gleicher, F. Pighin, "Motion Graphs", SIGGRAPH 2002, and S. Clavet, "Motion Matching", GDC 2016, are its kin in
// animation): one way down a k-d tree to a leaf, whose rows are compared. It is done only in steps in which going on
// costs more than the tolerance.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "run/arx/lookup_lanes.hpp"
#include "run/arx/resampled_program.hpp"
#include "run/lanes/columns.hpp"
#include "run/state/moment.hpp"
#include "run/state/sample_ring.hpp"

namespace wisp {

template <class N>
class ResampledLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  ResampledLanes(const ResampledProgram& program, int blocks, Arena& arena)
      : program_(program), lookup_(program.lookup, blocks, arena) {
    if (program.empty()) return;
    state_ = arena.take<Real>(static_cast<std::size_t>(blocks) * kStateValues * kLanes);
    past_ = SampleRing<N>(blocks, program.depth, 1, arena);
  }

  bool empty() const { return program_.empty(); }

  /// Sets the scale of the noise. Returns whether there is any.
  bool set_noise(float scale) {
    scale_ = scale;
    return !empty() && scale != 0;
  }

  /// A newborn jumps in its first step; nothing blew before.
  void start(int block, int lane) {
    for (int value = 0; value < kStateValues; ++value) state(block, value)[lane] = Real(0.0f);
    if (program_.driven()) state(block, kAge)[lane] = Real(static_cast<float>(program_.longest));
    if (!lookup_.empty()) lookup_.start(block, lane);
    for (int lag = 0; lag < past_.depth(); ++lag) past(block, static_cast<std::uint32_t>(lag))[lane] = Real(0.0f);
  }

  /// Moves every block's past by so many samples.
  void turn(int samples = 1) { past_.turn(samples); }

  /// Takes in the input of a block's step, whether there is noise or not: [regressor][lane].
  void hear(int block, const Real* regressors) {
    if (!program_.driven()) return;
    auto wind = load<Reals<N>>(regressors + program_.toward * kLanes);
    if (program_.against >= 0) wind = wind - load<Reals<N>>(regressors + program_.against * kLanes);
    store(wind, past(block, 0));
  }

  /// Moves every lane of a block that is in use on.
  void step(int block, const Moment<N>& moment) {
    if (!lookup_.empty()) return step_by_state(block, moment);
    Places places;
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t at = whole(state(block, kPlace)[lane]);
      const bool used = lane < moment.lanes(), last = program_.left[at / 2] == 0;
      places.next[lane] = used ? at + 2 : at;
      places.forced[lane] = used && (last || whole(state(block, kAge)[lane]) >= program_.longest);
    }
    search(block, moment, places);
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      const std::uint32_t at = whole(state(block, kPlace)[lane]), next = places.next[lane];
      if (next == at + 2 && !places.forced[lane]) {
        state(block, kAge)[lane] = Real(static_cast<float>(whole(state(block, kAge)[lane]) + 1));
      } else {
        remember(block, lane);
        state(block, kAge)[lane] = Real(1.0f);
      }
      state(block, kPlace)[lane] = Real(static_cast<float>(next));
    }
  }

  /// Puts what is added to the outputs of a block, [output][lane], into `shocks`.
  void play(int block, Real* shocks) const {
    const float* row[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) row[lane] = played(block, lane);
    const auto scale = all<Reals<N>>(scale_);
    for (int i = 0; i < program_.outputs; i += 4) {
      Reals<N> columns[4];
      columns_of<N>(row, static_cast<std::size_t>(i), columns);
      for (int k = 0; k < 4 && i + k < program_.outputs; ++k, shocks += kLanes) {
        store(scale_ == 1 ? columns[k] : scale * columns[k], shocks);
      }
    }
  }

  /// What a lane plays, one number an output, and what it is multiplied with.
  const float* played(int block, int lane) const { return program_.played(whole(state(block, kPlace)[lane])); }
  float scale() const { return scale_; }

  std::size_t lane_values() const {
    const auto depth = static_cast<std::size_t>(past_.depth());
    return empty() ? 0 : static_cast<std::size_t>(kStateValues) + depth + lookup_.lane_values();
  }

  /// `low` and `high` bound the input.
  template <class Visit>
  void visit_lane(int block, int lane, float low, float high, Visit visit) {
    if (empty()) return;
    const std::size_t places = 2 * program_.left.size();
    const bool mirrors = program_.mirrors();
    const auto last = static_cast<float>(places - (mirrors ? 1 : 2));
    for (int value = 0; value < kStateValues; value += 2) {
      visit(state(block, value + kPlace)[lane], 0.0f, last, mirrors ? 1.0f : 2.0f);
      visit(state(block, value + kAge)[lane], 0.0f, static_cast<float>(program_.longest), 1.0f);
    }
    for (int lag = 0; lag < past_.depth(); ++lag) {
      visit(past(block, static_cast<std::uint32_t>(lag))[lane], low, high);
    }
    lookup_.visit_lane(block, lane, visit);
  }

 private:
  // Twice the row, and one more where its mirror image is played; steps since the jump; and the same of the last row of
  // every block before, the newest first.
  static constexpr float kNever = std::numeric_limits<float>::infinity();
  static constexpr int kPlace = 0;
  static constexpr int kAge = 1;
  static constexpr int kStateValues = 2 * (1 + kRecentBlocks);

  Real* state(int block, int value) { return state_.data() + (block * kStateValues + value) * kLanes; }
  const Real* state(int block, int value) const { return state_.data() + (block * kStateValues + value) * kLanes; }
  Real* past(int block, std::uint32_t lag) { return past_.sample(block, lag); }
  const Real* past(int block, std::uint32_t lag) const { return past_.sample(block, lag); }
  static std::uint32_t whole(const Real& value) { return static_cast<std::uint32_t>(value_of(value)); }

  void remember(int block, int lane) {
    for (int value = kStateValues - 1; value >= 2; --value) state(block, value)[lane] = state(block, value - 2)[lane];
  }

  void step_by_state(int block, const Moment<N>& moment) {
    bool jumps[kLanes], any = false;
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      PlayedRows played[1 + kRecentBlocks];
      for (int k = 0; k <= kRecentBlocks; ++k) {
        played[k] = {whole(state(block, 2 * k + kPlace)[lane]) / 2, whole(state(block, 2 * k + kAge)[lane])};
      }
      const std::uint32_t left = program_.left[played[0].last];
      lookup_.look(block, lane, played, left);
      jumps[lane] = left == 0 || lookup_.is_over(block, lane, played[0].count);
      any = any || jumps[lane];
    }
    std::uint32_t words[4][kLanes];
    if (any) draw(moment, words);
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      Real &place = state(block, kPlace)[lane], &age = state(block, kAge)[lane];
      std::uint32_t row = whole(place) / 2 + 1, count = whole(age) + 1;
      if (jumps[lane]) {
        row = lookup_.jump(block, lane, {row - 1, count - 1}, words[0][lane], words[1][lane], program_.left);
        remember(block, lane);
        count = 1;
      }
      place = Real(static_cast<float>(2 * row));
      age = Real(static_cast<float>(count));
    }
  }

  // Where the lanes of a block go, and which of them must jump.
  struct Places {
    std::uint32_t next[kLanes];
    bool forced[kLanes];
  };

  // The input's past at each lag, and whether it blew from the other side: there rows are looked for as mirror images,
  // and the past is turned about.
  struct Heard {
    Real wind[kMaxResampledLags][kLanes];
    bool right[kLanes];
  };

  // Lanes that may jump: of all that follows each does one thing at a time for all of them, since one alone would wait
  // for every number that it reads.
  struct Seekers {
    int lane[kLanes];
    std::uint32_t leaf[kLanes] = {};
    int count = 0;
  };

  // Lets those jump that must, or that go on in an input too far from what it was there.
  void search(int block, const Moment<N>& moment, Places& places) const {
    Seekers seekers;
    Real ahead[kLanes];
    go_on(block, places, ahead);
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      const bool seeks = places.forced[lane] || value_of(ahead[lane]) > program_.tolerance;
      seekers.lane[seekers.count] = lane;
      seekers.count += seeks ? 1 : 0;
    }
    if (seekers.count == 0) return;
    std::uint32_t words[4][kLanes];
    draw(moment, words);
    Heard heard;
    hear_past(block, heard);
    descend(heard, words[0], seekers);
    Nearest nearest;
    find_nearest(block, heard, seekers, nearest);
    for (int k = 0; k < seekers.count; ++k) {
      const int lane = seekers.lane[k];
      const Real* on = places.forced[lane] ? nullptr : &ahead[lane];
      places.next[lane] = jump(block, k, seekers, heard, nearest, words[1][lane], on);
    }
  }

  // How far the input's past is from what it was at the next places: the sum over lags of the differences' sizes, as
  // good a choice as their squares make for half the operations.
  void go_on(int block, const Places& places, Real (&ahead)[kLanes]) const {
    const float* wind[kLanes];
    Real mirrored[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t next = places.next[lane];
      // What must jump does not go on, and there may be nothing to go on to.
      wind[lane] = program_.wind.data() + program_.now[next / 2 - (places.forced[lane] ? 1 : 0)];
      mirrored[lane] = Real(next % 2 != 0 ? 1.0f : 0.0f);
    }
    const auto turned = load<Reals<N>>(mirrored);
    const auto zero = all<Reals<N>>(0.0f);
    auto sum = zero;
    for (const std::uint32_t lag : program_.lags) {
      Real then[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) then[lane] = Real(*(wind[lane] - lag));
      const auto apart = [](const auto& x, const auto& y, const auto& side, const auto& none) {
        return side > none ? x + y : x - y;
      };
      sum = sum + magnitude(each(apart, load<Reals<N>>(then), load<Reals<N>>(past(block, lag)), turned, zero));
    }
    store(sum, ahead);
  }

  void draw(const Moment<N>& moment, std::uint32_t (&words)[4][kLanes]) const {
    Words<N> counters[4], words_drawn[4];
    random_counters<N>(moment.counters, counters);
    random_group<N>(*moment.keys, counters, 0, words_drawn);
    for (int k = 0; k < 4; ++k) {
      typename N::Word lanes[kLanes];
      store(words_drawn[k], lanes);
      for (int lane = 0; lane < kLanes; ++lane) words[k][lane] = value_of(lanes[lane]);
    }
  }

  void hear_past(int block, Heard& heard) const {
    const auto zero = all<Reals<N>>(0.0f);
    auto sum = zero;
    if (program_.mirrors()) {
      for (const std::uint32_t lag : program_.lags) sum = sum + load<Reals<N>>(past(block, lag));
    }
    for (std::size_t k = 0; k < program_.lags.size(); ++k) {
      const auto about = [](const auto& x, const auto& side, const auto& none) { return side < none ? none - x : x; };
      store(each(about, load<Reals<N>>(past(block, program_.lags[k])), sum, zero), heard.wind[k]);
    }
    Real sides[kLanes];
    store(sum, sides);
    for (int lane = 0; lane < kLanes; ++lane) heard.right[lane] = value_of(sides[lane]) < 0;
  }

  // Down the tree to a leaf. Where the past lies within the margin of a node's value chance takes the side: rows of
  // calm, which are all alike, are so all within reach.
  void descend(const Heard& heard, const std::uint32_t (&words)[kLanes], Seekers& seekers) const {
    std::uint32_t node[kLanes] = {}, word[kLanes] = {};
    for (int k = 0; k < seekers.count; ++k) word[k] = words[seekers.lane[k]];
    for (std::size_t level = 1; level <= program_.nodes.size(); level *= 2) {
      for (int k = 0; k < seekers.count; ++k) {
        const PastNode& one = program_.nodes[node[k]];
        const float away = value_of(heard.wind[one.lag][seekers.lane[k]] - Real(one.value));
        const std::uint32_t near = (away <= program_.margin ? 1U : 0U) & (away >= -program_.margin ? 1U : 0U);
        const std::uint32_t side = (near & word[k] >> 31) | (~near & (away > 0 ? 1U : 0U));
        word[k] = word[k] << 1 | word[k] >> 31;
        node[k] = 2 * node[k] + 1 + side;
      }
    }
    for (int k = 0; k < seekers.count; ++k) {
      seekers.leaf[k] = node[k] - static_cast<std::uint32_t>(program_.nodes.size());
    }
  }

  // Rows that the lanes have played just now, or will play if they go on: above `low`, up to `high`. That half of a
  // mirrored place is half a row above its row lets no other row in.
  struct Recent {
    float low[1 + kRecentBlocks][kLanes];
    float high[1 + kRecentBlocks][kLanes];
  };
  void find_recent(int block, Recent& recent) const {
    for (int k = 0; k <= kRecentBlocks; ++k) {
      const Real *place = state(block, 2 * k + kPlace), *steps = state(block, 2 * k + kAge);
      for (int lane = 0; lane < kLanes; ++lane) {
        const float row = 0.5f * value_of(place[lane]);
        recent.low[k][lane] = row - value_of(steps[lane]);
        recent.high[k][lane] = value_of(steps[lane]) > 0 ? row + 1 : -1.0f;
      }
    }
  }

  // How far a lane's past is from those of a leaf's rows: infinitely far from what is none, or was played just now.
  void compare(int lane, std::uint32_t leaf, const Heard& heard, const Recent& recent,
               float (&apart)[kCandidates]) const {
    const Candidates& rows = program_.leaves[leaf];
    const std::size_t lags = program_.lags.size();
    const float* winds = program_.leaf_wind.data() + leaf * lags * kCandidates;
    const auto never = all<Reals<N>>(kNever);
    const auto pick = [](const auto& x, const auto& low, const auto& high, const auto& yes, const auto& no) {
      return x > low ? (x > high ? no : yes) : no;
    };
    for (std::uint32_t first = 0; first < kCandidates; first += kLanes) {
      auto sum = all<Reals<N>>(0.0f);
      for (std::size_t k = 0; k < lags && first < rows.count; ++k) {
        const auto now = all<Reals<N>>(value_of(heard.wind[k][lane]));
        sum = sum + magnitude(load<Reals<N>>(winds + k * kCandidates + first) - now);
      }
      if (!(first < rows.count)) sum = never;
      const auto row = load<Reals<N>>(rows.row.data() + first);
      unrolled<1 + kRecentBlocks>([&](auto k) {
        const auto low = all<Reals<N>>(recent.low[k][lane]), high = all<Reals<N>>(recent.high[k][lane]);
        sum = each(pick, row, low, high, never, sum);
      });
      store(sum, apart + first);
    }
  }

  // The nearest of a leaf's rows, the best first, of every seeker: how far, and which candidate. Of two that are as
  // near the first comes first.
  struct Nearest {
    float apart[kNearestRows][kLanes];
    float candidate[kNearestRows][kLanes];

    std::uint32_t count(int seeker) const {
      std::uint32_t there = 0;
      for (const auto& rank : apart) there += rank[seeker] < kNever ? 1 : 0;
      return there;
    }
  };

  void find_nearest(int block, const Heard& heard, const Seekers& seekers, Nearest& nearest) const {
    Recent recent;
    find_recent(block, recent);
    float apart[kLanes][kCandidates];
    const float* row[kLanes];
    for (int k = 0; k < kLanes; ++k) row[k] = apart[k < seekers.count ? k : 0];
    for (int k = 0; k < seekers.count; ++k) compare(seekers.lane[k], seekers.leaf[k], heard, recent, apart[k]);
    for (int first = 0; first < seekers.count; first += N::kPartLanes) rank_part(row + first, nearest, first);
  }

  // What is written for seekers that are not there is not read.
  static void rank_part(const float* const* row, Nearest& nearest, int first) {
    using Values = Pack<typename N::RealPart, 1>;
    Values best[kNearestRows], which[kNearestRows];
    for (Values& one : best) one = all<Values>(kNever);
    for (Values& one : which) one = all<Values>(0.0f);
    const auto first_if = [](const auto& x, const auto& y, const auto& yes, const auto& no) {
      return x < y ? yes : no;
    };
    for (std::uint32_t at = 0; at < kCandidates; at += 4) {
      typename N::RealPart columns[4];
      columns_part(row, at, columns);
      unrolled<4>([&](auto k) {
        const Values apart{{columns[k]}}, number = all<Values>(static_cast<float>(at + k));
        // From the last rank on: what a nearer one drives out of a rank goes to the next.
        unrolled<kNearestRows>([&](auto back) {
          const int rank = kNearestRows - 1 - back;
          const auto pushed = rank > 0 ? each(first_if, apart, best[rank - 1], best[rank - 1], apart) : apart;
          const auto of = rank > 0 ? each(first_if, apart, best[rank - 1], which[rank - 1], number) : number;
          which[rank] = each(first_if, apart, best[rank], of, which[rank]);
          best[rank] = each(first_if, apart, best[rank], pushed, best[rank]);
        });
      });
    }
    for (int rank = 0; rank < kNearestRows; ++rank) {
      store(best[rank], nearest.apart[rank] + first);
      store(which[rank], nearest.candidate[rank] + first);
    }
  }

  // Where to go from a leaf: on, where `ahead` says what that costs and it is not worse than the best by more than the
  // tolerance, else to one of the nearest.
  std::uint32_t jump(int block, int seeker, const Seekers& seekers, const Heard& heard, const Nearest& nearest,
                     std::uint32_t word, const Real* ahead) const {
    const int lane = seekers.lane[seeker];
    const Candidates& rows = program_.leaves[seekers.leaf[seeker]];
    const std::uint32_t on = whole(state(block, kPlace)[lane]) + 2, about = heard.right[lane] ? 1 : 0;
    const std::uint32_t count = nearest.count(seeker);
    if (count == 0) return ahead ? on : rows.place[rows.count - 1] ^ about;
    if (ahead && value_of(*ahead - Real(nearest.apart[0][seeker])) <= program_.tolerance) return on;
    return rows.place[static_cast<std::uint32_t>(nearest.candidate[scaled(word, count)][seeker])] ^ about;
  }

  // A word as a whole number below `count`.
  static std::uint32_t scaled(std::uint32_t word, std::uint32_t count) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(word) * count) >> 32);
  }

  ResampledProgram program_;
  LookupLanes<N> lookup_;
  std::span<Real> state_;
  SampleRing<N> past_;  // of the input
  float scale_ = 0;     // of the noise
};

}  // namespace wisp
