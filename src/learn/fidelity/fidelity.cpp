#include "learn/fidelity/fidelity.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/fidelity/fidelity_distance.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/spectrum.hpp"

namespace wisp {
namespace {

constexpr std::size_t kMinRows = 16;
constexpr double kWindowSeconds = 0.5;       // the length of a few flickers
constexpr double kVerbatimTolerance = 0.02;  // in standard deviations of a channel: below what the eye can distinguish

using Stretches = std::vector<Stretch>;

// Lengths of Welch's segments and of windows, rows. A comparison and its two bounds use the same lengths.
struct Lengths {
  double rate_hz = 0;
  std::size_t welch = 0;
  std::size_t window = 0;
};

struct Distances {
  std::vector<double> log_spectral;  // one value per channel
  double energy = kMissing;
};

std::size_t longest(const Stretches& stretches) {
  std::size_t rows = 0;
  for (const Stretch& stretch : stretches) rows = std::max(rows, stretch.rows());
  return rows;
}

FeatureWindows windows_of(const Stretches& stretches, const Lengths& lengths, std::size_t most) {
  // Extracts about twice as many windows as needed and thins them evenly, so that not every window is stored.
  const std::size_t hop = std::max<std::size_t>(1, total_rows(stretches) / (2 * most));
  return thinned(motion_windows(stretches, lengths.window, hop), most);
}

Distances compare(const Stretches& a, const Stretches& b, const Lengths& lengths, const FidelityOptions& options) {
  Distances out;
  for (std::size_t c = 0; c < a.front().channels; ++c) {
    const auto spectrum = [&](const Stretches& side) {
      return welch(channel_of(side, c), lengths.rate_hz, lengths.welch);
    };
    out.log_spectral.push_back(log_spectral_distance(spectrum(a), spectrum(b)));
  }
  FeatureWindows x = windows_of(a, lengths, options.max_windows);
  FeatureWindows y = windows_of(b, lengths, options.max_windows);
  if (x.size() == 0 || y.size() == 0) return out;
  standardise(x, y);
  out.energy = energy_distance(x, y);
  return out;
}

struct Sides {
  std::vector<std::string> names;
  double rate_hz = 0;
  Stretches real;
  Halves halves;  // every other recording, or a single one cut at half its time
  Stretches synthesized;
};

Result<Stretches> all_stretches(std::span<const Recording> recordings, const std::vector<std::string>& names,
                                double rate_hz) {
  Stretches all;
  for (const Recording& recording : recordings) {
    if (recording.rate_hz != rate_hz) {
      return Error{recording.source + ": has " + std::to_string(recording.rate_hz) + " samples a second, the others " +
                   std::to_string(rate_hz) + "; compare recordings of one rate"};
    }
    auto stretches = stretches_of(recording, names);
    if (!stretches) return stretches;
    all.insert(all.end(), std::make_move_iterator(stretches->begin()), std::make_move_iterator(stretches->end()));
  }
  return all;
}

std::vector<std::string> output_names(const Recording& recording) {
  std::vector<std::string> names;
  for (std::size_t c : channels_with_role(recording, Role::kOutput)) names.push_back(recording.channels[c].name);
  return names;
}

Result<void> check_length(const Stretches& stretches, const std::string& what) {
  const std::size_t rows = longest(stretches);
  if (rows >= kMinRows) return {};
  return Error{what + " has " + std::to_string(rows) + " consecutive complete rows at most; fidelity needs at least " +
               std::to_string(kMinRows)};
}

Result<Sides> sides_of(std::span<const Recording> real, std::span<const Recording> synthesized,
                       const FidelityOptions& options) {
  if (real.empty() || synthesized.empty()) return Error{"fidelity needs real and synthesized recordings"};
  Sides sides;
  sides.rate_hz = real.front().rate_hz;
  sides.names = options.channels.empty() ? output_names(real.front()) : options.channels;
  if (sides.names.empty()) return Error{real.front().source + ": has no output channel to compare"};
  for (std::size_t r = 0; r < real.size(); ++r) {
    auto stretches = all_stretches(real.subspan(r, 1), sides.names, sides.rate_hz);
    if (!stretches) return stretches.error();
    sides.real.insert(sides.real.end(), stretches->begin(), stretches->end());
    Stretches& half = r % 2 == 0 ? sides.halves.first : sides.halves.second;
    half.insert(half.end(), stretches->begin(), stretches->end());
  }
  if (real.size() == 1) sides.halves = halves_of(sides.real);
  auto made = all_stretches(synthesized, sides.names, sides.rate_hz);
  if (!made) return made.error();
  sides.synthesized = *std::move(made);
  if (auto ok = check_length(sides.halves.first, real.front().source + ": its first half"); !ok) return ok.error();
  if (auto ok = check_length(sides.halves.second, real.back().source + ": its second half"); !ok) return ok.error();
  if (auto ok = check_length(sides.synthesized, synthesized.front().source); !ok) return ok.error();
  return sides;
}

Lengths lengths_for(const Sides& sides, const FidelityOptions& options) {
  const std::size_t shortest =
      std::min({longest(sides.halves.first), longest(sides.halves.second), longest(sides.synthesized)});
  Lengths lengths;
  lengths.rate_hz = sides.rate_hz;
  lengths.welch = std::min(options.welch_samples, shortest) / 2 * 2;
  lengths.window = std::max<std::size_t>(1, std::lround(kWindowSeconds * sides.rate_hz));
  return lengths;
}

void take_channels(const Sides& sides, const Distances& value, const Distances& floor, const Distances& ceiling,
                   Fidelity& out) {
  const auto n = static_cast<double>(sides.names.size());
  for (std::size_t c = 0; c < sides.names.size(); ++c) {
    const Bounded apart{value.log_spectral[c], floor.log_spectral[c], ceiling.log_spectral[c]};
    out.channels.push_back({sides.names[c], deviation(joined(channel_of(sides.real, c))),
                            deviation(joined(channel_of(sides.synthesized, c))), apart});
    out.log_spectral_distance.value += apart.value / n;
    out.log_spectral_distance.floor += apart.floor / n;
    out.log_spectral_distance.ceiling += apart.ceiling / n;
  }
}

void take_long(const Sides& sides, const Stretches& pieces, const FidelityOptions& options, Fidelity& out) {
  const auto apart = [&](const Stretches& a, const Stretches& b) {
    return long_distances(a, b, sides.rate_hz, options.motion_only);
  };
  const LongDistances value = apart(sides.real, pieces), floor = apart(sides.halves.first, sides.halves.second);
  const LongDistances ceiling = apart(sides.real, shuffled(sides.real, options.seed));
  out.long_motion = {value.motion, floor.motion, ceiling.motion};
  out.long_spectra = {value.spectra, floor.spectra, ceiling.spectra};
  out.tails = {value.tails, floor.tails, ceiling.tails};
}

}  // namespace

Result<Fidelity> fidelity(std::span<const Recording> real, std::span<const Recording> synthesized,
                          const FidelityOptions& options) {
  auto sides = sides_of(real, synthesized, options);
  if (!sides) return sides.error();
  const Lengths lengths = lengths_for(*sides, options);
  const Stretches pieces = cut_to(sides->synthesized, longest(sides->real));
  const Distances value = compare(sides->real, pieces, lengths, options);
  const Distances floor = compare(sides->halves.first, sides->halves.second, lengths, options);
  const Distances ceiling = compare(sides->real, shuffled(sides->real, options.seed), lengths, options);
  Fidelity out;
  take_channels(*sides, value, floor, ceiling, out);
  out.energy_distance = {value.energy, floor.energy, ceiling.energy};
  take_long(*sides, pieces, options, out);
  const auto rows = options.motion_only ? 0 : longest_verbatim_run(sides->real, sides->synthesized, kVerbatimTolerance);
  out.verbatim_seconds = options.motion_only ? kMissing : static_cast<double>(rows) / sides->rate_hz;
  out.welch_samples = lengths.welch;
  return out;
}

}  // namespace wisp
