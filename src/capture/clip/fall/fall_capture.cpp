#include <algorithm>
#include <array>
#include <cmath>

#include "capture/clip/fall/falls.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp {
namespace {

constexpr int kLongSide = 320;       // longer side of the reduced pictures, pixels
constexpr std::uint8_t kMoves = 12;  // grey levels: change between frames from which a pixel counts as moving
constexpr std::size_t kMinFrames = 16;

using fall::Fall;
using fall::Falls;
using fall::Thing;

// Returns the attitude whose second body axis is the object's long axis (along which a leaf glides) and whose third is
// its normal, both in the picture plane (world x and z): a rotation by −90° about z, then by the angle about −y.
std::array<double, 4> attitude(double angle) {
  const double c = std::sqrt(0.5) * std::cos(angle / 2), s = std::sqrt(0.5) * std::sin(angle / 2);
  return {c, s, -s, -c};
}

}  // namespace

FallCapture::FallCapture(ClipSource source, const FallOptions& options)
    : source_(std::move(source)), options_(options) {}

Result<FallCapture> FallCapture::create(const ClipSource& source, const FallOptions& options) {
  if (!(source.rate_hz > 0)) return Error{source.name + ": states no frame rate; give it as --rate"};
  const double height = options.height_metres;
  if (height != 0 && !(height >= 0.01 && height <= 100)) {
    return Error{source.name + ": the picture's height is " + number_text(height, 6) +
                 " m, expected 0.01 to 100: how much of the wall it shows"};
  }
  return FallCapture(source, options);
}

std::vector<std::uint8_t> FallCapture::reduced(const Picture& picture) const {
  const Region region{region_.x, region_.y, width_ * step_, height_ * step_};
  std::vector<std::uint8_t> luma(static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height));
  extract_channel(picture, PixelChannel::kLuma, region, luma.data());
  if (step_ == 1) return luma;
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(width_ * height_), 0);
  for (int y = 0; y < region.height; ++y) {
    const std::uint8_t* row = luma.data() + static_cast<std::ptrdiff_t>(y) * region.width;
    std::uint32_t* sum = sums.data() + static_cast<std::ptrdiff_t>(y / step_) * width_;
    for (int x = 0; x < width_; ++x) {
      for (int k = 0; k < step_; ++k) sum[x] += *row++;
    }
  }
  const auto count = static_cast<std::uint32_t>(step_ * step_);
  std::vector<std::uint8_t> small;
  small.reserve(sums.size());
  for (const std::uint32_t sum : sums) small.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
  return small;
}

Result<void> FallCapture::feed(const Picture& picture) {
  if (frame_.empty()) {
    frame_ = picture.frame();
    region_ = options_.region.empty() ? frame_ : intersection(options_.region, frame_);
    if (region_.width < 16 || region_.height < 16) {
      return Error{source_.name + ": the region has less than 16 x 16 pixels of its picture of " +
                   std::to_string(frame_.width) + " x " + std::to_string(frame_.height)};
    }
    step_ = (std::max(region_.width, region_.height) + kLongSide - 1) / kLongSide;
    width_ = region_.width / step_;
    height_ = region_.height / step_;
  }
  if (picture.frame() != frame_) {
    return Error{source_.name + ": frame " + std::to_string(frames_.size() + 1) + " has " +
                 std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels, expected " +
                 std::to_string(frame_.width) + " x " + std::to_string(frame_.height) + " as the first"};
  }
  const std::size_t most = seen().max_frames;
  if (frames_.size() >= most) {
    return Error{source_.name + ": has more than " + std::to_string(most) +
                 " frames, which do not fit; give films of at most " +
                 number_text(std::floor(static_cast<double>(most) / source_.rate_hz), 4) +
                 " s: a chain is learned from several"};
  }
  frames_.push_back(reduced(picture));
  moving_ = {};
  if (frames_.size() < 2 || frames_[frames_.size() - 2].empty()) return {};
  const auto &now = frames_.back(), &before = frames_[frames_.size() - 2];
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto p = static_cast<std::size_t>(y) * width_ + x;
      if (std::abs(now[p] - before[p]) < kMoves) continue;
      moving_ = enclosing(moving_, {region_.x + x * step_, region_.y + y * step_, step_, step_});
    }
  }
  return {};
}

