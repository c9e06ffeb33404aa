#include "films/validation_pictures.hpp"
#include "wisp/draw/flame.hpp"

#include <algorithm>
#include <cmath>

#include "reports/clip_figures.hpp"
#include "reports/validation_figures.hpp"

namespace wisp::cli {
namespace {

// The strip shows twelve moments an eighth of a second apart, where the outline moves most.
std::vector<std::size_t> strip_rows(const OutlineRows& captured, double rate_hz) {
  constexpr std::size_t kColumns = 12;
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rate_hz / 8)));
  const std::size_t length = (kColumns - 1) * apart + 1;
  const auto tip = [&](std::size_t row) { return captured[row][captured[row].size() / 2][0]; };
  std::size_t best = 0;
  double max_motion = -1;
  for (std::size_t begin = 0; begin + length <= captured.size(); begin += apart) {
    double motion = 0;
    bool whole = true;
    for (std::size_t row = begin + apart; whole && row < begin + length; row += apart) {
      whole = !captured[row].empty() && !captured[row - apart].empty();
      if (whole) motion += std::abs(tip(row) - tip(row - apart));
    }
    if (!whole || motion <= max_motion) continue;
    max_motion = motion;
    best = begin;
  }
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < kColumns && best + k * apart < captured.size(); ++k) rows.push_back(best + k * apart);
  return rows;
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
    const StripContent content{
        .rows = strip_rows(found.captured, subject.recording.rate_hz),
        .rate_hz = subject.recording.rate_hz,
        .captured = found.captured,
        .synthesized = found.played,
        .pixels_per_unit = found.pixels_per_unit,
        .flame = is_flame(model),
        .synthesized_caption = model.inputs.empty() ? "synthesized" : "synthesized from the same wind"};
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
