#include "wisp/simulate/candle_clip.hpp"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flame_outline.hpp"
#include "simulate/candle/virtual_camera.hpp"
#include "simulate/candle/wind_signal.hpp"
#include "simulate/option_range.hpp"

namespace wisp {
namespace {

constexpr std::size_t kFramesAhead = 16;  // maximum number of simulated frames that wait for the camera

// Output of the rig for one frame.
struct Shot {
  RigLight light;
  CandleState state;
  double wind = 0;
};

// Queue of frames from the simulating thread to the filming thread.
class ShotQueue {
 public:
  /// Appends a frame, waiting for room. Returns false after close().
  bool push(Shot shot) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return shots_.size() < kFramesAhead || closed_; });
    if (closed_) return false;
    shots_.push_back(std::move(shot));
    changed_.notify_all();
    return true;
  }

  Shot pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !shots_.empty(); });
    Shot shot = std::move(shots_.front());
    shots_.pop_front();
    changed_.notify_all();
    return shot;
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Shot> shots_;
  bool closed_ = false;
};

// The candle in its wind: simulates a frame per call of next(), and relights the candle when the wind says so.
class Scene {
 public:
  Scene(CandleRig rig, const WindSignal& wind, double settle_seconds) : rig_(std::move(rig)), wind_(wind) {
    const auto settle = static_cast<long long>(std::ceil(settle_seconds * rig_.options().rate_hz));
    for (long long frame = 0; frame < settle; ++frame) rig_.step_frame(0);
  }

  Shot next() {
    const double rate = rig_.options().rate_hz;
    const double begin = static_cast<double>(frame_) / rate;
    const double end = static_cast<double>(++frame_) / rate;
    const auto due = [&](double at) { return at >= begin && at < end; };
    if (std::any_of(wind_.relights().begin(), wind_.relights().end(), due) && !rig_.state().lit) rig_.light();
    Shot shot;
    shot.wind = wind_.at(end);
    rig_.step_frame(shot.wind);
    shot.state = rig_.state();
    shot.light = rig_.light_of_frame();
    return shot;
  }

 private:
  CandleRig rig_;
  const WindSignal& wind_;
  std::uint64_t frame_ = 0;
};

// Builder of the ground-truth recording, one row per frame.
class Truth {
 public:
  Truth(const CandleClipOptions& options, const CameraView& view) : view_(view) {
    recording_.source = "simulated candle";
    recording_.rate_hz = options.rig.rate_hz;
    add("wind", "m/s", Role::kInput);
    for (const char* name : {"tip.x", "tip.y", "height"}) add(name, "mm", Role::kOutput);
    add("lean", "deg", Role::kOutput);
    add("brightness", "mm2", Role::kOutput);
    add("lit", "1", Role::kOutput);
    for (int k = 0; k < kOutlinePoints; ++k)
      for (const char* axis : {".x", ".y"}) {
        std::string name = "p";
        add(name.append(std::to_string(k)).append(axis), "px", Role::kOutput);
      }
    note("pixels_per_mm", view.pixels_per_mm);
    note("origin_x", view.origin_x);
    note("origin_y", view.origin_y);
    note("cell_mm", options.rig.cell_mm);
    note("steps_a_second", options.rig.rate_hz * flow::steps_per_frame(options.rig));
    recording_.attributes.push_back({"seed", std::to_string(options.wind.seed)});
  }

  void add_row(const Shot& shot, const FlameOutline& outline) {
    constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> row = {shot.wind};
    if (outline.found) {
      row.insert(row.end(), {outline.tip.x, outline.tip.y, outline.height, outline.lean});
    } else {
      row.insert(row.end(), 4, kMissing);
    }
    row.push_back(outline.brightness);
    row.push_back(shot.state.lit ? 1 : 0);
    for (int k = 0; k < kOutlinePoints; ++k) {
      row.push_back(outline.found ? view_.pixel_x(outline.control_points[k].x) : kMissing);
      row.push_back(outline.found ? view_.pixel_y(outline.control_points[k].y) : kMissing);
    }
    for (std::size_t c = 0; c < row.size(); ++c) recording_.channels[c].samples.push_back(row[c]);
  }

  Recording take() { return std::move(recording_); }

 private:
  void add(std::string name, const char* unit, Role role) {
    recording_.channels.push_back({std::move(name), unit, role, {}});
  }
  void note(const char* name, double value) { set_numbers_attribute(recording_, name, {&value, 1}); }

  CameraView view_;
  Recording recording_;
};

