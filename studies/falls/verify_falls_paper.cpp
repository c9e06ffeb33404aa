// Real discs and squares of paper: half of the drops are learned from, positions only, and the falls that the chain
// makes are held against the other half, in fall time, end place aside and stall rate. What two halves of the real
// drops differ by is the measure.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <random>
#include <sstream>

#include "learn/chain/chain_fidelity.hpp"
#include "studies/falls/verify_falls.hpp"

namespace wisp::verify {
namespace {

constexpr double kCameraRate = 98;
constexpr int kSmoothRows = 9;  // the tracks' noise is a millimetre
constexpr double kMinRows = 20;
constexpr int kSplits = 200;  // of twenty, means are off by 2 % by chance
constexpr int kHalvings = 2000;
constexpr double kLongestFall = 4;  // seconds: a synthesized fall that has not come down by then is cut there

std::filesystem::path tracks_path(const std::string& shape) {
  const char* set = std::getenv("WISP_DATA");
  const auto folder =
      set ? std::filesystem::path(set) : std::filesystem::path(WISP_SOURCE_DIR) / ".." / "shared" / "data";
  return folder / "falling" / ("falling_paper_" + shape + ".csv");
}

SegmentationOptions stalls() { return {.event = {EventKind::kMinimum, "horizontal_speed"}}; }

Recording empty_track(const std::string& source) {
  Recording track;
  track.source = source;
  track.rate_hz = kCameraRate;
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) track.channels.push_back({name, "m", Role::kOutput, {}});
  return track;
}

std::vector<Recording> real_tracks(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::map<int, Recording> tracks;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    int drop = 0;
    double frame = 0, seconds = 0, place[3] = {};
    cells >> drop >> frame >> seconds >> place[0] >> place[1] >> place[2];
    Recording& track = tracks.try_emplace(drop, empty_track("drop " + std::to_string(drop))).first->second;
    for (std::size_t axis = 0; axis < 3; ++axis) track.channels[axis].samples.push_back(place[axis]);
  }
  std::vector<Recording> out;
  for (auto& [drop, track] : tracks) out.push_back(std::move(track));
  return out;
}

/// A fall from a stall to the floor.
struct Fall {
  double height = 0;
  double seconds = 0;
  double aside = 0;
  double stalls = 0;  ///< a second
};

/// The stalls of every piece, in rows.
std::vector<std::vector<double>> stalls_of(const Motion& motion, std::span<const Recording> recordings) {
  const auto cut = segment(motion, recordings, stalls());
  if (!cut) give_up(cut.error());
  std::vector<std::vector<double>> events(motion.pieces.size());
  for (const Segment& one : cut->segments) {
    if (events[one.piece].empty()) events[one.piece].push_back(one.begin);
    events[one.piece].push_back(one.end);
  }
  return events;
}

Motion moved(std::span<const Recording> recordings) {
  auto motion = motion_of(recordings, kSmoothRows);
  if (!motion) give_up(motion.error());
  return std::move(*motion);
}

/// Rows [from, to] of a recording, where it has fallen by a height.
Recording fallen(const Recording& track, std::size_t from, double height) {
  const auto& z = track.channels[2].samples;
  std::size_t row = from;
  while (row + 1 < z.size() && z[from] - z[row] < height) ++row;
  return slice(track, from, row + 1);
}

/// Recordings that begin at a stall and end on the floor. Real ones and synthesized ones are cut first and looked at
/// then: a stall that nothing follows is not seen in either.
std::vector<Fall> falls_of(std::span<const Recording> cut) {
  const Motion motion = moved(cut);
  const auto events = stalls_of(motion, cut);
  std::vector<Fall> falls;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) {
    const Triple &start = motion.pieces[k].position.front(), &end = motion.pieces[k].position.back();
    const double seconds = static_cast<double>(motion.pieces[k].rows() - 1) / kCameraRate;
    falls.push_back({start[2] - end[2], seconds, std::hypot(end[0] - start[0], end[1] - start[1]),
                     static_cast<double>(events[k].size()) / seconds});
  }
  return falls;
}

/// Real drops that have two stalls: only those can be learned from, and only from the first one on are they compared.
struct RealDrop {
  Recording track;
  Fall fall;
};

std::vector<RealDrop> real_drops(const std::vector<Recording>& tracks) {
  const Motion motion = moved(tracks);
  const auto events = stalls_of(motion, tracks);
  std::vector<Recording> whole, cut;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) {
    // What is left of a drop must be long enough to be looked at.
    if (events[k].empty() || events[k].front() + kMinRows > static_cast<double>(motion.pieces[k].rows())) continue;
    whole.push_back(tracks[motion.pieces[k].recording]);
    cut.push_back(fallen(whole.back(), static_cast<std::size_t>(std::lround(events[k].front())), 1e9));
  }
  const auto falls = falls_of(cut);
  std::vector<RealDrop> drops;
  for (std::size_t k = 0; k < falls.size(); ++k) drops.push_back({std::move(whole[k]), falls[k]});
  return drops;
}

std::vector<Fall> synthesized(const Model& model, std::span<const Fall> like, std::uint64_t seed) {
  const auto rows = static_cast<std::size_t>(kLongestFall * kCameraRate);
  auto made = made_falls(model, std::vector<std::size_t>(like.size(), rows), seed);
  if (!made) give_up(made.error());
  for (std::size_t k = 0; k < like.size(); ++k) made->falls[k] = fallen(made->falls[k], 0, like[k].height);
  return falls_of(made->falls);
}

struct Figure {
  const char* name;
  double Fall::*value;
};
constexpr Figure kFigures[] = {
    {"fall time, s", &Fall::seconds}, {"aside, m", &Fall::aside}, {"stalls a second", &Fall::stalls}};

