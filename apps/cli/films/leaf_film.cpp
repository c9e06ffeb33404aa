#include "films/leaf_film.hpp"

#include "reports/learned_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "wisp/draw/overlay.hpp"
#include "wisp/draw/video_writer.hpp"

namespace wisp::cli {
namespace {

constexpr double kMaxFramesASecond = 60;
constexpr double kRestSeconds = 2.2;     // time at rest on the floor
constexpr double kFadeSeconds = 0.6;     // fade at the end of the rest
constexpr double kSettleSeconds = 0.12;  // transition from the landing pose to lying flat
constexpr double kTrailSeconds = 0.9;
constexpr double kRounding = 1e-6;        // tolerance for rounding, rows
constexpr float kShownLarger = 1.8F;      // magnification: a leaf in a room is only a few pixels
constexpr double kStaggerSeconds = 0.45;  // delay between the first falls of two leaves

using PoseColumns = std::array<const std::vector<double>*, 7>;

Result<PoseColumns> pose_columns(const Recording& recording) {
  PoseColumns columns{};
  std::size_t k = 0;
  for (const char* name : {"pos.x", "pos.y", "pos.z", "q.w", "q.x", "q.y", "q.z"}) {
    const auto found = find_channel(recording, name);
    if (!found)
      return Error{recording.source + ": has no channel " + name +
                   ", expected pos.x pos.y pos.z q.w q.x q.y q.z; only poses can be drawn as leaves"};
    columns[k++] = &recording.channels[*found].samples;
  }
  return columns;
}

LeafPose pose_at(const PoseColumns& columns, std::size_t row) {
  const auto at = [&](std::size_t k) { return static_cast<float>((*columns[k])[row]); };
  return {{at(0), at(1), at(2)}, {at(3), at(4), at(5), at(6)}};
}

// Returns a landed pose laid flat on the floor, with the same side up and the same heading of the midrib.
LeafPose lying(const LeafPose& landed) {
  const auto& q = landed.attitude;
  const bool face_up = 1 - 2 * (q[1] * q[1] + q[2] * q[2]) >= 0;
  const float heading = std::atan2(2 * (q[1] * q[2] + q[0] * q[3]), 1 - 2 * (q[2] * q[2] + q[3] * q[3])) / 2;
  LeafPose pose = landed;
  pose.attitude = {std::cos(heading), 0, 0, std::sin(heading)};
  if (!face_up) pose.attitude = {0, std::cos(heading), std::sin(heading), 0};
  return pose;
}

// Interpolates between two attitudes along the shorter rotation.
LeafPose between(const LeafPose& a, const LeafPose& b, float share) {
  float along = 0;
  for (std::size_t k = 0; k < 4; ++k) along += a.attitude[k] * b.attitude[k];
  LeafPose pose = b;
  for (std::size_t k = 0; k < 4; ++k)
    pose.attitude[k] = (1 - share) * a.attitude[k] + (along < 0 ? -share : share) * b.attitude[k];
  return pose;
}

// One fall from the top to the floor: a range of rows of an episode, and its shift into the room.
struct Fall {
  std::size_t first = 0, last = 0;  // rows of the start and of the landing (or the episode's last)
  bool lands = false;
  double begins = 0;  // start in the video, seconds
  std::array<float, 3> shift{};
};

// Cuts an episode into falls, each centred over `place`.
std::vector<Fall> falls_of(const PoseColumns& columns, const Episode& episode, double rate, float metres, Point place,
                           double begins) {
  std::vector<Fall> falls;
  for (std::size_t row = episode.begin; row + 1 < episode.end;) {
    const LeafPose start = pose_at(columns, row);
    Fall fall{row, row, false, begins, {}};
    float low_x = start.position[0], high_x = low_x, low_y = start.position[1], high_y = low_y;
    while (fall.last + 1 < episode.end && !fall.lands) {
      const LeafPose pose = pose_at(columns, ++fall.last);
      low_x = std::min(low_x, pose.position[0]), high_x = std::max(high_x, pose.position[0]);
      low_y = std::min(low_y, pose.position[1]), high_y = std::max(high_y, pose.position[1]);
      fall.lands = pose.position[2] <= start.position[2] - metres;
    }
    fall.shift = {place.x - (low_x + high_x) / 2, place.y - (low_y + high_y) / 2, metres - start.position[2]};
    falls.push_back(fall);
    begins += static_cast<double>(fall.last - row) / rate + kSettleSeconds;  // until this leaf lies flat
    row = fall.last + 1;
  }
  return falls;
}

constexpr float kSideways = 0.38F;  // sideways extent of most falls, metres

// Returns the maximum distance of a start from the middle that keeps most falls in the picture.
float reach_of(const LeafFilmOptions& options) {
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  return std::max(0.0F, 0.55F * options.fall_metres * aspect - kSideways);
}

class Film {
 public:
  Film(const Recording& recording, const PoseColumns& columns, const LeafFilmOptions& options)
      : columns_(columns), rate_(recording.rate_hz) {
    const std::vector<Episode> all = episodes(recording);
    const std::size_t count = std::min(all.size(), static_cast<std::size_t>(options.max_leaves));
    for (std::size_t k = 0; k < count; ++k) {
      const float across = count > 1 ? 2 * static_cast<float>(k) / static_cast<float>(count - 1) - 1 : 0;
      // Neighbours start at different times and at one of three depths.
      const Point place{reach_of(options) * across, 0.16F * static_cast<float>(static_cast<int>(k * 2 % 3) - 1)};
      const double begins = kStaggerSeconds * static_cast<double>(k * 3 % count);
      for (const Fall& fall : falls_of(columns, all[k], rate_, options.fall_metres, place, begins))
        falls_.push_back(fall);
    }
  }

