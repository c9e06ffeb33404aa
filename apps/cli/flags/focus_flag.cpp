#include "flags/focus_flag.hpp"

namespace wisp::cli {

Flag focus_flag(const std::string& more) {
  return {"focus",
          Kind::kChoice,
          "F",
          "prediction",
          "what the coefficients are best at: prediction, the next sample (least squares); simulation, free runs from "
          "the input; " +
              more,
          {"prediction", "simulation", "auto"}};
}

ArxFocus focus_of(const Arguments& arguments) {
  if (arguments.text("focus") == "auto") return ArxFocus::kAuto;
  return arguments.text("focus") == "simulation" ? ArxFocus::kSimulation : ArxFocus::kPrediction;
}

}  // namespace wisp::cli
