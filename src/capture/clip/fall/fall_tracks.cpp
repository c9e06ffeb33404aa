#include "capture/clip/fall/falls.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/statistics.hpp"

namespace wisp::fall {
namespace {

constexpr double kGapSeconds = 0.05;  // longest absence within a track: edge-on or as bright as the wall
constexpr std::size_t kMinGap = 2;    // frames: an absence this short is tolerated at any frame rate
constexpr double kFirstSpeed = 6;     // maximum initial speed, picture heights a second
constexpr double kChange = 2.5;       // tolerance of the predicted speed, heights a second, plus kShare of the speed
constexpr double kShare = 0.6;        // tolerance as a share of the predicted speed, added to kChange
constexpr double kMinReach = 3;       // minimum search radius, reduced pixels
constexpr double kJoinSeconds = 0.2;  // longest gap or overlap of joined tracks: a cubic across it fits 0.5 s swings
constexpr double kJoinReach = 0.1;    // heights: maximum distance of joined tracks, extrapolated to mid-gap
constexpr std::size_t kSteady = 3;    // minimum rows of a track; frames to judge speed, rest and exit

constexpr double kMinSeconds = 0.3;         // minimum duration of a fall
constexpr std::size_t kMinStretchRows = 8;  // minimum rows of a stretch that a chain can be learned from
constexpr double kMinDescent = 0.25;        // minimum descent of a fall, picture heights
constexpr double kPieceDescent = 0.1;       // heights: minimum descent of a fragment of a fall
constexpr double kAtRest = 0.01;            // heights: an object this near its first or lowest position rests
constexpr double kApart = 0.03;             // heights: maximum change of the distance between an object and its shadow
constexpr double kNearEnd = 0.1;            // heights: a fall that ends at most this far above the ground is complete
constexpr double kNearSide = 2;             // reduced pixels: an object predicted nearer to a side counts as cut off
constexpr double kSameSeconds = 0.5;        // longest gap between fragments of one fall

struct Track {
  std::vector<std::size_t> frames{};
  std::vector<Thing> things{};