std::vector<double> values_of(std::span<const Fall> falls, const Figure& figure) {
  std::vector<double> out;
  for (const Fall& fall : falls) out.push_back(fall.*figure.value);
  std::sort(out.begin(), out.end());
  return out;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Wasserstein-1 of two sorted samples.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr int kSteps = 200;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double share = (k + 0.5) / kSteps;
    const auto at = [&](const std::vector<double>& values) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size()))];
    };
    sum += std::abs(at(a) - at(b)) / kSteps;
  }
  return sum;
}

/// How far two samples are apart, in their means and in all of their values.
struct Apart {
  double means = 0;
  double values = 0;
};

Apart apart(std::span<const Fall> a, std::span<const Fall> b, const Figure& figure) {
  const auto x = values_of(a, figure), y = values_of(b, figure);
  return {std::abs(mean_of(x) - mean_of(y)), distance(x, y)};
}

// What two random halves of the real drops differ by, but for one time in twenty.
Apart real_to_real(std::vector<Fall> falls, const Figure& figure, std::mt19937_64& random) {
  std::vector<double> means, values;
  const auto half = falls.size() / 2;
  for (int k = 0; k < kHalvings; ++k) {
    std::shuffle(falls.begin(), falls.end(), random);
    const Apart found = apart(std::span(falls).first(half), std::span(falls).subspan(half), figure);
    means.push_back(found.means);
    values.push_back(found.values);
  }
  const auto most = static_cast<std::size_t>(0.95 * kHalvings);
  std::sort(means.begin(), means.end());
  std::sort(values.begin(), values.end());
  return {means[most], values[most]};
}

/// One split: what was held out, and what a chain of the others plays.
struct Trial {
  std::vector<Fall> held_out;
  std::vector<Fall> learned;
  std::vector<Fall> played;
};

Trial trial_of(std::vector<RealDrop> drops, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::shuffle(drops.begin(), drops.end(), random);
  const std::size_t half = drops.size() / 2;
  std::vector<Recording> told;
  Trial trial;
  for (std::size_t k = 0; k < drops.size(); ++k) {
    (k < half ? trial.learned : trial.held_out).push_back(drops[k].fall);
    if (k < half) told.push_back(std::move(drops[k].track));
  }
  const auto fit = fit_chain(told, {.modes = 4, .smooth_rows = kSmoothRows, .holdout = 0});
  if (!fit) give_up(fit.error());
  trial.played = synthesized(fit->model, trial.held_out, seed);
  return trial;
}

// In how many trials one side is no farther from what was held out than real halves are apart.
struct Within {
  int means = 0;
  int values = 0;
};

Within within(std::span<const Trial> trials, std::vector<Fall> Trial::*side, const Figure& figure,
              const Apart& chance) {
  Within out;
  for (const Trial& trial : trials) {
    const Apart found = apart(trial.*side, trial.held_out, figure);
    out.means += found.means <= chance.means ? 1 : 0;
    out.values += found.values <= chance.values ? 1 : 0;
  }
  return out;
}

double mean_over(std::span<const Trial> trials, std::vector<Fall> Trial::*side, const Figure& figure) {
  double sum = 0;
  for (const Trial& trial : trials) sum += mean_of(values_of(trial.*side, figure));
  return sum / static_cast<double>(trials.size());
}

// One figure of all trials beside what real halves differ by.
void judge(const std::string& shape, const Figure& figure, std::span<const Trial> trials, const Apart& chance,
           Bounds& bounds) {
  Apart mean;
  for (const Trial& trial : trials) {
    const Apart found = apart(trial.played, trial.held_out, figure);
    mean.means += found.means / kSplits;
    mean.values += found.values / kSplits;
  }
  const double real = mean_over(trials, &Trial::held_out, figure), made = mean_over(trials, &Trial::played, figure);
  const double off = 100 * (made / real - 1);
  const Within played = within(trials, &Trial::played, figure, chance),
               learned = within(trials, &Trial::learned, figure, chance);
  std::printf(
      "  %-16s real %.3f, synthesized %.3f (%+.1f %%); means apart by %.3f (halves of the real ones: %.3f in 95 %%), "
      "within in %d of %d (the learned half itself: %d); values by %.3f (%.3f), within in %d (%d)\n",
      figure.name, real, made, off, mean.means, chance.means, played.means, kSplits, learned.means, mean.values,
      chance.values, played.values, learned.values);
  const std::string name = shape + ": " + figure.name;
  bounds.at_most(name + ": off by %", std::abs(off), 5);
  bounds.at_most(name + ": means apart, over what real halves differ by", mean.means / chance.means, 1);
  bounds.at_most(name + ": values apart, over what real halves differ by", mean.values / chance.values, 1);
}

void compare(const std::string& shape, Bounds& bounds) {
  const auto path = tracks_path(shape);
  if (!std::filesystem::exists(path)) {
    std::printf("\nskipped: real drops, there is no %s\n", path.string().c_str());
    return;
  }
  const auto drops = real_drops(real_tracks(path));
  std::vector<Fall> real;
  for (const RealDrop& drop : drops) real.push_back(drop.fall);
  std::vector<Trial> trials;
  for (int k = 1; k <= kSplits; ++k) trials.push_back(trial_of(drops, static_cast<std::uint64_t>(k)));
  std::printf("\n%zu real %ss with two stalls, from the first one on; %d times half of them learned, half held out\n",
              drops.size(), shape.c_str(), kSplits);
  std::mt19937_64 random(1);
  for (const Figure& figure : kFigures) judge(shape, figure, trials, real_to_real(real, figure, random), bounds);
}

}  // namespace

void paper(Bounds& bounds) {
  for (const char* shape : {"circle", "square"}) compare(shape, bounds);
}

}  // namespace wisp::verify
