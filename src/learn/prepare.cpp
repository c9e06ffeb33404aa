// Sources: L. Ljung, System Identification (2nd ed.), sections 14.1 and 14.4 (drifts, prefiltering of all signals
// alike); F. Gustafsson, IEEE Trans. Signal Processing 44 (1996), for forward-backward filtering.

#include "wisp/learn/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

using Samples = std::vector<double>;

constexpr double kBelow = 0.4;  // cutoff of the low-pass before resampling to a lower rate, as a share of that rate
constexpr std::pair<const char*, double Preparation::*> kFrequencies[] = {{"highpass", &Preparation::highpass_hz},
                                                                          {"lowpass", &Preparation::lowpass_hz},
                                                                          {"resample", &Preparation::resample_hz}};

// One pass of a second-order Butterworth filter.
class Filter {
 public:
  // `share`: frequency that two passes together attenuate by 3 dB, as a share of the sampling rate.
  Filter(double share, bool high) : gain_(high ? 0 : 1) {
    const double two_passes = std::pow(std::numbers::sqrt2 - 1, high ? 0.25 : -0.25);
    const double k = std::tan(std::numbers::pi * share) * two_passes;
    const double scale = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    b_[0] = b_[2] = (high ? 1 : k * k) * scale;
    b_[1] = (high ? -2 : 2) * b_[0];
    a_[0] = 2 * (k * k - 1) * scale;
    a_[1] = (1 - std::numbers::sqrt2 * k + k * k) * scale;
  }

  // Filters in place, starting in steady state at the first sample.
  void pass(Samples& x) const {
    double first = (gain_ - b_[0]) * x.front(), second = (b_[2] - a_[1] * gain_) * x.front();
    for (double& sample : x) {
      const double y = b_[0] * sample + first;
      first = b_[1] * sample - a_[0] * y + second;
      second = b_[2] * sample - a_[1] * y;
      sample = y;
    }
  }

 private:
  double gain_;  // gain at frequency 0
  double a_[2], b_[3];
};

// Filters forward and backward, keeping the mean. Point reflection extends both ends by three cutoff periods.
void filter(Samples& x, double share, bool high) {
  const auto rows = x.size(), more = std::min(rows - 1, static_cast<std::size_t>(3 / share) + 1);
  const double level = high ? mean(x) : 0;
  Samples long_x;
  for (std::size_t k = more; k > 0; --k) long_x.push_back(2 * x.front() - x[k]);
  long_x.insert(long_x.end(), x.begin(), x.end());
  for (std::size_t k = 1; k <= more; ++k) long_x.push_back(2 * x.back() - x[rows - 1 - k]);
  const Filter one(share, high);
  for (int direction = 0; direction < 2; ++direction) {
    one.pass(long_x);
    std::reverse(long_x.begin(), long_x.end());
  }
  for (std::size_t k = 0; k < rows; ++k) x[k] = long_x[k + more] + level;
}

// Replaces missing samples by linear interpolation between their neighbours, at the ends by the nearest sample.
Samples bridged(const Samples& x) {
  Samples out = x;
  std::size_t before = x.size();
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (std::isnan(x[t])) continue;
    for (std::size_t k = before == x.size() ? 0 : before + 1; k < t; ++k) {
      out[k] = before == x.size() ? x[t] : std::lerp(x[before], x[t], double(k - before) / double(t - before));
    }
    before = t;
  }
  for (std::size_t k = before + 1; k < x.size(); ++k) out[k] = x[before];
  return out;
}

void take_line_off(Samples& x) {
  double rows = 0, time = 0, square = 0, product = 0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (!std::isnan(x[t])) rows += 1, time += double(t);
  }
  for (std::size_t t = 0; t < x.size(); ++t) {
    const double away = double(t) - time / rows;
    if (!std::isnan(x[t])) square += away * away, product += away * x[t];
  }
  for (std::size_t t = 0; square > 0 && t < x.size(); ++t) x[t] -= product / square * (double(t) - time / rows);
}

// Value at `place` rows from the first: Catmull-Rom cubic through four samples, linear beside missing samples.
double between(const Samples& x, double place) {
  constexpr double kOn = 1e-9;  // rows: tolerance for a place on a sample
  const auto row = std::min(static_cast<std::size_t>(place + kOn), x.size() - 1);
  const double share = place - double(row);
  if (share < kOn || row + 1 == x.size()) return x[row];
  const double from = x[row], to = x[row + 1];
  const double line = from + share * (to - from);
  if (row == 0 || row + 2 >= x.size() || std::isnan(x[row - 1] + x[row + 2])) return line;
  const double leaving = (to - x[row - 1]) / 2 - (to - from), arriving = (to - from) - (x[row + 2] - from) / 2;
  return line + share * (1 - share) * (leaving * (1 - share) + arriving * share);
}

