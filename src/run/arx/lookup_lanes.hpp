#pragma once
// Searches for the row to jump to from the end of the current block of rows (played consecutively), lane by lane: a row
// that is near in position and speed, not played recently, preferably in a little-used part. Since a block's end is
// known at its beginning, a few candidates are compared per step, which bounds the cost of a step. Sources: A. Schödl,
// R. Szeliski, D. Salesin, I. Essa, "Video Textures", SIGGRAPH 2000; for the penalty of repeated play, W. Li, X. Chen,
// P. Li, O. Sorkine-Hornung, B. Chen, "Example-Based Motion Synthesis via Generative Motion Matching", SIGGRAPH 2023,
// whose bidirectional similarity requires that all of an example is used.

#include <algorithm>
#include <cstdint>
#include <span>

#include "run/arx/resampled_program.hpp"
#include "run/lanes/random_lanes.hpp"
#include "run/state/arena.hpp"

namespace wisp {

/// A run of consecutively played rows.
struct PlayedRows {
  std::uint32_t last;
  std::uint32_t count;
};

template <class N>
class LookupLanes {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  LookupLanes(const LookupProgram& program, int blocks, Arena& arena) : program_(program) {
    if (!program.empty()) state_ = arena.take<Real>(static_cast<std::size_t>(blocks) * kValues * kLanes);
  }

  bool empty() const { return program_.empty(); }

  void start(int block, int lane) {
    for (int value = 0; value < kValues; ++value) at(block, value)[lane] = Real(0.0f);
    forget_places(block, lane);
  }

  /// Returns whether a lane's current block of rows ends, of which it has played `played` rows.
  bool is_over(int block, int lane, std::uint32_t played) const { return played >= length(block, lane); }

  /// Compares this step's share of candidates. `played`: the rows played so far of the current block, then those of
  /// earlier blocks, newest first; `left`: number of rows that follow the current row in its stretch.
  void look(int block, int lane, std::span<const PlayedRows> played, std::uint32_t left) {
    const std::uint32_t all = length(block, lane), now = played[0].count;
    if (now == 0 || now > all) return;
    const std::uint32_t first = program_.groups() * (now - 1) / all, end = program_.groups() * now / all;
    if (first == end) return;
    const std::uint32_t ahead = std::min(all - now, left);
    const Aim aim = aim_at(played[0].last + ahead, left > ahead, now + ahead);
    for (std::uint32_t group = first; group < end; ++group) compare(block, lane, group, aim, played, ahead);
  }

  /// Counts `played`, the block just finished, and draws the next block by two random words: its first row, which is
  /// returned, and its length. `left`: per row, number of rows that follow in its stretch.
  std::uint32_t jump(int block, int lane, PlayedRows played, std::uint32_t where, std::uint32_t how_long,
                     std::span<const std::uint32_t> left) {
    count(block, lane, played);
    std::uint32_t near = 0;
    while (near < kNearestPlaces && value_of(at(block, kCost + static_cast<int>(near))[lane]) < kNone) ++near;
    const std::uint32_t place =
        near == 0
            ? share_of(where, program_.places)
            : std::min(whole(at(block, kPlace + static_cast<int>(share_of(where, near)))[lane]), program_.places - 1);
    const std::uint32_t row = program_.row[place];
    const std::uint32_t drawn = program_.shortest + share_of(how_long, program_.longest - program_.shortest + 1);
    at(block, kLength)[lane] = Real(static_cast<float>(std::min(drawn, left[row] + 1)));
    forget_places(block, lane);
    return row;
  }

  std::size_t lane_values() const { return empty() ? 0 : kValues; }

  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    if (empty()) return;
    visit(at(block, kLength)[lane], 0.0f, static_cast<float>(program_.longest), 1.0f);
    visit(at(block, kWeight)[lane], 0.0f, kNone);
    for (int k = 0; k < kNearestPlaces; ++k) {
      visit(at(block, kCost + k)[lane], 0.0f, kNone);
      visit(at(block, kPlace + k)[lane], 0.0f, static_cast<float>(program_.places - 1), 1.0f);
    }
    for (int k = 0; k < static_cast<int>(kPlayedParts); ++k) visit(at(block, kCount + k)[lane], 0.0f, kMaxCounted);
  }

 private:
  static constexpr float kNone = 1e30f;       // cost of a missing candidate
  static constexpr float kBarred = 10;        // added to an excluded row's cost: ranks it behind nearly all others
  static constexpr float kForgotten = 1e-3f;  // share by which play counts decay per played row
  static constexpr float kMaxCounted = 1e7f;
  static constexpr int kLength = 0, kWeight = 1, kCost = 2, kPlace = kCost + kNearestPlaces;
  static constexpr int kCount = kPlace + kNearestPlaces, kValues = kCount + static_cast<int>(kPlayedParts);

  Real* at(int block, int value) { return state_.data() + (block * kValues + value) * kLanes; }
  const Real* at(int block, int value) const { return state_.data() + (block * kValues + value) * kLanes; }
  static std::uint32_t whole(const Real& value) { return static_cast<std::uint32_t>(value_of(value)); }
  std::uint32_t length(int block, int lane) const { return whole(at(block, kLength)[lane]); }

