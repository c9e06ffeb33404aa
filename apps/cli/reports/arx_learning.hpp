#pragma once
// An ARX model from what stands on the command line: recordings in memory, tables too large for it, or parts of a fit.

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/residual_tests.hpp"
#include "wisp/learn/triangular_factor.hpp"
#include "wisp/model/input_curve.hpp"

namespace wisp::cli {

/// What a model needs to know of what it was learned from.
struct ArxSources {
  double rate_hz = 0;
  std::vector<ChannelSpan> spans;  ///< outputs, then inputs
  std::vector<std::string> files;
  std::vector<InputCurve> curves{};  ///< one an input, or none
};

struct LearnedArx {
  ArxFit fit;
  ChannelChoice channels;
  ArxSources sources;
  std::optional<ResidualTests> tests{};  ///< where the recordings are in memory and long enough
};

/// Learns as the flags of `learn arx` say, with what a search or the look for delays finds reported on the way.
/// Errors: those of reading, of the flags' values, of searching and of fitting.
Result<LearnedArx> learn_arx(const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
