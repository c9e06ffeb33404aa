#include "capture/clip/fall/fall_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace wisp::fall {
namespace {

constexpr double kGapSeconds = 0.05;     // longest invisibility, edge-on or as bright as the wall
constexpr std::size_t kMinGap = 2;       // frames
constexpr double kFirstSpeed = 6;        // maximum initial speed, picture heights a second
constexpr double kChange = 2.5;          // maximum change of speed between frames, heights a second …
constexpr double kShare = 0.6;           // … and as a share of the speed
constexpr double kMinReach = 3;          // minimum search radius, reduced pixels
constexpr double kJoinSeconds = 0.2;     // longest gap that a cubic bridges in a swing of half a second
constexpr double kJoinReach = 0.1;       // heights: largest deviation by gravity from a straight path in that time
constexpr double kOverlapSeconds = 0.2;  // time in which the end of one part and the beginning of another coexist
constexpr std::size_t kSteady = 3;       // frames over which speed is averaged where the last view is partial
constexpr std::size_t kMinRows = 3;      // minimum length of a track; shorter ones are noise

// Distance of an object from a track's predicted position in a frame, divided by the tolerated distance.
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

// Whether one track continues the other: the distance between both, extrapolated to the middle of the gap. Negative
// where it does not.
double seam(const Track& before, const Track& after, const Scale& scale) {
  const double gap = static_cast<double>(after.frames.front()) - static_cast<double>(before.frames.back());
  if (gap > kJoinSeconds * scale.rate_hz || gap < -kOverlapSeconds * scale.rate_hz) return -1;
  if (after.frames.front() <= before.frames.front() || after.frames.back() <= before.frames.back()) return -1;
  const Thing &a = before.things.back(), &b = after.things.front();
  const auto apart = [&](double Thing::*axis) {
    return b.*axis - a.*axis - gap / 2 * (before.speed(axis, kSteady) + after.first_speed(axis, kSteady));
  };
  const double far = std::hypot(apart(&Thing::x), apart(&Thing::y));
  return far <= kJoinReach * scale.height ? far : -1;
}

// Joins two tracks; where they overlap, the later one is used from its beginning.
void append(Track& before, const Track& after) {
  const auto end =
      std::lower_bound(before.frames.begin(), before.frames.end(), after.frames.front()) - before.frames.begin();
  before.frames.resize(static_cast<std::size_t>(end));
  before.things.resize(static_cast<std::size_t>(end));
  before.frames.insert(before.frames.end(), after.frames.begin(), after.frames.end());
  before.things.insert(before.things.end(), after.things.begin(), after.things.end());
}

}  // namespace

double Track::speed(double Thing::*axis, std::size_t steps) const {
  if (things.size() < 2) return 0;
  const std::size_t b = things.size() - 1, a = b - std::min(b, steps);
  return (things[b].*axis - things[a].*axis) / static_cast<double>(frames[b] - frames[a]);
}

double Track::first_speed(double Thing::*axis, std::size_t steps) const {
  if (things.size() < 2) return 0;
  const std::size_t b = std::min(things.size() - 1, steps);
  return (things[b].*axis - things[0].*axis) / static_cast<double>(frames[b] - frames[0]);
}

std::vector<Track> tracks_in(std::span<const Seen> frames, const Scale& scale) {
  std::vector<Track> tracks = linked(frames, scale);
  std::erase_if(tracks, [](const Track& track) { return track.things.size() < kMinRows; });
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

}  // namespace wisp::fall
