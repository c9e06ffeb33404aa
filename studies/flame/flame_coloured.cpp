#include "studies/flame/flame_coloured.hpp"

#include "learn/outline/outline_preparation.hpp"
#include "wisp/learn/outline.hpp"

namespace wisp::verify {
namespace {

constexpr double kHeldOut = 0.3;

Result<ColouredArxFit> fit(const std::vector<Recording>& recordings, const PreparedOutlines& prepared,
                           const ArxOrders& orders, const NoiseModel& noise) {
  return fit_coloured_arx(with_mirror_images(recordings, prepared), prepared.channels,
                          {.orders = orders, .noise = noise});
}

}  // namespace

Result<ColouredFlame> learn_coloured_flame(std::span<const Recording> clips, const NoiseModel& noise) {
  auto white = learn_outline(clips, {.noise = OutlineNoise::kIndependent, .match_variance = false});
  if (!white) return white.error();
  const auto prepared = prepare_outlines(clips, {});
  if (!prepared) return prepared.error();
  const ArxOrders& orders = white->summary.orders;
  const OutlineParts parts = hold_out(prepared->recordings, prepared->channels, kHeldOut);
  const auto judged = fit(parts.learned, *prepared, orders, noise);
  if (!judged) return judged.error();
  const auto likelihood = log_likelihood(judged->model, parts.held_out, prepared->channels);
  if (!likelihood) return likelihood.error();
  const auto whole = fit(prepared->recordings, *prepared, orders, noise);
  if (!whole) return whole.error();
  ColouredFlame out{white->model, *likelihood};
  out.model.dynamics = as_white(whole->model);
  return out;
}

}  // namespace wisp::verify