  // Mean speed over the last steps (`first`: the first ones), reduced pixels a frame; 0 for a single row.
  double speed(double Thing::*axis, std::size_t steps, bool first = false) const {
    if (things.size() < 2) return 0;
    const std::size_t length = std::min(things.size() - 1, steps), a = first ? 0 : things.size() - 1 - length;
    return (things[a + length].*axis - things[a].*axis) / static_cast<double>(frames[a + length] - frames[a]);
  }
};

// Returns the distance of an object from a track's predicted position in a frame, divided by the tolerated distance.
double miss(const Track& track, const Thing& thing, std::size_t frame, const Scale& scale) {
  const auto gap = static_cast<double>(frame - track.frames.back());
  const double u = track.speed(&Thing::x, 1), v = track.speed(&Thing::y, 1);
  const double known = kChange * scale.height / scale.rate_hz + kShare * std::hypot(u, v);
  const double reach = gap * (track.things.size() < 2 ? kFirstSpeed * scale.height / scale.rate_hz : known);
  const Thing& last = track.things.back();
  return std::hypot(thing.x - last.x - gap * u, thing.y - last.y - gap * v) / std::max(kMinReach, reach);
}

std::vector<Track> linked(std::span<const Seen> frames, const Scale& scale) {
  const std::size_t gap = std::max(kMinGap, static_cast<std::size_t>(kGapSeconds * scale.rate_hz));
  std::vector<Track> live, done;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const std::vector<Thing>& things = frames[frame].things;
    std::erase_if(live, [&](Track& track) {
      if (frame - track.frames.back() <= gap + 1) return false;
      done.push_back(std::move(track));
      return true;
    });
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t t = 0; t < live.size(); ++t) {
      for (std::size_t k = 0; k < things.size(); ++k) {
        const double far = miss(live[t], things[k], frame, scale);
        if (far <= 1) pairs.emplace_back(far, t, k);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> taken(things.size());
    for (const auto& [far, t, k] : pairs) {
      if (taken[k] || live[t].frames.back() == frame) continue;
      taken[k] = true;
      live[t].frames.push_back(frame);
      live[t].things.push_back(things[k]);
    }
    for (std::size_t k = 0; k < things.size(); ++k) {
      if (!taken[k]) live.push_back({{frame}, {things[k]}});
    }
  }
  std::move(live.begin(), live.end(), std::back_inserter(done));
  return done;
}

// Returns the distance of two tracks extrapolated to the gap's middle; negative if `after` does not continue `before`.
double seam(const Track& before, const Track& after, const Scale& scale) {
  const double gap = static_cast<double>(after.frames.front()) - static_cast<double>(before.frames.back());
  if (std::abs(gap) > kJoinSeconds * scale.rate_hz) return -1;
  if (after.frames.front() <= before.frames.front() || after.frames.back() <= before.frames.back()) return -1;
  const Thing &a = before.things.back(), &b = after.things.front();
  const auto apart = [&](double Thing::*axis) {
    return b.*axis - a.*axis - gap / 2 * (before.speed(axis, kSteady) + after.speed(axis, kSteady, true));
  };
  const double far = std::hypot(apart(&Thing::x), apart(&Thing::y));
  return far <= kJoinReach * scale.height ? far : -1;
}

// Appends a track to an earlier one, replacing the earlier one's rows where the two overlap.
void append(Track& before, const Track& after) {
  const auto end =
      std::lower_bound(before.frames.begin(), before.frames.end(), after.frames.front()) - before.frames.begin();
  before.frames.resize(static_cast<std::size_t>(end));
  before.things.resize(static_cast<std::size_t>(end));
  before.frames.insert(before.frames.end(), after.frames.begin(), after.frames.end());
  before.things.insert(before.things.end(), after.things.begin(), after.things.end());
}

// Tracks objects by nearest prediction at constant velocity. One briefly invisible or split stays one track.
std::vector<Track> tracks_in(std::span<const Seen> frames, const Scale& scale) {
  std::vector<Track> tracks = linked(frames, scale);
  std::erase_if(tracks, [](const Track& track) { return track.things.size() < kSteady; });
  std::stable_sort(tracks.begin(), tracks.end(),
                   [](const Track& a, const Track& b) { return a.frames.front() < b.frames.front(); });
  std::vector<std::tuple<double, std::size_t, std::size_t>> seams;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    const double last = static_cast<double>(tracks[a].frames.back()) + kJoinSeconds * scale.rate_hz;
    for (std::size_t b = a + 1; b < tracks.size() && static_cast<double>(tracks[b].frames.front()) <= last; ++b) {
      if (const double far = seam(tracks[a], tracks[b], scale); far >= 0) seams.emplace_back(far, a, b);
    }
  }
  std::sort(seams.begin(), seams.end());
  std::vector<std::size_t> next(tracks.size(), tracks.size());
  std::vector<bool> follows(tracks.size());
  for (const auto& [far, a, b] : seams) {
    if (next[a] != tracks.size() || follows[b]) continue;
    next[a] = b;
    follows[b] = true;
  }
  std::vector<Track> joined;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    if (follows[a]) continue;
    joined.push_back(tracks[a]);
    for (std::size_t b = next[a]; b != tracks.size(); b = next[b]) append(joined.back(), tracks[b]);
  }
  return joined;
}

// A track from the start of motion until the object lies or leaves the picture.
struct Candidate {
  Track track;
  bool rests = false;  // whether the object is seen lying

  std::size_t begin() const { return track.frames.front(); }
  std::size_t end() const { return track.frames.back(); }
  double bottom() const { return track.things.back().bottom; }
  double descent() const { return track.things.back().y - track.things.front().y; }
};

Candidate trimmed(Track track, double height) {
  double lowest = track.things.front().y;
  for (const Thing& thing : track.things) lowest = std::max(lowest, thing.y);
  std::size_t first = 0, last = 0;
  const auto moved = [&](const Thing& thing) {
    return std::hypot(thing.x - track.things[0].x, thing.y - track.things[0].y) > kAtRest * height;
  };
  while (first < track.things.size() && !moved(track.things[first])) ++first;
  while (last + 1 < track.things.size() && track.things[last].y < lowest - kAtRest * height) ++last;
  first = std::max<std::size_t>(first, 1) - 1;
  if (first > last) first = last;
  const bool rests = last + kSteady < track.things.size();
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(last) + 1, values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
  };
  cut(track.frames);
  cut(track.things);
  return {std::move(track), rests};
}

bool is_long(const Candidate& fall, const Scale& scale) {
  const std::size_t rows = fall.end() - fall.begin() + 1;
  return rows >= kMinStretchRows && static_cast<double>(rows - 1) >= kMinSeconds * scale.rate_hz;
}

bool is_fall(const Candidate& fall, const Scale& scale) {
  return is_long(fall, scale) && fall.descent() >= kMinDescent * scale.height;
}