Result<void> check_preparation(const Recording& recording, const Preparation& preparation) {
  const double rate = recording.rate_hz, resampled = preparation.resample_hz;
  for (const auto& [word, member] : kFrequencies) {
    const double hz = preparation.*member;
    const double most = member == &Preparation::resample_hz ? 100 * rate : 0.499 * rate;
    if (hz >= 0 && hz <= most) continue;
    return Error{recording.source + ": cannot be prepared by " + word + ":" + number_text(hz, 6) + ", expected up to " +
                 number_text(most, 4) + " Hz at its rate of " + number_text(rate, 6) + " Hz"};
  }
  if (preparation.lowpass_hz > 0 && preparation.highpass_hz >= preparation.lowpass_hz) {
    return Error{recording.source + ": nothing is left between highpass:" + number_text(preparation.highpass_hz, 6) +
                 " and lowpass:" + number_text(preparation.lowpass_hz, 6)};
  }
  for (const Episode& episode : episodes(recording)) {
    if (resampled == 0 || double(episode.size() - 1) * resampled >= rate) continue;
    return Error{recording.source + ": an episode of " + number_text(double(episode.size()) / rate, 4) +
                 " s has no two samples at " + number_text(resampled, 6) + " Hz"};
  }
  return {};
}

// Prepares one channel of one episode, at the recording's rate.
void prepare_samples(Samples& x, const Preparation& preparation, double rate_hz) {
  if (preparation.detrend) take_line_off(x);
  double low = preparation.lowpass_hz;
  const double resampled = preparation.resample_hz;
  if (resampled > 0 && resampled < rate_hz) low = std::min(low > 0 ? low : rate_hz, kBelow * resampled);
  const bool any = std::any_of(x.begin(), x.end(), [](double one) { return !std::isnan(one); });
  if (!any || (low == 0 && preparation.highpass_hz == 0)) return;
  Samples whole = bridged(x);
  if (low > 0) filter(whole, low / rate_hz, false);
  if (preparation.highpass_hz > 0) filter(whole, preparation.highpass_hz / rate_hz, true);
  for (std::size_t t = 0; t < x.size(); ++t) x[t] = std::isnan(x[t]) ? kMissing : whole[t];
}

}  // namespace

Result<Preparation> parse_preparation(const std::vector<std::string>& words) {
  Preparation out;
  for (const std::string& text : words) {
    const std::string word = text.substr(0, text.find(':'));
    double hz = 0;
    const char* const end = text.data() + text.size();
    const bool number = word.size() < text.size() && read_number(text.data() + word.size() + 1, end, hz).ptr == end;
    const auto* found = std::find_if(std::begin(kFrequencies), std::end(kFrequencies),
                                     [&](const auto& one) { return one.first == word; });
    const bool known = found != std::end(kFrequencies) && number && std::isfinite(hz) && hz > 0;
    if ((text == "detrend" && out.detrend) || (known && out.*(found->second) > 0)) {
      return Error{"\"" + word + "\" is there twice"};
    }
    if (!known && text != "detrend") {
      return Error{"found \"" + text + "\", expected detrend, highpass:HZ, lowpass:HZ or resample:HZ"};
    }
    if (known) out.*(found->second) = hz;
    out.detrend |= !known;
  }
  return out;
}

std::string text_of(const Preparation& preparation) {
  std::string text = preparation.detrend ? ",detrend" : "";
  for (const auto& [word, member] : kFrequencies) {
    if (preparation.*member > 0) text += "," + std::string(word) + ":" + number_text(preparation.*member);
  }
  return text.empty() ? text : text.substr(1);
}

Result<Recording> prepare(const Recording& recording, const Preparation& preparation) {
  if (preparation == Preparation{}) return recording;
  if (auto ok = check_preparation(recording, preparation); !ok) return ok.error();
  const double rate = preparation.resample_hz > 0 ? preparation.resample_hz : recording.rate_hz;
  const double step = recording.rate_hz / rate;
  Recording out = slice(recording, 0, 0);
  out.rate_hz = rate;
  out.first_row = static_cast<std::size_t>(std::llround(double(recording.first_row) / step));
  for (const Episode& episode : episodes(recording)) {
    const auto rows = static_cast<std::size_t>(double(episode.size() - 1) / step + 1e-9) + 1;
    for (std::size_t c = 0; c < out.channels.size(); ++c) {
      const auto begin = recording.channels[c].samples.begin();
      Samples x(begin + std::ptrdiff_t(episode.begin), begin + std::ptrdiff_t(episode.end));
      prepare_samples(x, preparation, recording.rate_hz);
      for (std::size_t row = 0; row < rows; ++row) out.channels[c].samples.push_back(between(x, double(row) * step));
    }
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t nearest = std::min(episode.begin + std::size_t(double(row) * step + 0.5), episode.end - 1);
      for (std::size_t f = 0; f < out.flags.size(); ++f) out.flags[f].rows.push_back(recording.flags[f].rows[nearest]);
      if (!recording.episode_ids.empty()) out.episode_ids.push_back(recording.episode_ids[nearest]);
    }
  }
  return out;
}

Result<std::vector<Recording>> prepare_all(std::span<const Recording> recordings, const Preparation& preparation) {
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    auto prepared = prepare(one, preparation);
    if (!prepared) return prepared.error();
    out.push_back(std::move(*prepared));
  }
  return out;
}

}  // namespace wisp
