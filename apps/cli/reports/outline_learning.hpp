#pragma once
// Learning an outline as commands do it: recordings in, flags to options, figures out.

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/outline.hpp"
#include "wisp/learn/wind_gain.hpp"

namespace wisp::cli {

/// Flags of learning an outline, beside those of capturing it.
std::vector<Flag> outline_flags();

/// --align, which learning and validating share.
Flag align_flag();

/// Whether --gain asks for one scale of all recordings' inputs; nothing where held-out data are to say.
std::optional<bool> wanted_gain(const Arguments& arguments);

/// Errors: a value out of its range.
Result<OutlineOptions> outline_options(const Arguments& arguments, std::string name);

/// Recordings of outlines: tables are read, everything else is captured. A bad one is the error, or is left out and
/// listed with --skip-bad.
Result<std::vector<Recording>> outline_recordings(const std::vector<std::string>& paths, const Arguments& arguments,
                                                  Terminal& terminal);

/// The fit's figures, for people and programs.
void report_outline(const OutlineFit& fit, Terminal& terminal);

/// What scale the recordings' inputs are on: `gain`.
void report_gain(const WindGain& gain, Terminal& terminal);

/// What was found of sound against picture.
Json alignment_json(const std::vector<InputAlignment>& alignment);

/// `J` {k: …}, by number of steps.
Json by_steps(const std::vector<int>& steps, const std::vector<double>& values);

/// The mean over control points of figures that are one a number of steps and control point.
std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step);

/// The entry of `values` for a number of steps, kFreeRun among them; NaN where it was not judged.
double at_steps(const OutlineFigures& figures, const std::vector<double>& values, int steps);

}  // namespace wisp::cli