  void forget_places(int block, int lane) {
    for (int k = 0; k < kNearestPlaces; ++k) {
      at(block, kCost + k)[lane] = Real(kNone);
      at(block, kPlace + k)[lane] = Real(0.0f);
    }
  }

  // Position and speed at the end of the current block, with which candidates are compared.
  struct Aim {
    Real trait[2 * kMaxTraits];
    std::uint32_t row;
  };
  Aim aim_at(std::uint32_t row, bool goes_on, std::uint32_t played) const {
    Aim aim{{}, row};
    const auto traits = static_cast<std::uint32_t>(program_.traits);
    const std::uint32_t to = goes_on ? row + 1 : row, from = goes_on || played < 2 || row == 0 ? row : row - 1;
    for (std::uint32_t t = 0; t < traits; ++t) {
      aim.trait[t] = Real(program_.position[row * traits + t]);
      const Real step = Real(program_.position[to * traits + t]) - Real(program_.position[from * traits + t]);
      aim.trait[traits + t] = Real(program_.quickness) * step;
    }
    return aim;
  }

  void compare(int block, int lane, std::uint32_t group, const Aim& aim, std::span<const PlayedRows> played,
               std::uint32_t ahead) {
    const int traits = 2 * program_.traits;
    const float* place = program_.place.data() + group * static_cast<std::uint32_t>(traits) * kPlacesAtOnce;
    Real apart[kPlacesAtOnce];
    for (std::uint32_t first = 0; first < kPlacesAtOnce; first += kLanes) {
      auto sum = all<Reals<N>>(0.0f);
      for (int t = 0; t < traits; ++t) {
        const auto there = load<Reals<N>>(place + static_cast<std::uint32_t>(t) * kPlacesAtOnce + first);
        const auto away = there - all<Reals<N>>(value_of(aim.trait[t]));
        sum = sum + away * away;
      }
      store(sum, apart + first);
    }
    const std::uint32_t begin = group * kPlacesAtOnce, end = std::min(begin + kPlacesAtOnce, program_.places);
    for (std::uint32_t k = begin; k < end; ++k) {
      const Real first = at(block, kCount + program_.ahead[2 * k])[lane];
      const Real second = at(block, kCount + program_.ahead[2 * k + 1])[lane];
      Real cost = apart[k - begin] + at(block, kWeight)[lane] * (first + second);
      if (is_barred(program_.row[k], aim.row, played, ahead)) cost = cost + Real(kBarred);
      keep(block, lane, cost, k);
    }
  }

  // Returns whether `row` is near the row after `end`, the block's last, or was played recently when the block ends.
  bool is_barred(std::uint32_t row, std::uint32_t end, std::span<const PlayedRows> played, std::uint32_t ahead) const {
    if (row + program_.beside > end && row <= end + 1 + program_.beside) return true;
    std::uint32_t room = program_.recent;
    for (const PlayedRows& one : played) {
      const std::uint32_t last = one.last + ahead, count = std::min(one.count + ahead, room);
      if (row <= last && row + count > last) return true;
      room -= count;
      ahead = 0;
    }
    return false;
  }

  // Inserts a candidate into the list of the cheapest ones, behind those of equal cost.
  void keep(int block, int lane, Real cost, std::uint32_t place) {
    int rank = kNearestPlaces;
    while (rank > 0 && cost < at(block, kCost + rank - 1)[lane]) --rank;
    for (int k = kNearestPlaces - 1; k > rank; --k) {
      at(block, kCost + k)[lane] = at(block, kCost + k - 1)[lane];
      at(block, kPlace + k)[lane] = at(block, kPlace + k - 1)[lane];
    }
    if (rank == kNearestPlaces) return;
    at(block, kCost + rank)[lane] = cost;
    at(block, kPlace + rank)[lane] = Real(static_cast<float>(place));
  }

  // Decays the play counts of the parts, adds a block's rows, and sets the weight of usage to coverage / sum of counts.
  void count(int block, int lane, PlayedRows played) {
    if (played.count == 0) return;
    const std::uint32_t first = played.last + 1 - played.count;
    const Real kept(std::max(0.0f, 1.0f - kForgotten * static_cast<float>(played.count)));
    Real sum(0.0f);
    for (std::uint32_t part = 0; part < kPlayedParts; ++part) {
      Real& counted = at(block, kCount + static_cast<int>(part))[lane];
      counted = counted * kept;
      const std::uint32_t begin = std::max(first, part * program_.part_rows);
      const std::uint32_t end = std::min(played.last + 1, (part + 1) * program_.part_rows);
      if (begin < end) counted = counted + Real(static_cast<float>(end - begin));
      sum = sum + counted;
    }
    at(block, kWeight)[lane] = sum > Real(0.0f) ? Real(program_.coverage) / sum : sum;
  }

  LookupProgram program_;
  std::span<Real> state_;
};

}  // namespace wisp
