// Tracks by nearest prediction, with constant velocity.

#include "capture/clip/fall/fall_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace wisp::fall {
namespace {

constexpr double kMinSeconds = 0.3;
constexpr std::size_t kMinRows = 8;   // of a stretch that a chain is learned from
constexpr double kMinDescent = 0.25;  // heights of the picture
constexpr double kGapSeconds = 0.05;  // edge on, or as bright as the wall: it is back soon
constexpr std::size_t kMinGap = 2;    // frames
constexpr double kFirstSpeed = 6;     // heights a second that something may come into view with
constexpr double kChange = 2.5;       // heights a second that its speed may change by from one frame to the next …
constexpr double kShare = 0.6;        // … and of the speed itself
constexpr double kMinReach = 3;       // small pixels
constexpr double kAtRest = 0.01;      // heights: nearer to where it began or ended, it hangs or lies
constexpr double kApart = 0.03;       // heights: what keeps its distance as closely is a part, or a shadow
constexpr double kRound = 1.3;        // aspect: less long, it has no direction

struct Track {
  std::vector<std::size_t> frames;
  std::vector<Thing> things;

  double speed(double Thing::*axis) const {  // small pixels a frame
    const std::size_t n = things.size();
    if (n < 2) return 0;
    return (things[n - 1].*axis - things[n - 2].*axis) / static_cast<double>(frames[n - 1] - frames[n - 2]);
  }

  // How far a thing lies from where this one would be in a frame, over how far it may.
  double miss(const Thing& thing, std::size_t frame, double rate_hz, double height) const {
    const auto gap = static_cast<double>(frame - frames.back());
    const double u = speed(&Thing::x), v = speed(&Thing::y);
    const double known = kChange * height / rate_hz + kShare * std::hypot(u, v);
    const double reach = gap * (things.size() < 2 ? kFirstSpeed * height / rate_hz : known);
    return std::hypot(thing.x - things.back().x - gap * u, thing.y - things.back().y - gap * v) /
           std::max(kMinReach, reach);
  }
};

std::vector<Track> tracks_in(std::span<const Seen> frames, double rate_hz, double height) {
  const std::size_t gap = std::max(kMinGap, static_cast<std::size_t>(kGapSeconds * rate_hz));
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
        const double miss = live[t].miss(things[k], frame, rate_hz, height);
        if (miss <= 1) pairs.emplace_back(miss, t, k);
      }
    }
    std::ranges::sort(pairs);
    std::vector<bool> taken(things.size());
    for (const auto& [miss, t, k] : pairs) {
      if (taken[k] || live[t].frames.back() == frame) continue;
      taken[k] = true;
      live[t].frames.push_back(frame);
      live[t].things.push_back(things[k]);
    }
    for (std::size_t k = 0; k < things.size(); ++k) {
      if (!taken[k]) live.push_back({{frame}, {things[k]}});
    }
  }
  std::ranges::move(live, std::back_inserter(done));
  return done;
}

// From where it begins to move until it lies, or leaves.
void trim(Track& track, double height) {
  const auto lowest = std::ranges::max(track.things, {}, &Thing::y).y;
  std::size_t first = 0, last = 0;
  const auto moved = [&](const Thing& thing) {
    return std::hypot(thing.x - track.things[0].x, thing.y - track.things[0].y) > kAtRest * height;
  };
  while (first < track.things.size() && !moved(track.things[first])) ++first;
  while (last + 1 < track.things.size() && track.things[last].y < lowest - kAtRest * height) ++last;
  first = std::max<std::size_t>(first, 1) - 1;
  if (first > last) first = last;
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(last) + 1, values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
  };
  cut(track.frames);
  cut(track.things);
}

bool is_fall(const Track& track, double rate_hz, double height) {
  const std::size_t rows = track.frames.back() - track.frames.front() + 1;
  return rows >= kMinRows && static_cast<double>(rows - 1) >= kMinSeconds * rate_hz &&
         track.things.back().y - track.things.front().y >= kMinDescent * height;
}

// Whether two tracks keep their distance for most of the shorter one: a thing and its shadow, or two parts of it.
bool together(const Track& a, const Track& b, double height) {
  std::vector<double> x, y;
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    const auto at = std::ranges::lower_bound(b.frames, a.frames[k]);
    if (at == b.frames.end() || *at != a.frames[k]) continue;
    const Thing& other = b.things[static_cast<std::size_t>(at - b.frames.begin())];
    x.push_back(a.things[k].x - other.x);
    y.push_back(a.things[k].y - other.y);
  }
  if (2 * x.size() < std::min(a.frames.size(), b.frames.size())) return false;
  const auto spread = [](const std::vector<double>& v) { return std::ranges::max(v) - std::ranges::min(v); };
  return spread(x) <= kApart * height && spread(y) <= kApart * height;
}

double contrast(const Track& track) {
  std::vector<double> values;
  for (const Thing& thing : track.things) values.push_back(thing.contrast);
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void leave_out_shadows(std::vector<Track>& tracks, double height) {
  std::ranges::stable_sort(tracks, std::ranges::greater(), contrast);
  std::vector<Track> kept;
  for (Track& track : tracks) {
    if (std::ranges::none_of(kept, [&](const Track& other) { return together(track, other, height); })) {
      kept.push_back(std::move(track));
    }
  }
  tracks = std::move(kept);
}

// A line is the same turned by half a turn; what is round for a moment points where it pointed before and after.
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

// Frames in which it was not seen lie on a cubic through those around.
Fall fall_of(const Track& track) {
  Fall fall{track.frames.front(), {}, {}};
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

std::vector<Fall> falls_in(std::span<const Seen> frames, double rate_hz, int height) {
  std::vector<Track> tracks = tracks_in(frames, rate_hz, height);
  for (Track& track : tracks) trim(track, height);
  std::erase_if(tracks, [&](const Track& track) { return !is_fall(track, rate_hz, height); });
  leave_out_shadows(tracks, height);
  std::ranges::sort(tracks, {}, [](const Track& track) { return track.frames.front(); });
  std::vector<Fall> falls;
  for (Track& track : tracks) {
    unwrap(track);
    falls.push_back(fall_of(track));
  }
  return falls;
}

}  // namespace wisp::fall