void FallCapture::lost(int count) {
  if (count > 0) frames_.resize(frames_.size() + static_cast<std::size_t>(count));
}

FallSeen FallCapture::seen() const {
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  return {frames_.size(), pixels == 0 ? 0 : options_.max_bytes / pixels, moving_};
}

Result<Captured> FallCapture::finish() {
  if (frames_.size() < kMinFrames) {
    return Error{source_.name + ": has " + std::to_string(frames_.size()) + " frames, expected at least " +
                 std::to_string(kMinFrames) + ": film the whole fall"};
  }
  const fall::Wall wall = fall::wall_of(frames_, width_, height_);
  std::vector<fall::Seen> seen(frames_.size());
  std::size_t repeated = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    if (frames_[k].empty()) continue;
    // Repeated frames are interpolated: camera or software repeated them, the object did not stand still.
    const bool repeats = k > 0 && frames_[k] == frames_[k - 1];
    repeated += repeats;
    if (!repeats) seen[k] = fall::seen_in(frames_[k], wall);
  }
  Falls found = fall::falls_in(seen, {source_.rate_hz, static_cast<double>(width_), static_cast<double>(height_)});
  const std::vector<Fall>& falls = found.falls;
  if (falls.empty()) return fall::no_fall(source_.name, wall, seen, found);
  const fall::Facts facts = fall::facts_of(falls);
  if (options_.frames) {
    for (Fall& fall : found.falls) fall.first += static_cast<std::size_t>(options_.frames->first - 1);
  }
  Captured out{recorded(falls, facts.tilt()), {}};
  out.report.verdict = fall::verdict_on(found, wall);
  set_verdict(out.recording, out.report.verdict->usable, out.report.verdict->reason);
  if (options_.height_metres == 0) {
    out.report.warnings.push_back(
        "how much of the wall the picture's height shows is not known: 1 m is taken; give it as --height METRES");
  }
  if (auto warning = fall::filled_warning(facts)) out.report.warnings.push_back(*std::move(warning));
  out.report.sections = {fall::frames_section(frames_, repeated, wall, source_.rate_hz),
                         fall::falls_section(found, facts, step_ * metres_per_pixel(), source_.rate_hz)};
  return out;
}

double FallCapture::metres_per_pixel() const {
  return (options_.height_metres > 0 ? options_.height_metres : 1.0) / frame_.height;
}

Recording FallCapture::recorded(const std::vector<Fall>& falls, bool tilt) const {
  Recording recording{.source = source_.name, .rate_hz = source_.rate_hz};
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) recording.channels.push_back({name, "m", Role::kOutput, {}});
  for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) {
    if (tilt) recording.channels.push_back({name, "", Role::kOutput, {}});
  }
  recording.flags.push_back({"filled", {}});
  const double scale = metres_per_pixel();
  for (std::size_t episode = 0; episode < falls.size(); ++episode) {
    const Fall& fall = falls[episode];
    for (std::size_t k = 0; k < fall.rows.size(); ++k) {
      const Thing& thing = fall.rows[k];
      // Pixel centres lie at whole numbers in Thing, but the picture's height is measured from pixel borders.
      const double x = region_.x + (thing.x + 0.5) * step_, y = region_.y + (thing.y + 0.5) * step_;
      recording.channels[0].samples.push_back(scale * (x - 0.5 * frame_.width));
      recording.channels[1].samples.push_back(0);
      recording.channels[2].samples.push_back(scale * (frame_.height - y));
      const auto q = attitude(thing.angle);
      for (std::size_t i = 0; tilt && i < 4; ++i) recording.channels[3 + i].samples.push_back(q[i]);
      recording.flags[0].rows.push_back(fall.filled[k]);
      recording.episode_ids.push_back(static_cast<std::int64_t>(episode));
    }
  }
  return recording;
}

}  // namespace wisp
