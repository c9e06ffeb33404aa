#include "ear.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::window {
namespace {

// Wind frames a second: twice a screen's, so that waiting for the end of one costs half a frame at most.
constexpr double kWindRate = 120;

}  // namespace

Result<void> Ear::open(const SoundFormat& format, std::optional<WindCalibration> known) {
  auto level = WindLevel::create(format, {.frame_rate_hz = kWindRate});
  if (!level) return level.error();
  level_.emplace(std::move(*level));
  if (known) level_->set_calibration(*known);
  return {};
}

void Ear::close(EarState state) {
  level_.reset();
  closed_ = state;
}

void Ear::hear(std::span<const float> samples) {
  if (!level_) return;
  std::array<WindFrame, 64> frames;
  while (!samples.empty()) {
    const WindFed fed = level_->feed(samples, frames);
    if (fed.samples == 0 && fed.frames == 0) return;
    samples = samples.subspan(fed.samples);
  }
}

float Ear::wind() const { return level_ ? level_->latest().wind : 0.0F; }

float Ear::loudness() const {
  if (!level_) return 0;
  // 60 dB below full scale and less is an empty meter.
  const float rms = std::max(level_->latest().rms, 1e-6F);
  return std::clamp(1 + 20 * std::log10(rms) / 60, 0.0F, 1.0F);
}

EarState Ear::state() const { return level_ ? EarState::kListening : closed_; }

std::optional<WindCalibration> Ear::calibration() const {
  if (!level_) return {};
  return level_->calibration();
}

Result<SoundFile> SoundFile::open(const std::string& path) {
  auto sound = read_wav(path);
  if (!sound) return sound.error();
  SoundFile file;
  file.format_ = {.rate_hz = sound->format.rate_hz, .channels = sound->format.channels};
  file.samples_ = std::move(sound->samples);
  if (file.samples_.empty()) return Error{path + ": holds no samples; expected the sound of blowing"};
  return file;
}

std::span<const float> SoundFile::until(double seconds, int block) {
  const auto channels = static_cast<std::size_t>(format_.channels);
  const auto blocks = static_cast<std::size_t>(std::max(0.0, seconds * format_.rate_hz / block + 1e-9));
  const std::size_t end = std::min(samples_.size(), blocks * static_cast<std::size_t>(block) * channels);
  if (end <= taken_) return {};
  const std::span<const float> fresh(samples_.data() + taken_, end - taken_);
  taken_ = end;
  return fresh;
}

}  // namespace wisp::window