  // Returns the leaves in the air or on the floor at a time of the video.
  std::vector<FlockLeaf> at(double seconds) {
    trails_.clear();
    trails_.reserve(falls_.size());
    std::vector<FlockLeaf> leaves;
    for (const Fall& fall : falls_) {
      const double since = seconds - fall.begins;
      const double lasts = static_cast<double>(fall.last - fall.first) / rate_;
      if (since < 0 || since > lasts + (fall.lands ? kRestSeconds : 0)) continue;
      leaves.push_back(since < lasts ? flying(fall, since) : resting(fall, since - lasts));
    }
    return leaves;
  }

 private:
  LeafPose placed(const Fall& fall, std::size_t row) const {
    LeafPose pose = pose_at(columns_, row);
    for (std::size_t k = 0; k < 3; ++k) pose.position[k] += fall.shift[k];
    pose.position[2] = std::max(pose.position[2], 0.004F);
    return pose;
  }

  FlockLeaf flying(const Fall& fall, double since) {
    // Without the tolerance, rounding could show a row twice and skip the next one.
    const auto row = std::min(fall.last, fall.first + static_cast<std::size_t>(since * rate_ + kRounding));
    const auto back = static_cast<std::size_t>(kTrailSeconds * rate_);
    std::vector<LeafPose> trail;
    for (std::size_t k = std::max(fall.first + back, row) - back; k <= row; ++k) trail.push_back(placed(fall, k));
    trails_.push_back(std::move(trail));
    const auto coming = static_cast<float>(std::min(1.0, since / 0.2));
    return {.pose = placed(fall, row), .size = kShownLarger, .opacity = coming, .trail = trails_.back()};
  }

  FlockLeaf resting(const Fall& fall, double since) const {
    const LeafPose landed = placed(fall, fall.last);
    const float share = static_cast<float>(std::min(1.0, since / kSettleSeconds));
    const float left = static_cast<float>(std::clamp((kRestSeconds - since) / kFadeSeconds, 0.0, 1.0));
    return {.pose = between(landed, lying(landed), share), .size = kShownLarger, .opacity = left};
  }

