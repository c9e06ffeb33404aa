// The wind level against the real world: a microphone beside an anemometer, breath, synthetic speech. Prints tables;
// exit status 1 where a bound of docs/explanation/wind.md is missed. What is not there (recordings, espeak-ng) is
// skipped, clearly.

#include "studies/wind/verify_wind.hpp"

int main(int count, char** names) {
  using namespace wisp::verify;
  if (count == 2 && std::string(names[1]) == "--features") return print_features(), 0;
  const Check checks[] = {
      {"anemometer", anemometer}, {"gusts", gusts}, {"confidence", confidence}, {"blowing", blowing}};
  return run_checks(checks, {names + 1, static_cast<std::size_t>(count - 1)});
}
