#include "reports/arx_validation.hpp"

#include "flags/recordings.hpp"
#include "reports/arx_figures.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp::cli {

Result<Recording> table_for(const Model& model, const Arguments& arguments) {
  const std::string& path = arguments.positionals()[1];
  if (!is_table(path)) return Error{path + ": is not a table (.csv), which this model is validated against"};
  CsvOptions channels;
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  auto whole = read_table(path, arguments, channels);
  if (!whole) return whole;
  return in_range(std::move(*whole), arguments, "range");
}

namespace {

InitialState initial_of(const Arguments& arguments) {
  if (arguments.text("initial") == "zero") return InitialState::kZero;
  return arguments.text("initial") == "estimated" ? InitialState::kEstimated : InitialState::kMeasured;
}

}  // namespace

Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip"}) {
    if (arguments.has(flag))
      return Error{arguments.positional() + ": is not a model of an outline, so --" + flag + " has nothing to draw"};
  }
  const auto recording = table_for(model, arguments);
  if (!recording) return recording.error();
  const ValidationOptions options{steps, initial_of(arguments), arguments.has("figures")};
  const auto report = validate(model, *recording, options, terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  if (!arguments.has("figures")) return {};
  return write_arx_figures(arguments.text("figures"), model, *report);
}

}  // namespace wisp::cli
