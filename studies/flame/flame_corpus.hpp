#pragma once
// The clips of the rig that flames are learned from and judged on, grouped by what blows.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/flame/verify_flame.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::verify {

/// Clips in one kind of wind that no learner sees.
struct UnseenFlames {
  std::string wind;              ///< what blows
  std::vector<Recording> clips;  ///< outline in pixels and the heard `wind`
  std::vector<Recording> again;  ///< another take of each: the same wind, other chance
};

/// Which clips: their seeds are the offset and a few numbers more, so that no two sets have one in common.
enum class FlameSeeds : std::uint64_t {
  kFresh = 0,        ///< nothing was chosen by looking at these
  kOtherFresh = 50,  ///< nor at these
  kTuning = 300,     ///< defaults were chosen on these three
  kSecondTuning = 350,
  kThirdTuning = 400,
};

/// The clips, all in the knots of the first and heard by one microphone. They are kept in a folder; what is not there
/// yet is simulated when it is asked for, which takes as long as the film.
class FlameCorpus {
 public:
  explicit FlameCorpus(std::filesystem::path folder, FlameSeeds seeds = FlameSeeds::kFresh);

  /// To learn from: three clips of 40 s in gusts.
  std::vector<Recording> gusts();
  /// The same, and one of 40 s in calm.
  std::vector<Recording> gusts_and_calm();
  /// Four of 40 s in the draughts of a closed room.
  std::vector<Recording> calm();
  /// Gusts, and three clips of 40 s in puffs without what is in decay, extinguished or in re-ignition.
  std::vector<Recording> gusts_and_puffs();

  UnseenFlames unseen_gusts();
  UnseenFlames unseen_calm();
  /// Puffs of which some kill: flames die, are lit again and catch.
  UnseenFlames unseen_blow_outs();
  /// The same clips without that.
  UnseenFlames unseen_between_blow_outs();

 private:
  struct Takes {
    std::string name;
    std::vector<std::uint64_t> seeds;
    FlameClipChoice choice;
  };
  Recording get(const std::string& name, FlameClipChoice choice);
  std::vector<Recording> get(const Takes& takes, bool again);
  UnseenFlames unseen(const Takes& takes);

  std::filesystem::path folder_;
  std::uint64_t offset_;
  std::vector<double> knots_;
  double one_rms_ = 0;
};

}  // namespace wisp::verify
