#include "capture/vision/film_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "base/statistics.hpp"
#include "base/verdict.hpp"
#include "capture/vision/survey.hpp"

namespace wisp {
namespace {

constexpr int kMaxPoints = 96;              // maximum width and height of the grid, points
constexpr std::size_t kBlock = 4;           // width and height of the blocks compared by their means, points
constexpr double kMaxIsNew = 0.4;           // maximum share of new light in a scene; cuts have 0.6 to 1, snuffing 0.2
constexpr double kMinTotalLight = 3 * 255;  // minimum light, summed over all points: less is a spark
constexpr int kFlat = 250;                  // level of 255 from which a point counts as saturated

// Returns the correlation of two pictures' blocks; 1 if either deviates by less than 6 levels, as a dark room.
double likeness(const std::vector<double>& a, const std::vector<double>& b) {
  const double spread_a = deviation(a), spread_b = deviation(b);
  if (std::min(spread_a, spread_b) < 6) return 1;
  const double products = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(a.size());
  return (products - mean(a) * mean(b)) / (spread_a * spread_b);
}

}  // namespace

double step_between(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kExplains = 0.7, kMinDifference = 0.5;  // of the difference after a shift: maximum; before: minimum
  const int size = static_cast<int>(a.size()), reach = std::min(8, size / 2);
  std::vector<double> differs;
  for (int by = -reach; by <= reach; ++by) {
    double sum = 0;
    for (int k = std::max(0, -by); k < std::min(size, size - by); ++k) {
      sum += std::abs(a[static_cast<std::size_t>(k)] - b[static_cast<std::size_t>(k + by)]);
    }
    differs.push_back(sum / (size - std::abs(by)));
  }
  const auto best = std::min_element(differs.begin(), differs.end());
  const auto still = differs.begin() + reach;
  return *still > kMinDifference && *best < kExplains * *still ? static_cast<double>(best - still) / size : 0;
}

void FilmLook::sample(const Picture& picture) {
  step_ = std::max(1, (std::max(picture.width, picture.height) + kMaxPoints - 1) / kMaxPoints);
  const auto points = [this](int pixels) { return static_cast<std::size_t>((pixels + step_ - 1) / step_); };
  columns_ = points(picture.width);
  now_.resize(columns_ * points(picture.height));
  sample_channel(picture, PixelChannel::kLuma, picture.frame(), step_, now_.data());
}

void FilmLook::look(const Picture& picture) {
  sample(picture);
  const std::size_t rows = now_.size() / columns_, wide = (columns_ + kBlock - 1) / kBlock;
  std::vector<double> blocks(wide * ((rows + kBlock - 1) / kBlock)), across(columns_), down(rows);
  for (std::size_t k = 0; k < now_.size(); ++k) {
    const std::size_t x = k % columns_, y = k / columns_;
    const double value = now_[k];
    blocks[y / kBlock * wide + x / kBlock] += value / (kBlock * kBlock);
    across[x] += value / static_cast<double>(rows);
    down[y] += value / static_cast<double>(columns_);
  }
  const auto bright = [&](std::uint8_t value) { return brightness(picture, PixelChannel::kLuma, value); };
  const auto flat = std::count_if(now_.begin(), now_.end(), [&](auto value) { return bright(value) >= kFlat; });
  flat_.push_back(static_cast<double>(flat) / static_cast<double>(now_.size()));
  brightest_point_ = std::max(brightest_point_, bright(*std::max_element(now_.begin(), now_.end())));
  if (!blocks_.empty()) {
    changes_.push_back(1 - likeness(blocks, blocks_));
    change_rows_.push_back(rows_);
    moved_ += std::hypot(step_between(across_, across), step_between(down_, down));
  }
  ++rows_;
  blocks_ = std::move(blocks);
  across_ = std::move(across);
  down_ = std::move(down);
}

// A cut lies between two consecutive pictures that correlate far less than is usual in the film.
FilmFacts FilmLook::facts() const {
  FilmFacts out{.pictures = flat_.size()};
  const double cut = std::max(0.5, 3 * median(changes_));
  for (std::size_t k = 0; k < changes_.size(); ++k) {
    if (changes_[k] > cut) out.cuts.push_back(change_rows_[k]);
  }
  out.brightest = brightest_point_;
  out.flat = median(flat_);
  out.camera = moved_ / static_cast<double>(std::max<std::size_t>(1, changes_.size()));
  return out;
}

void FilmLook::remember(const Picture& picture) {
  sample(picture);
  if (brightest_.empty()) brightest_.assign(now_.size(), 0);
  std::transform(now_.begin(), now_.end(), brightest_.begin(), brightest_.begin(),
                 [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
}

bool FilmLook::another(const Picture& picture, const Region& within) {
  if (brightest_.empty()) return false;
  sample(picture);
  double light = 0, fresh = 0;
  for (std::size_t k = 0; k < now_.size(); ++k) {
    const int x = static_cast<int>(k % columns_) * step_, y = static_cast<int>(k / columns_) * step_;
    if (x < within.x || x >= within.right() || y < within.y || y >= within.bottom()) continue;
    light += std::max(0, now_[k] - kNoise);
    fresh += std::max(0, now_[k] - std::max<int>(brightest_[k], kNoise));
  }
  return light > kMinTotalLight && fresh > kMaxIsNew * light;
}

std::optional<std::string> film_reason(const FilmFacts& film) {
  const Criterion criteria[] = {
      {static_cast<double>(film.pictures), Bound::kAtLeast, 20, "it has {figure} frames only; give a longer clip", 0},
      {film.brightest, Bound::kAtLeast, 80,
       "the film is too dark: its brightest point has {figure} of 255 levels, and no flame can be told in it; raise "
       "the exposure",
       0},
      {100 * film.camera, Bound::kAtMost, 2,
       "the camera moves by {figure} % of the picture from frame to frame, and no flame can be told in it; keep the "
       "camera still",
       0},
      {100 * film.flat, Bound::kAtMost, 20,
       "the film is too bright: {figure} % of the picture is white, and no flame can be told in it; lower the exposure",
       0}};
  return first_missed(criteria);
}

}  // namespace wisp