// Returns whether an object, extrapolated by kSteady frames, is within kNearSide of the picture's left or right side.
bool crosses_side(const Thing& thing, double speed, const Scale& scale) {
  const double way = speed * kSteady;
  return thing.left + way < kNearSide || thing.right + way > scale.width - 1 - kNearSide;
}

// Classifies how a fall was cut. `ground`: height (y) at which falls end.
Cut cut_of(const Candidate& fall, double ground, std::size_t frames, const Scale& scale) {
  const Track& track = fall.track;
  if (crosses_side(track.things.front(), -track.speed(&Thing::x, kSteady, true), scale)) return Cut::kSide;
  if (fall.rests || fall.end() + kSteady >= frames || fall.bottom() >= ground - kNearEnd * scale.height)
    return Cut::kNo;
  return crosses_side(track.things.back(), track.speed(&Thing::x, kSteady), scale) ? Cut::kSide : Cut::kLost;
}

// Returns half an object's extent plus its motion until the next frame, reduced pixels.
double reach(const Track& track, std::size_t k) {
  const Thing &now = track.things[k], &next = track.things[std::min(k + 1, track.things.size() - 1)];
  return std::max((now.right - now.left) / 2, now.bottom - now.y) + std::hypot(next.x - now.x, next.y - now.y);
}

// Whether two objects touch, or may touch within a frame.
bool pass(const Candidate& one, const Candidate& other) {
  const Track &a = one.track, &b = other.track;
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    const auto at = std::lower_bound(b.frames.begin(), b.frames.end(), a.frames[k]);
    if (at == b.frames.end()) break;
    const auto j = static_cast<std::size_t>(at - b.frames.begin());
    const double far = std::hypot(a.things[k].x - b.things[j].x, a.things[k].y - b.things[j].y);
    if (*at == a.frames[k] && far < reach(a, k) + reach(b, j)) return true;
  }
  return false;
}

// Returns the median height (y) at which falls end that do not leave at a side; the lower border if there are none.
double ground_of(const std::vector<Candidate>& falls, const Scale& scale) {
  std::vector<double> ends;
  for (const Candidate& fall : falls) {
    const Track& track = fall.track;
    if (!crosses_side(track.things.back(), track.speed(&Thing::x, kSteady), scale)) ends.push_back(fall.bottom());
  }
  return ends.empty() ? scale.height : median(std::move(ends));
}

// Returns whether two tracks keep their distance for half of the shorter one: object and shadow, or parts of an object.
bool together(const Candidate& one, const Candidate& other_one, double height) {
  const Track &a = one.track, &b = other_one.track;
  std::vector<double> x, y;
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    const auto at = std::lower_bound(b.frames.begin(), b.frames.end(), a.frames[k]);
    if (at == b.frames.end() || *at != a.frames[k]) continue;
    const Thing& other = b.things[static_cast<std::size_t>(at - b.frames.begin())];
    x.push_back(a.things[k].x - other.x);
    y.push_back(a.things[k].y - other.y);
  }
  if (2 * x.size() < std::min(a.frames.size(), b.frames.size())) return false;
  const auto spread = [](const std::vector<double>& v) {
    const auto [least, most] = std::minmax_element(v.begin(), v.end());
    return *most - *least;
  };
  return spread(x) <= kApart * height && spread(y) <= kApart * height;
}

double contrast(const Candidate& fall) {
  std::vector<double> values;
  for (const Thing& thing : fall.track.things) values.push_back(thing.contrast);
  return median(std::move(values));
}

void in_order(std::vector<Candidate>& falls) {
  std::stable_sort(falls.begin(), falls.end(),
                   [](const Candidate& a, const Candidate& b) { return a.begin() < b.begin(); });
}

void leave_out_shadows(std::vector<Candidate>& falls, double height) {
  std::stable_sort(falls.begin(), falls.end(),
                   [](const Candidate& a, const Candidate& b) { return contrast(a) > contrast(b); });
  std::vector<Candidate> kept;
  for (Candidate& fall : falls) {
    if (std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) { return together(fall, other, height); })) {
      kept.push_back(std::move(fall));
    }
  }
  falls = std::move(kept);
  in_order(falls);
}

