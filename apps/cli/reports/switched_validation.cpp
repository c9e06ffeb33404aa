#include "reports/switched_validation.hpp"

#include <cmath>

#include "flags/recordings.hpp"
#include "reports/figures_json.hpp"
#include "wisp/learn/switched_prediction.hpp"

namespace wisp::cli {
namespace {

Json channel_json(const std::vector<int>& steps, const std::vector<PredictionFigures>& figures, const std::string& name,
                  std::size_t output) {
  std::vector<double> fit, rms;
  for (const PredictionFigures& figure : figures) {
    fit.push_back(figure.fit_percent[output]);
    rms.push_back(std::sqrt(figure.mean_square[output]));
  }
  return {{"name", name}, {"fit_percent", by_steps(steps, fit)}, {"rms_error", by_steps(steps, rms)}};
}

}  // namespace

Result<void> validate_switched(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                               Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip", "figures"}) {
    if (arguments.has(flag))
      return Error{arguments.positional() + ": is a switched model, for which --" + flag + " draws nothing"};
  }
  const std::string& path = arguments.positionals()[1];
  if (!is_table(path)) return Error{path + ": is not a table (.csv), which this model is validated against"};
  ChannelChoice channels;
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  auto whole = read_table(path, arguments, channels);
  if (!whole) return whole.error();
  const auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  const auto& switched = std::get<SwitchedArxModel>(model.dynamics);
  const auto figures = switched_figures(switched, *recording, channels, steps);
  if (!figures) return figures.error();
  const auto likelihood = row_log_likelihoods(switched, {&*recording, 1}, channels);
  if (!likelihood) return likelihood.error();
  const auto sequence = mode_sequence(switched, *recording, channels);
  if (!sequence) return sequence.error();
  Json& result = terminal.result();
  result["channels"] = Json::array();
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    result["channels"].push_back(channel_json(steps, *figures, channels.outputs[i], i));
  }
  std::vector<double> j;
  for (const PredictionFigures& figure : *figures) {
    double sum = 0;
    for (double one : figure.j) sum += one;
    j.push_back(sum / static_cast<double>(figure.j.size()));
    std::string line = figure.steps == kFreeRun ? "free simulation:" : std::to_string(figure.steps) + " ahead:";
    for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
      line += " " + channels.outputs[i] + " " + shown(figure.fit_percent[i], 4) + " %, RMS error " +
              shown(std::sqrt(figure.mean_square[i]), 4);
    }
    terminal.say(line);
  }
  result["J"] = by_steps(steps, j);
  result["rows"] = figures->front().rows;
  std::vector<std::size_t> acted(switched.modes.size(), 0);
  for (int mode : *sequence) {
    if (mode >= 0) ++acted[static_cast<std::size_t>(mode)];
  }
  result["mode_rows"] = acted;
  double sum = 0;
  for (double row : *likelihood) sum += row;
  result["log_likelihood"] = number(sum / static_cast<double>(likelihood->size()));
  return {};
}

}  // namespace wisp::cli
