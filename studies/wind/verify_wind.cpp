// The wind level against the real world: a microphone beside an anemometer, breath, synthetic speech. Prints tables;
// exit status 1 where a bound of docs/wind.md is missed. What is not there (recordings, espeak-ng) is skipped, clearly.

#include "studies/wind/verify_wind.hpp"

int main() {
  wisp::verify::Bounds bounds;
  wisp::verify::anemometer(bounds);
  wisp::verify::gusts(bounds);
  wisp::verify::confidence(bounds);
  std::printf("\n%s\n", bounds.missed() == 0 ? "all bounds held" : "bounds were missed");
  return bounds.missed() == 0 ? 0 : 1;
}
