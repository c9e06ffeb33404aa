// Light from pictures: the camera's curve is undone as ITU-R BT.709-6, item 1.2, says that it was applied.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "wisp/capture/capture.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {
namespace {

double linear_light(double value) { return value < 0.081 ? value / 4.5 : std::pow((value + 0.099) / 1.099, 1 / 0.45); }

// Mean light of a region, black 0 and white 1.
double light_of(const Picture& picture, const Region& region, std::vector<std::uint8_t>& pixels) {
  pixels.resize(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
  extract_channel(picture, PixelChannel::kLuma, region, pixels.data());
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t pixel : pixels) ++count[pixel];
  double sum = 0;
  for (int stored = 0; stored < 256; ++stored) {
    const double value = brightness(picture, PixelChannel::kLuma, stored) / 255;
    sum += static_cast<double>(count[static_cast<std::size_t>(stored)]) * linear_light(std::max(0.0, value));
  }
  return sum / static_cast<double>(pixels.size());
}

}  // namespace

Result<Recording> capture_brightness(const std::filesystem::path& path, const ClipCapture& options,
                                     const Progress& progress) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames});
  if (!reader) return reader.error();
  Channel channel{"brightness", "", Role::kOutput, {}};
  std::vector<std::uint8_t> pixels;
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) break;
    const Picture& picture = (*frame)->picture;
    const Region region = options.region.empty() ? picture.frame() : intersection(options.region, picture.frame());
    if (region.empty())
      return Error{path.string() + ": the region lies outside its picture of " + std::to_string(picture.width) + " x " +
                   std::to_string(picture.height) + " pixels"};
    // Frames that the clip has lost stay missing.
    channel.samples.resize(static_cast<std::size_t>((*frame)->index), std::nan(""));
    channel.samples.push_back(light_of(picture, region, pixels));
    const auto frames = static_cast<double>(std::max<std::int64_t>(1, reader->info().frames));
    const double done = static_cast<double>(channel.samples.size()) / frames;
    if (progress && !progress("measuring", std::min(1.0, done))) return Error{std::string(kStopped)};
  }
  double sum = 0, rows = 0;
  for (const double value : channel.samples) {
    if (std::isnan(value)) continue;
    sum += value;
    rows += 1;
  }
  if (!(sum > 0)) return Error{path.string() + ": is black throughout, there is no light to measure"};
  for (double& value : channel.samples) value /= sum / rows;
  Recording recording{.source = path.string(), .rate_hz = reader->info().rate_hz};
  recording.channels.push_back(std::move(channel));
  return recording;
}

}  // namespace wisp