// Camera, microphone and the record of the ground truth.
class Crew {
 public:
  Crew(const CandleClipOptions& options, const CandleClipOutputs& outputs, VirtualCamera camera,
       VirtualMicrophone microphone, const WindSignal& wind, std::uint64_t frames)
      : options_(options),
        outputs_(outputs),
        camera_(std::move(camera)),
        microphone_(std::move(microphone)),
        wind_(wind),
        frames_(frames),
        truth_(options, camera_.view()) {}

  Result<void> take(const Shot& shot) {
    if (!shot.state.finite)
      return Error{"candle rig: frame " + std::to_string(frame_ + 1) +
                   " holds a number that is not finite; this is a "
                   "defect of the simulation, take a smaller time step and report it"};
    truth_.add_row(shot, flame_outline(shot.light));
    if (auto filmed = film(shot); !filmed) return filmed;
    if (auto heard = listen(); !heard) return heard;
    ++frame_;
    if (outputs_.on_progress) outputs_.on_progress(static_cast<double>(frame_) / static_cast<double>(frames_));
    return {};
  }

  Recording truth() { return truth_.take(); }

 private:
  Result<void> film(const Shot& shot) {
    if (!outputs_.on_frame) return {};
    const VirtualCameraOptions& c = camera_.options();
    return outputs_.on_frame({frame_, static_cast<double>(frame_) / options_.rig.rate_hz, c.width, c.height,
                              camera_.picture(shot.light, frame_)});
  }

  // Makes the sound from the end of the previous frame to the end of this one.
  Result<void> listen() {
    if (!outputs_.on_sound) return {};
    const double rate = options_.microphone.rate_hz;
    const auto end =
        static_cast<std::uint64_t>(std::llround(static_cast<double>(frame_ + 1) / options_.rig.rate_hz * rate));
    wind_block_.resize(end - heard_);
    sound_.resize(end - heard_);
    for (std::size_t k = 0; k < wind_block_.size(); ++k)
      wind_block_[k] = static_cast<float>(wind_.at(static_cast<double>(heard_ + k) / rate));
    heard_ = end;
    microphone_.hear(wind_block_, sound_);
    return outputs_.on_sound(sound_);
  }

  const CandleClipOptions& options_;
  const CandleClipOutputs& outputs_;
  VirtualCamera camera_;
  VirtualMicrophone microphone_;
  const WindSignal& wind_;
  std::uint64_t frames_;
  Truth truth_;
  std::uint64_t frame_ = 0;
  std::uint64_t heard_ = 0;
  std::vector<float> wind_block_, sound_;
};

// Simulates all frames on a second thread, while the calling one draws and writes them.
Result<void> shoot(Scene& scene, Crew& crew, std::uint64_t frames) {
  ShotQueue queue;
  std::thread simulation([&] {
    for (std::uint64_t frame = 0; frame < frames; ++frame)
      if (!queue.push(scene.next())) return;
  });
  Result<void> result;
  for (std::uint64_t frame = 0; frame < frames && result; ++frame) result = crew.take(queue.pop());
  queue.close();
  simulation.join();
  return result;
}

}  // namespace

Result<Recording> simulate_candle(const CandleClipOptions& options, const CandleClipOutputs& outputs) {
  const auto good = flow::check_ranges(
      "candle clip", {{"seconds", options.seconds, 1e-3, 86400}, {"settle_seconds", options.settle_seconds, 0, 60}});
  if (!good) return good.error();
  if (options.wind_recording && (options.wind.blow_out_at >= 0 || options.wind.puff_every > 0))
    return Error{"candle clip: blow-outs and puffs are not added to a recorded wind; leave them out"};
  auto wind = options.wind_recording ? WindSignal::from_recording(*options.wind_recording)
                                     : WindSignal::generate(options.wind, options.seconds);
  if (!wind) return wind.error();
  auto camera = VirtualCamera::create(options.camera);
  if (!camera) return camera.error();
  auto microphone = VirtualMicrophone::create(options.microphone);
  if (!microphone) return microphone.error();
  auto rig = CandleRig::create(options.rig);
  if (!rig) return rig.error();

  const auto frames = static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds * options.rig.rate_hz)));
  Scene scene(std::move(*rig), *wind, options.settle_seconds);
  Crew crew(options, outputs, std::move(*camera), std::move(*microphone), *wind, frames);
  const Result<void> shot = shoot(scene, crew, frames);
  if (!shot) return shot.error();
  return crew.truth();
}

}  // namespace wisp
