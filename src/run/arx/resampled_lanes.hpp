#pragma once
// Replays recorded residuals (ResampledResiduals), lane by lane. An instance's state is its current row, the number of
// rows played since its last jump, the runs of rows played before, and the recent past of its input. Comparisons decide
// whether an instance jumps; counter-based random words choose its target. Without a driving input, an instance jumps
// after a random time to a row with similar outputs (lookup_lanes.hpp).
//
// With a driving input, an instance jumps to one of the rows whose input past is most similar to its own (related
// methods in animation: D. Kovar, M. Gleicher, F. Pighin, "Motion Graphs", SIGGRAPH 2002, and S. Clavet, "Motion
// Matching", GDC 2016). The search descends a k-d tree once and compares the rows of one leaf. It runs only in steps in
// which the next row's distance exceeds the tolerance, a stretch ends, or a run has reached its longest duration.
//
// For a 3-D body the input is a horizontal vector, and there are two searches over the same past, each with its own
// state. The row of the first search gives the residuals along the wind; the row of the second, mirrored at random, the
// residuals across the wind. Both are rotated to the wind's direction at the jump to the row.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "run/arx/lookup_lanes.hpp"
#include "run/arx/resampled_program.hpp"
#include "run/lanes/columns.hpp"
#include "run/state/channels.hpp"
#include "run/state/moment.hpp"
#include "run/state/sample_ring.hpp"

namespace wisp {

template <class N>
class ResampledLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  ResampledLanes(const ResampledProgram& program, int blocks, Arena& arena)
      : program_(program), lookup_(program.lookup, blocks * (program.across > 0 ? 2 : 1), arena), blocks_(blocks) {
    if (program.empty()) return;
    const auto lives = static_cast<std::size_t>(blocks * this->lives());
    state_ = arena.take<Real>(lives * kStateValues * kLanes);
    past_ = SampleRing<N>(blocks, program.depth, this->lives(), arena);
    if (program.across == 0) return;
    from_ = arena.take<Real>(lives * 2 * kLanes);
    stride_ = (static_cast<std::size_t>(program.outputs) + 3) / 4 * 4;  // rows are read four numbers at a time
    turned_ = arena.take<float>(static_cast<std::size_t>(blocks) * kLanes * stride_);
  }

  bool empty() const { return program_.empty(); }

  /// Sets the scale of the noise. Returns whether it is nonzero.
  bool set_noise(float scale) {
    scale_ = scale;
    return !empty() && scale != 0;
  }

  /// Starts a lane: its input past is calm, and it jumps in its first step.
  void start(int block, int lane) {
    for (int k = 0; k < lives(); ++k) {
      const int life = k * blocks_ + block;
      for (int value = 0; value < kStateValues; ++value) state(life, value)[lane] = Real(0.0f);
      if (program_.driven()) state(life, kAge)[lane] = Real(static_cast<float>(program_.longest));
      if (!lookup_.empty()) lookup_.start(life, lane);
      for (int lag = 0; lag < past_.depth(); ++lag) past(block, lag)[k * kLanes + lane] = Real(0.0f);
      if (program_.across == 0) continue;
      from(life, 0)[lane] = Real(1.0f);
      from(life, 1)[lane] = Real(0.0f);
    }
    if (program_.across > 0) std::fill_n(turned_.data() + (block * kLanes + lane) * stride_, stride_, 0.0f);
  }

  /// Advances every block's input past by `samples`.
  void turn(int samples = 1) { past_.turn(samples); }

  /// Records a block's driving input, given all regressors, [regressor][lane]; called in every step, even if noiseless.
  void hear(int block, const Real* regressors) {
    if (!program_.driven()) return;
    for (int k = 0; k < lives(); ++k, regressors += kVectorRegressors * kLanes) {
      store(load<Reals<N>>(regressors + program_.toward * kLanes), past(block, 0) + k * kLanes);
    }
  }

  /// Advances the lanes in use of a block to their next rows.
  void step(int block, const Moment<N>& moment) {
    for (int k = 0; k < lives(); ++k) {
      const Life life{block, k * blocks_ + block, k};
      lookup_.empty() ? step_life(life, moment) : step_by_state(life, moment);
    }
    for (int lane = 0; program_.across > 0 && lane < moment.lanes(); ++lane) turn_row(block, lane);
  }

  /// Writes the residuals of a block, [output][lane], to `shocks`.
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

