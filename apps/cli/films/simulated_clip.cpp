#include "films/simulated_clip.hpp"

#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {

std::filesystem::path truth_path(const std::filesystem::path& clip) {
  std::filesystem::path path = clip;
  return path.replace_extension(".truth.csv");
}

Result<Recording> write_simulated_clip(const std::filesystem::path& path, const CandleClipOptions& options,
                                       Terminal& terminal) {
  auto film =
      VideoWriter::create(path, {.width = options.camera.width,
                                 .height = options.camera.height,
                                 .rate_hz = options.rig.rate_hz,
                                 .crf = 12,  // keeps the sensor's noise, so that a calm flame is not a still picture
                                 .sound_rate_hz = static_cast<int>(options.microphone.rate_hz)});
  if (!film) return film.error();
  CandleClipOutputs outputs;
  outputs.on_frame = [&](const CandleFrame& frame) {
    return film->write(Image::from_rgb(frame.picture, frame.width, frame.height));
  };
  outputs.on_sound = [&](std::span<const float> sound) { return film->write_sound(sound); };
  outputs.on_progress = [&](double share) { terminal.progress("simulating", share); };
  auto truth = simulate_candle(options, outputs);
  if (!truth) return truth;
  if (auto ok = film->finish(); !ok) return ok.error();
  if (auto ok = write_csv(truth_path(path), *truth); !ok) return ok.error();
  return truth;
}

}  // namespace wisp::cli
