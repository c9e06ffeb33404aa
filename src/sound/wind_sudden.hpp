#pragma once
// Detects sudden onsets: gusts begin within a few tenths of a second; cars, the sea and trains swell over seconds.

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

constexpr float kNothingDb = -110;  ///< loudness below which there is no sound at all (a muted or starting stream)
constexpr int kWarmHops = 15;       ///< hops until the 50 ms mean is settled

/// Whether the current sound began suddenly, whatever it is, including sound that began during a voice and outlasts it.
template <class T>
class Sudden {
 public:
  /// Begins in an unknown situation: the first sound heard is taken for the room. A stream that is silent for half a
  /// second comes from a gated microphone, whose room is silent.
  void begin_unknown() {
    heard_hops_ = 0;
    nothing_hops_ = 0;
  }

  /// Takes a hop's loudness. Returns whether the sound began suddenly and has not ended since.
  bool end_hop(T loudness_db, const Design& d) {
    if (heard_hops_ < kWarmHops) {
      begin(loudness_db);
      return false;
    }
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
  void begin(T loudness_db) {
    sounding_ = false;
    slow_db_ = T(kRoomDb);
    if (loudness_db < T(kNothingDb)) {
      if (++nothing_hops_ == kGatedHops) heard_hops_ = kWarmHops;
      return;
    }
    ++heard_hops_;
    slow_db_ = loudness_db;
  }

  // Maximum initial loudness of a recording's room, so that a gust at its beginning counts as sudden.
  static constexpr float kRoomDb = -73;
  static constexpr int kGatedHops = 50;
  static constexpr float kStartDb = 6.5F;  ///< rise over the loudness of the last third of a second
  static constexpr float kEndDb = 3;       ///< margin over the loudness before the sound

  T slow_db_ = T(kRoomDb);
  T before_db_ = T(kRoomDb);
  bool sounding_ = false;
  int heard_hops_ = kWarmHops;
  int nothing_hops_ = 0;
};

}  // namespace wisp::wind
