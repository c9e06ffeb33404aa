#pragma once
// Gusts begin within a few tenths of a second; cars that pass, the sea, a train swell over seconds.

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Whether the sound that is heard began suddenly, whatever it is: what starts under a voice and goes on after it did.
template <class T>
class Sudden {
 public:
  /// What is heard now is the room.
  void be_still() {
    sounding_ = false;
    slow_db_ = T(0.0F);
  }

  /// Takes a hop's loudness. Returns whether the sound began suddenly and has not ended since.
  bool end_hop(T loudness_db, const Design& d) {
    if (sounding_ && loudness_db < before_db_ + T(kEndDb)) sounding_ = false;
    if (!sounding_ && slow_db_ + T(kStartDb) < loudness_db) {
      sounding_ = true;
      before_db_ = slow_db_;
    }
    const float share = loudness_db < slow_db_ ? d.slow_fall : d.slow_rise;
    slow_db_ = slow_db_ + T(share) * (loudness_db - slow_db_);
    return sounding_;
  }

 private:
  // Before anything was heard a room is taken to be no louder than this, so that a gust that a stream begins with is
  // one.
  static constexpr float kRoomDb = -73;
  static constexpr float kStartDb = 6.5F;  ///< over what it was in the last third of a second
  static constexpr float kEndDb = 3;       ///< over what it was before the sound

  T slow_db_ = T(kRoomDb);
  T before_db_ = T(kRoomDb);
  bool sounding_ = false;
};

}  // namespace wisp::wind