  const PoseColumns& columns_;
  double rate_;
  std::vector<Fall> falls_;
  std::vector<std::vector<LeafPose>> trails_;
};

double longest_episode(const Recording& recording) {
  std::size_t rows = 0;
  for (const Episode& episode : episodes(recording)) rows = std::max(rows, episode.size());
  return static_cast<double>(rows) / recording.rate_hz;
}

// One panel of a film: the room from its camera, and the leaves.
class Side {
 public:
  Side(const LeafPanel& panel, const PoseColumns& columns, const LeafFilmOptions& options)
      : options_(options),
        columns_(columns),
        caption_(panel.caption),
        painter_(2 * options.width, 2 * options.height, leaf_camera_from_side(1.1F * options.fall_metres),
                 options.style),
        film_(*panel.recording, columns_, options_) {}
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  void draw(double seconds, Image& frame, int left) {
    painter_.draw(twice_, film_.at(seconds));  // drawn at twice the size, as edges of leaves are not antialiased
    Image image = resized(twice_, options_.width, options_.height);
    if (!caption_.empty()) draw_label(image, caption_, Corner::kTopLeft);
    for (int y = 0; y < image.height(); ++y) std::ranges::copy(image.row(y), frame.row(y).begin() + left);
  }

 private:
  LeafFilmOptions options_;
  PoseColumns columns_;
  std::string caption_;
  LeafFlock painter_;
  Image twice_;
  Film film_;  // refers to columns_
};

// Draws a line between two panels.
void divide(Image& image, int x) {
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y).begin() + x - 1, 2, 0xFFFFFFFFU);
}

}  // namespace

Result<void> check_film_name(const std::string& path) {
  if (std::filesystem::path(path).extension() != ".mp4") {
    return Error{path + ": cannot be written, expected a name that ends in .mp4"};
  }
  return check_writable(path);
}

Result<void> write_leaf_film(const std::filesystem::path& path, const Recording& recording,
                             const LeafFilmOptions& options, Terminal& terminal) {
  const LeafPanel panel{&recording, {}};
  return write_leaf_films(path, std::span(&panel, 1), options, terminal);
}

Result<void> write_leaf_films(const std::filesystem::path& path, std::span<const LeafPanel> panels,
                              const LeafFilmOptions& options, Terminal& terminal) {
  const double own_rate = panels.front().recording->rate_hz;
  LeafFilmOptions narrow = options;
  narrow.width = options.width / static_cast<int>(panels.size());
  if (panels.size() > 1) narrow.max_leaves = std::max(1, options.max_leaves * 3 / 5);
  std::vector<std::unique_ptr<Side>> sides;
  double longest = 0;
  for (const LeafPanel& panel : panels) {
    const auto columns = pose_columns(*panel.recording);
    if (!columns) return columns.error();
    if (panel.recording->rate_hz != own_rate) {
      return Error{panel.recording->source + ": has another rate than " + panels.front().recording->source +
                   ", expected the same to film both side by side"};
    }
    longest = std::max(longest, longest_episode(*panel.recording));
    sides.push_back(std::make_unique<Side>(panel, *columns, narrow));
  }
  const double rate = std::min(kMaxFramesASecond, own_rate);
  const int width = narrow.width * static_cast<int>(panels.size());
  auto video = VideoWriter::create(path, {.width = width, .height = options.height, .rate_hz = rate, .crf = 18});
  if (!video) return video.error();
  const int frames = std::max(1, static_cast<int>(std::lround(std::min(options.max_seconds, longest) * rate)));
  Image image(width, options.height);
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t k = 0; k < sides.size(); ++k) {
      sides[k]->draw(frame / rate, image, narrow.width * static_cast<int>(k));
      if (k > 0) divide(image, narrow.width * static_cast<int>(k));
    }
    if (auto good = video->write(image); !good) return good;
    terminal.progress("filming", static_cast<double>(frame + 1) / frames);
  }
  return video->finish();
}

}  // namespace wisp::cli
