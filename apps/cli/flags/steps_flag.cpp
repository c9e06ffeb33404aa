#include "flags/steps_flag.hpp"

#include <cstdlib>

namespace wisp::cli {

Result<int> steps_of(const std::string& word) {
  if (word == "inf") return kFreeRun;
  const int step = std::atoi(word.c_str());
  if (step >= 1 && step <= 100000 && word.find_first_not_of("0123456789") == std::string::npos) return step;
  return Error{"--steps: found \"" + word + "\", expected numbers from 1 to 100000, or inf, separated by commas"};
}

Result<std::vector<int>> steps_in(const Arguments& arguments) {
  std::vector<int> steps;
  for (const std::string& word : arguments.names("steps")) {
    const auto step = steps_of(word);
    if (!step) return step.error();
    steps.push_back(*step);
  }
  return steps;
}

Flag initial_flag() {
  return {"initial",
          Kind::kChoice,
          "STATE",
          "measured",
          "where free simulation of a plain model starts: from measured samples, from rest (zero), or from what fits "
          "best",
          {"measured", "zero", "estimated"}};
}

InitialState initial_of(const Arguments& arguments) { return *value_of<InitialState>(arguments.text("initial")); }

}  // namespace wisp::cli
