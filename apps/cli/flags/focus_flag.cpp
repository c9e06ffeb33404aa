#include "flags/focus_flag.hpp"

namespace wisp::cli {

Flag focus_flag() {
  return {"focus",
          Kind::kChoice,
          "F",
          "prediction",
          "what the coefficients are best at: prediction, the next sample (least squares at the given orders); "
          "simulation, the better of that and 15 lags under a kernel in free runs of held-out rows; auto, the latter "
          "only where it is surely better",
          {"prediction", "simulation", "auto"}};
}

ArxFocus focus_of(const Arguments& arguments) {
  if (arguments.text("focus") == "auto") return ArxFocus::kAuto;
  return arguments.text("focus") == "simulation" ? ArxFocus::kSimulation : ArxFocus::kPrediction;
}

}  // namespace wisp::cli