  /// Returns the residuals of a lane, one per output, before scaling.
  const float* played(int block, int lane) const {
    if (program_.across > 0) return turned_.data() + (block * kLanes + lane) * stride_;
    return program_.played(whole(state(block, kPlace)[lane]));
  }

  std::size_t lane_values() const {
    const auto depth = static_cast<std::size_t>(past_.depth());
    const std::size_t one = static_cast<std::size_t>(kStateValues) + depth + lookup_.lane_values();
    return empty() ? 0 : program_.across > 0 ? 2 * (one + 2) : one;
  }

  /// Visits the state of a lane, as ArxStepper::visit_lane() does. `low` and `high` bound the input.
  template <class Visit>
  void visit_lane(int block, int lane, float low, float high, Visit visit) {
    if (empty()) return;
    const std::size_t places = 2 * program_.left.size();
    const bool mirrors = program_.mirrors();
    const auto last = static_cast<float>(places - (mirrors ? 1 : 2));
    for (int k = 0; k < lives(); ++k) {
      const int life = k * blocks_ + block;
      for (int value = 0; value < kStateValues; value += 2) {
        visit(state(life, value + kPlace)[lane], 0.0f, last, mirrors ? 1.0f : 2.0f);
        visit(state(life, value + kAge)[lane], 0.0f, static_cast<float>(program_.longest), 1.0f);
      }
      for (int lag = 0; lag < past_.depth(); ++lag) visit(past(block, lag)[k * kLanes + lane], low, high);
      lookup_.visit_lane(life, lane, visit);
      for (int axis = 0; program_.across > 0 && axis < 2; ++axis) visit(from(life, axis)[lane], -1.0f, 1.0f);
    }
    if (program_.across > 0) turn_row(block, lane);  // the state may have been restored
  }

 private:
  // State layout: kPlace holds 2 · row, plus 1 for the row's mirror image; kAge the number of rows played since the
  // jump. Such pairs follow for the last row of each of the kRecentBlocks runs of rows before, the newest run first.
  static constexpr float kMaxSum = 1e15f;  // bound on the sum of an input's past, in channel units
  static constexpr float kNever = std::numeric_limits<float>::infinity();
  static constexpr int kPlace = 0;
  static constexpr int kAge = 1;
  static constexpr int kStateValues = 2 * (1 + kRecentBlocks);

  static constexpr int kVectorRegressors = 3;  // regressors per component of a vector

  // A search for rows: 0 finds residuals along the wind; 1, for a body only, across it. `at`: index of its state.
  struct Life {
    int block;
    int at;
    int number;
  };
  int lives() const { return program_.across > 0 ? 2 : 1; }

  Real* state(int life, int value) { return state_.data() + (life * kStateValues + value) * kLanes; }
  const Real* state(int life, int value) const { return state_.data() + (life * kStateValues + value) * kLanes; }
  Real* from(int life, int axis) { return from_.data() + (2 * life + axis) * kLanes; }
  const Real* from(int life, int axis) const { return from_.data() + (2 * life + axis) * kLanes; }
  Real* past(int block, int lag) { return past_.sample(block, static_cast<std::uint32_t>(lag)); }
  const Real* past(int block, std::uint32_t lag) const { return past_.sample(block, lag); }
  static std::uint32_t whole(const Real& value) { return static_cast<std::uint32_t>(value_of(value)); }

  void remember(int block, int lane) {
    for (int value = kStateValues - 1; value >= 2; --value) state(block, value)[lane] = state(block, value - 2)[lane];
  }

