// Estimates wind from any samples, with any calibration: frames are finite and within their ranges, and do not depend
// on how the sound is cut into blocks.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "fuzz/source.hpp"
#include "wisp/sound/wind_level.hpp"

namespace {

using wisp::WindFrame;
using wisp::WindLevel;

void expect_sound(const WindFrame& frame) {
  for (float x : {frame.rms, frame.rms_clean, frame.level, frame.speed, frame.wind, frame.background}) {
    if (!(x >= 0 && x < 1e30f)) std::abort();
  }
  for (float x : {frame.confidence, frame.clipped}) {
    if (!(x >= 0 && x <= 1)) std::abort();
  }
}

std::vector<WindFrame> feed(WindLevel& level, std::span<const float> samples, std::size_t block, std::size_t room) {
  std::vector<WindFrame> out, frames(room);
  while (!samples.empty()) {
    const auto part = samples.first(std::min(block, samples.size()));
    const wisp::WindFed fed = level.feed(part, frames);
    if (fed.samples == 0 && fed.frames == 0) std::abort();
    out.insert(out.end(), frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(fed.frames));
    samples = samples.subspan(fed.samples);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wisp::fuzz::Source source(data, size);
  static constexpr double kRates[] = {8000, 16000, 44100, 48000, 192000};
  const wisp::SoundFormat format{kRates[source.take<std::uint8_t>() % 5], 1 + source.take<std::uint8_t>() % 2};
  const wisp::WindOptions options{.frame_rate_hz = 1.0 + source.take<std::uint8_t>() * 3.9,
                                  .exponent = 0.1 + source.take<std::uint8_t>() * 0.007,
                                  .smoothing_seconds = source.take<std::uint8_t>() / 255.0,
                                  .floor_rise_db_per_second = source.take<std::uint8_t>() / 4.25};
  auto whole = WindLevel::create(format, options), cut = WindLevel::create(format, options);
  if (!whole || !cut) std::abort();
  if (source.take<std::uint8_t>() % 4 == 0) {
    const auto amplitude = [&] { return static_cast<float>(source.take<std::uint8_t>()) / 32.0f; };
    const wisp::WindCalibration known{amplitude(), amplitude(),
                                      -200.0f + static_cast<float>(source.take<std::uint8_t>()) * 0.9f, amplitude()};
    whole->set_calibration(known);
    cut->set_calibration(known);
  }
  if (const auto ask = source.take<std::uint8_t>() % 8; ask < 2) {
    const double seconds = source.take<float>();
    whole->calibrate(static_cast<wisp::WindAsk>(ask), seconds);
    cut->calibrate(static_cast<wisp::WindAsk>(ask), seconds);
  }
  const std::size_t block = static_cast<std::size_t>(format.channels) * (1 + source.take<std::uint8_t>());
  const auto manner = source.take<std::uint8_t>();
  const bool loud = manner % 2 == 0;
  const std::size_t most = manner / 2 % 32 == 0 ? 40'000 : 3'000;  // long sound is slow
  std::vector<float> samples;
  for (const auto rest = source.rest(); samples.size() < most && !rest.empty();) {
    // A short input is repeated, so that it is long enough for frames.
    for (std::size_t k = 0; k + 4 <= rest.size() + 3 && samples.size() < most; k += 4) {
      std::uint8_t bytes[4] = {};
      std::memcpy(bytes, rest.data() + k, std::min<std::size_t>(4, rest.size() - k));
      float any;
      std::memcpy(&any, bytes, 4);
      samples.push_back(loud ? any : static_cast<float>(static_cast<std::int8_t>(bytes[0])) / 128.0f);
    }
  }
  samples.resize(samples.size() / static_cast<std::size_t>(format.channels) *
                 static_cast<std::size_t>(format.channels));
  const auto a = feed(*whole, samples, samples.size() + 2, 64), b = feed(*cut, samples, block, 1);
  if (a.size() != b.size()) std::abort();
  for (std::size_t k = 0; k < a.size(); ++k) {
    expect_sound(a[k]);
    if (a[k].index != b[k].index || std::memcmp(&a[k].rms, &b[k].rms, 8 * sizeof(float)) != 0) std::abort();
  }
  return 0;
}
