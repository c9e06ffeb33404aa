#pragma once
// Recordings as a rule of extinction sees them: lives from one lighting to the next death, and the gusts in them.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/flame/extinction.hpp"

namespace wisp {

/// Rows [begin, end) of a life, or of a gust, in the samples of one recording.
struct WindSpan {
  const double* wind = nullptr;  ///< strengths in the model's units from the recording's first row on, 0 where missing
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A flame from its lighting to its death or to the recording's end.
struct FlameLife {
  WindSpan rows;  ///< ends where the flame was gone
  double rate_hz = 0;
  bool died = false;
  std::size_t watched = 0;        ///< first row in which its death may be found,
  std::size_t until = 0;          ///< and one past the last; later than its end, within the recording
  std::vector<WindSpan> gusts{};  ///< gusts that it survived
};

class FlameLives {
 public:
  explicit FlameLives(std::span<const ExtinctionEvidence> evidence);

  const std::vector<FlameLife>& lives() const { return lives_; }
  std::size_t deaths() const;
  std::size_t gusts() const;
  double weakest_death() const { return weakest_death_; }            ///< averaged wind; 0 where none died
  double strongest_survived() const { return strongest_survived_; }  ///< averaged wind; 0 where there was no gust

 private:
  void add_lives(const ExtinctionEvidence& evidence, const std::vector<double>& wind);
  void find_gusts(FlameLife& life, double least);

  std::vector<std::vector<double>> winds_;
  std::vector<FlameLife> lives_;
  double weakest_death_ = 0;
  double strongest_survived_ = 0;
};

}  // namespace wisp