  void step_life(const Life& life, const Moment<N>& moment) {
    Places places;
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t at = whole(state(life.at, kPlace)[lane]);
      const bool used = lane < moment.lanes(), last = program_.left[at / 2] == 0;
      places.next[lane] = used ? at + 2 : at;
      places.forced[lane] = used && (last || whole(state(life.at, kAge)[lane]) >= program_.longest);
    }
    search(life, moment, places);
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      const std::uint32_t at = whole(state(life.at, kPlace)[lane]), next = places.next[lane];
      if (next == at + 2 && !places.forced[lane]) {
        state(life.at, kAge)[lane] = Real(static_cast<float>(whole(state(life.at, kAge)[lane]) + 1));
      } else {
        remember(life.at, lane);
        state(life.at, kAge)[lane] = Real(1.0f);
      }
      state(life.at, kPlace)[lane] = Real(static_cast<float>(next));
    }
  }

  // Computes a body lane's residuals from the rows of both searches.
  void turn_row(int block, int lane) {
    const std::uint32_t other = whole(state(blocks_ + block, kPlace)[lane]);
    const float *along = program_.played(whole(state(block, kPlace)[lane]) / 2 * 2), *across = program_.played(other);
    const auto vectors = static_cast<std::size_t>(program_.across);
    const std::size_t numbers = static_cast<std::size_t>(program_.outputs) - 2 * vectors;
    float* out = turned_.data() + (block * kLanes + lane) * stride_;
    // Copies four numbers at a time, as rows are padded; excess numbers are overwritten below.
    for (std::size_t k = 0; k < numbers; k += 4) std::memcpy(out + k, along + k, 4 * sizeof(float));
    const Real x = from(block, 0)[lane], z = from(block, 1)[lane];
    const Real other_x = from(blocks_ + block, 0)[lane], other_z = from(blocks_ + block, 1)[lane];
    for (std::size_t k = numbers; k < numbers + vectors; ++k) {
      const Real a(along[k]), b(across[k]), unit(program_.unit[k - numbers]);
      out[k] = value_of(a * x - b * other_z);
      out[k + vectors] = value_of((a * z + b * other_x) * unit);
    }
  }

  void step_by_state(const Life& life, const Moment<N>& moment) {
    const int block = life.at;
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
        const auto *where = words[2 * life.number], *how_long = words[2 * life.number + 1];
        row = lookup_.jump(block, lane, {row - 1, count - 1}, where[lane], how_long[lane], program_.left);
        remember(block, lane);
        count = 1;
      }
      place = Real(static_cast<float>(2 * row));
      age = Real(static_cast<float>(count));
    }
  }

  // Next places (2 · row, plus 1 for the mirror image) of a block's lanes, and the lanes that must jump.
  struct Places {
    std::uint32_t next[kLanes];
    bool forced[kLanes];
  };

  // Input past of each lane, at each lag. A past with a negative sum (`right`) is searched with its sign reversed, and
  // the row that is found is played as its mirror image.
  struct Heard {
    Real wind[kMaxResampledLags][kLanes];
    bool right[kLanes];
    Real from[2][kLanes];  // for a body: wind direction, along which the past is measured
  };

  // Lanes that may jump. Each stage of the search runs for all these lanes, to overlap their memory latencies.
  struct Seekers {
    int lane[kLanes];
    std::uint32_t leaf[kLanes] = {};
    int count = 0;
  };

  // Searches new rows for the lanes that must jump, and for those whose input is too far from the recorded input.
  void search(const Life& life, const Moment<N>& moment, Places& places) {
    Seekers seekers;
    Real ahead[kLanes];
    go_on(life, places, ahead);
    for (int lane = 0; lane < moment.lanes(); ++lane) {
      const bool seeks = places.forced[lane] || value_of(ahead[lane]) > program_.tolerance;
      seekers.lane[seekers.count] = lane;
      seekers.count += seeks ? 1 : 0;
    }
    if (seekers.count == 0) return;
    std::uint32_t words[4][kLanes];
    draw(moment, words);
    Heard heard;
    program_.across > 0 ? hear_vector(life.block, heard) : hear_past(life.block, heard);
    descend(heard, words[2 * life.number], seekers);
    Nearest nearest;
    find_nearest(life.at, heard, seekers, nearest);
    for (int k = 0; k < seekers.count; ++k) {
      const int lane = seekers.lane[k];
      const Real* on = places.forced[lane] ? nullptr : &ahead[lane];
      places.next[lane] = jump(life, k, seekers, heard, nearest, words[2 * life.number + 1][lane], on);
    }
  }

  // Computes the distance of the lanes' input pasts from those of the next rows: the sum of absolute differences over
  // lags, which chooses as well as a sum of squares and takes half of the operations.
  void go_on(const Life& life, const Places& places, Real (&ahead)[kLanes]) const {
    const float* wind[kLanes];
    Real mirrored[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t next = places.next[lane];
      // A lane that must jump may have no next row. The current row is read instead, and the result not used.
      wind[lane] = program_.wind.data() + program_.now[next / 2 - (places.forced[lane] ? 1 : 0)];
      mirrored[lane] = Real(next % 2 != 0 && program_.across == 0 ? 1.0f : 0.0f);
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
      const auto now = program_.across > 0 ? along(life.block, lag, from(life.at, 0), from(life.at, 1))
                                           : load<Reals<N>>(past(life.block, lag));
      sum = sum + magnitude(each(apart, load<Reals<N>>(then), now, turned, zero));
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

  // Returns the component, along a direction, of the input vector `lag` steps ago.
  Reals<N> along(int block, std::uint32_t lag, const Real* x, const Real* z) const {
    const Real* vector = past(block, lag);
    return load<Reals<N>>(vector) * load<Reals<N>>(x) + load<Reals<N>>(vector + kLanes) * load<Reals<N>>(z);
  }

  // Measures the input past of a body along the direction of the past's vector sum; along x if the sum is 0.
  void hear_vector(int block, Heard& heard) const {
    auto x = all<Reals<N>>(0.0f), z = x, one = all<Reals<N>>(1.0f);
    for (const std::uint32_t lag : program_.lags) {
      x = x + load<Reals<N>>(past(block, lag));
      z = z + load<Reals<N>>(past(block, lag) + kLanes);
    }
    const LevelVector<N> sum(x, z, kMaxSum);
    const auto if_none = [](const auto& length, const auto& none, const auto& yes, const auto& no) {
      return length > none ? no : yes;
    };
    store(each(if_none, sum.length, all<Reals<N>>(0.0f), one, sum.x), heard.from[0]);
    store(sum.z, heard.from[1]);
    for (std::size_t k = 0; k < program_.lags.size(); ++k) {
      store(along(block, program_.lags[k], heard.from[0], heard.from[1]), heard.wind[k]);
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

  // Descends the tree to a leaf for each seeker. If the past is within the margin of a node's value, the side is chosen
  // at random, so that all calm rows, whose pasts are equal, are reachable.
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

  // Rows above `low`, up to `high`: those that the lanes played recently, or would play next without a jump. A mirrored
  // place adds half a row to both bounds, which changes no comparison with whole rows.
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

  // Computes the distances of a lane's input past from those of a leaf's rows; infinite for missing or recent rows.
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

  // For every seeker, distance and index of a leaf's nearest rows, nearest first; equal ones in the order of indices.
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

  // Ranks the candidates of kPartLanes seekers from `first` on. Results beyond the last seeker are not read.
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
        // From the last rank on: the entry displaced from a rank moves to the next.
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

  // Chooses a seeker's next place: the next row, if its distance `ahead` exceeds the leaf's least by at most the
  // tolerance, else one of the nearest rows at random. `ahead` is null for a lane that must jump. If all rows of the
  // leaf are excluded: the next row, or the leaf's last row if the lane must jump.
  std::uint32_t jump(const Life& life, int seeker, const Seekers& seekers, const Heard& heard, const Nearest& nearest,
                     std::uint32_t word, const Real* ahead) {
    const int lane = seekers.lane[seeker];
    const Candidates& rows = program_.leaves[seekers.leaf[seeker]];
    const std::uint32_t on = whole(state(life.at, kPlace)[lane]) + 2;
    const std::uint32_t count = nearest.count(seeker);
    if (count == 0) return ahead ? on : arrive(life, lane, heard, rows.place[rows.count - 1], word);
    if (ahead && value_of(*ahead - Real(nearest.apart[0][seeker])) <= program_.tolerance) return on;
    const auto which = static_cast<std::uint32_t>(nearest.candidate[share_of(word, count)][seeker]);
    return arrive(life, lane, heard, rows.place[which], word);
  }

  // Returns the place to play after a jump to `place` of the tree: its mirror image if the past was mirrored before the
  // search. For a body the direction is mirrored instead, and residuals across the wind are mirrored at random.
  std::uint32_t arrive(const Life& life, int lane, const Heard& heard, std::uint32_t place, std::uint32_t word) {
    if (program_.across == 0) return place ^ (heard.right[lane] ? 1 : 0);
    const Real side(place % 2 != 0 ? -1.0f : 1.0f);
    for (int axis = 0; axis < 2; ++axis) from(life.at, axis)[lane] = side * heard.from[axis][lane];
    return place / 2 * 2 + (life.number == 0 ? 0 : word % 2);
  }

  ResampledProgram program_;
  LookupLanes<N> lookup_;
  std::span<Real> state_;
  SampleRing<N> past_;       // past of the input
  std::span<Real> from_;     // for a body [search][x, z][lane]: wind direction to which a row is rotated
  std::span<float> turned_;  // [block][lane][output]: residuals rotated to that direction
  std::size_t stride_ = 0;
  int blocks_ = 0;
  float scale_ = 0;  // scale of the noise
};

}  // namespace wisp
