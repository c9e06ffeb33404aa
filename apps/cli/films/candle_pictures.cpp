#include "films/candle_pictures.hpp"

#include <algorithm>

#include "wisp/run/extinction_facet.hpp"

namespace wisp::cli {
namespace {

constexpr int kHeight = 720;
constexpr int kLoneWidth = 640;  // width of a picture of one flame, with room to lean
constexpr int kWidest = 1920;

}  // namespace

CandlePictures::CandlePictures(const Model& model, const Bank& bank)
    : CandlePictures(model, bank.size(), bank.polyline_points()) {
  const auto slots = static_cast<std::size_t>(bank.slots());
  polylines_.resize(slots * bank.polyline_points() * 2);
  points_.resize(slots * bank.polyline_points());
}

CandlePictures::CandlePictures(const Model& model, int count, int points)
    : width_(std::min(kLoneWidth + 220 * (count - 1), kWidest)), height_(kHeight), image_(width_, height_) {
  if (is_flame(model)) candles_.emplace(width_, height_, candle_style(model));
  for (int k = 0; k < count; ++k) {
    FlameScene scene = framed(width_, height_);
    const double spacing = static_cast<double>(width_) / (count + 1);
    scene.base.x = static_cast<float>(spacing * (k + 1));
    if (count > 1) scene.pixels_per_unit = std::min(scene.pixels_per_unit, static_cast<float>(spacing));
    scene.seed = static_cast<std::uint64_t>(k) + 1;
    scenes_.push_back(scene);
  }
  drifts_.resize(scenes_.size());
  points_.resize(scenes_.size() * static_cast<std::size_t>(points));
}

void CandlePictures::draw_on(const FilmedFlame& film) {
  width_ = film.view().width;
  height_ = film.view().height;
  film_ = &film;
}

void CandlePictures::blow(const Bank& bank, float wind) {
  const ExtinctionFacet* extinction = bank.extinction();
  if (!extinction) return;
  for (std::size_t k = 0; k < drifts_.size(); ++k) {
    const auto state = extinction->state_of(bank.at(static_cast<int>(k)));
    if (state) drifts_[k].blow(wind, *state, bank.step_time(), scenes_[k]);
  }
}

const Image& CandlePictures::draw(const Bank& bank, const Camera& camera) {
  const ExtinctionFacet* extinction = bank.extinction();
  for (std::size_t k = 0; k < scenes_.size(); ++k) {
    const LitState state =
        extinction ? extinction->state_of(bank.at(static_cast<int>(k))).value_or(LitState{}) : LitState{};
    show_state(state, scenes_[k]);
  }
  if (!bank.body()) {
    bank.polylines(polylines_);
    return draw(polylines_);
  }
  std::vector<float> rings(static_cast<std::size_t>(bank.body()->rings()) * kRingNumbers);
  const std::size_t each = points_.size() / scenes_.size();
  for (std::size_t k = 0; k < scenes_.size(); ++k) {
    bank.body()->read_rings(bank.at(static_cast<int>(k)), rings);
    see_body(rings, camera, std::span(points_).subspan(k * each, each));
  }
  return draw_points();
}

const Image& CandlePictures::draw(std::span<const float> outlines) {
  for (std::size_t k = 0; k < points_.size(); ++k) points_[k] = {outlines[2 * k], outlines[2 * k + 1]};
  return draw_points();
}

const Image& CandlePictures::draw_points() {
  if (film_) {
    const float size = scenes_.front().size.value_or(1);
    image_ = film_->draw(size > 0 ? std::span<const Point>(points_) : std::span<const Point>(), size);
    return image_;
  }
  const std::size_t each = points_.size() / scenes_.size();
  std::vector<Flame> flames;
  for (std::size_t k = 0; k < scenes_.size(); ++k) {
    flames.push_back({std::span(points_).subspan(k * each, each), scenes_[k]});
  }
  if (candles_) {
    candles_->draw(image_, flames);
  } else {
    draw_shapes(image_, flames);
  }
  return image_;
}

}  // namespace wisp::cli
