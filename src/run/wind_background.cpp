#include "run/wind_background.hpp"

namespace wisp::wind {

void GustLevel::start(float first_db, float weight) {
  counts_ = {};
  add(first_db, 1);
  for (float& count : counts_) count *= weight;
}

void GustLevel::add(float db, float keep) {
  for (float& count : counts_) count *= keep;
  float place = (db - kLeastDb) / kStepDb;
  if (!(place > 0)) place = 0;
  if (place > kBins - 1.001F) place = kBins - 1.001F;
  const int bin = static_cast<int>(place);
  const float above = place - static_cast<float>(bin);
  counts_[static_cast<std::size_t>(bin)] += 1 - above;
  counts_[static_cast<std::size_t>(bin + 1)] += above;
}

float GustLevel::high_db() const {
  float all = 0;
  for (const float count : counts_) all += count;
  float left = 0.05F * all;
  for (int bin = kBins - 1; bin > 0; --bin) {
    const float count = counts_[static_cast<std::size_t>(bin)];
    if (count >= left && count > 0) {
      return kLeastDb + kStepDb * (static_cast<float>(bin) + 0.5F - left / count);
    }
    left -= count;
  }
  return kLeastDb;
}

}  // namespace wisp::wind
