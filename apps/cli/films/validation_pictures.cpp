#include "films/validation_pictures.hpp"
#include "wisp/draw/flame.hpp"

#include "films/like_moments.hpp"
#include "reports/clip_figures.hpp"
#include "reports/validation_figures.hpp"

namespace wisp::cli {
namespace {

// Pixels of the clip that a recording was captured from; 0 where it does not say.
int clip_size(const Recording& recording, const char* side) {
  const auto value = numbers_attribute(recording, side);
  return value && *value && (*value)->size() == 1 ? static_cast<int>((**value)[0]) : 0;
}

}  // namespace

Result<void> draw_validation(const ValidatedOutline& found, const Model& model, const ValidationSubject& subject,
                             const ValidationPictures& pictures, Terminal& terminal) {
  if (!pictures.overlay.empty()) {
    const OverlayContent content{found.captured, found.simulated, found.simulated_label};
    if (auto ok = write_overlay(pictures.overlay, subject.clip, subject.recording, content, terminal); !ok) return ok;
    terminal.say("wrote " + pictures.overlay);
  }
  if (!pictures.film_strip.empty()) {
    const LikeMoments moments = like_moments(subject.recording, found.captured, found.played);
    const StripContent content{.rows = moments.recorded,
                               .synthesized_rows = moments.played,
                               .rate_hz = subject.recording.rate_hz,
                               .captured = found.captured,
                               .synthesized = found.played,
                               .pixels_per_unit = found.pixels_per_unit,
                               .clip_width = clip_size(subject.recording, "width"),
                               .clip_height = clip_size(subject.recording, "height"),
                               .flame = is_flame(model),
                               .synthesized_caption = model.inputs.empty() ? "synthesized, at a like moment"
                                                                           : "synthesized, at a like wind and moment"};
    if (auto ok = write_film_strip(pictures.film_strip, subject.clip, content); !ok) return ok;
    terminal.say("wrote " + pictures.film_strip);
  }
  const std::string& folder = pictures.figures;
  if (folder.empty()) return {};
  if (auto ok = write_validation_figures(folder, model, found.report); !ok) return ok;
  if (subject.captured) {
    if (auto ok = write_clip_figures(folder, subject.clip.path, *subject.captured); !ok) return ok;
  }
  terminal.say("wrote figures to " + folder);
  return {};
}

}  // namespace wisp::cli