// Returns the cuts of undetected falls, recognised by fragments: sinking tracks in `rest`, which is in order of first
// frames. Each fall counts once.
std::vector<Cut> missed_of(const std::vector<Candidate>& rest, const std::vector<Candidate>& falls,
                           const std::vector<Cut>& cuts, double ground, std::size_t frames, const Scale& scale) {
  const auto same = static_cast<std::size_t>(kSameSeconds * scale.rate_hz);
  std::vector<Cut> missed;
  std::size_t last = 0;  // last frame of the fragment before
  for (const Candidate& piece : rest) {
    if (piece.descent() < kPieceDescent * scale.height) continue;
    const bool quick = piece.descent() >= kMinDescent * scale.height;
    const Cut cut = quick ? Cut::kQuick : cut_of(piece, ground, frames, scale);
    if (cut == Cut::kNo) continue;
    bool known = !missed.empty() && piece.begin() <= last + same;
    for (std::size_t k = 0; k < falls.size() && !known; ++k) {
      const bool near = piece.begin() <= falls[k].end() + same && falls[k].begin() <= piece.end() + same;
      known = near && (cuts[k] != Cut::kNo || together(piece, falls[k], scale.height));
    }
    if (known) continue;
    missed.push_back(cut);
    last = piece.end();
  }
  return missed;
}

// Unwraps the angle modulo π. In rows with a round silhouette, interpolates the angle from the rows before and after.
void unwrap(Track& track) {
  std::size_t known = track.things.size();
  for (std::size_t k = 0; k < track.things.size(); ++k) {
    if (track.things[k].aspect < kRound) continue;
    double& angle = track.things[k].angle;
    const double last = known < k ? track.things[known].angle : angle;
    angle -= std::numbers::pi * std::round((angle - last) / std::numbers::pi);
    const std::size_t from = known < k ? known + 1 : 0;
    for (std::size_t j = from; j < k; ++j) {
      const double share = from == 0 ? 1 : static_cast<double>(j - known) / static_cast<double>(k - known);
      track.things[j].angle = last + share * (angle - last);
    }
    known = k;
  }
  for (std::size_t k = known + 1; k < track.things.size(); ++k) track.things[k].angle = track.things[known].angle;
}

// Builds a fall from a track; frames without a detection are interpolated by a cubic.
Fall fall_of(const Track& track, Cut cut) {
  Fall fall{track.frames.front(), {}, {}, cut};
  const std::size_t count = track.frames.size();
  const auto at = [&](std::size_t k, double Thing::*part) { return track.things[k].*part; };
  for (std::size_t k = 0; k < count; ++k) {
    fall.rows.push_back(track.things[k]);
    fall.filled.push_back(0);
    if (k + 1 == count) break;
    const auto frame = [&](std::size_t i) { return static_cast<double>(track.frames[i]); };
    const double step = frame(k + 1) - frame(k);
    const std::size_t before = k > 0 ? k - 1 : k, after = std::min(k + 2, count - 1);
    for (std::size_t missing = track.frames[k] + 1; missing < track.frames[k + 1]; ++missing) {
      Thing thing = track.things[k];
      const double s = (static_cast<double>(missing) - frame(k)) / step;
      for (double Thing::*part : {&Thing::x, &Thing::y, &Thing::angle}) {
        const double a = at(k, part), b = at(k + 1, part);
        const double from = step * (b - at(before, part)) / (frame(k + 1) - frame(before));
        const double to = step * (at(after, part) - a) / (frame(after) - frame(k));
        thing.*part = a + s * (from + s * (3 * (b - a) - 2 * from - to + s * (from + to - 2 * (b - a))));
      }
      fall.rows.push_back(thing);
      fall.filled.push_back(1);
    }
  }
  return fall;
}

}  // namespace

Falls falls_in(std::span<const Seen> frames, const Scale& scale) {
  std::vector<Candidate> falls, rest;
  for (Track& track : tracks_in(frames, scale)) {
    Candidate candidate = trimmed(std::move(track), scale.height);
    (is_fall(candidate, scale) ? falls : rest).push_back(std::move(candidate));
  }
  leave_out_shadows(falls, scale.height);
  in_order(rest);
  const double ground = ground_of(falls, scale);
  std::vector<Cut> cuts;
  for (const Candidate& fall : falls) {
    cuts.push_back(cut_of(fall, ground, frames.size(), scale));
    const auto passes = [&](const Candidate& other) { return &other != &fall && pass(fall, other); };
    if (cuts.back() == Cut::kNo && std::any_of(falls.begin(), falls.end(), passes)) cuts.back() = Cut::kPasses;
  }
  Falls found{{}, missed_of(rest, falls, cuts, ground, frames.size(), scale)};
  for (std::size_t k = 0; k < falls.size(); ++k) {
    if (cuts[k] == Cut::kPasses) {
      found.missed.push_back(cuts[k]);
      continue;
    }
    unwrap(falls[k].track);
    found.falls.push_back(fall_of(falls[k].track, cuts[k]));
  }
  return found;
}

}  // namespace wisp::fall
