#include "reports/arx_validation.hpp"

#include <utility>

#include "flags/recordings.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp::cli {

namespace {

// A channel of the table, and the model's name for it.
struct Renamed {
  std::size_t channel = 0;
  std::string name;
};

// Matches the model's channels to the table's: those named by the flag, or those with equal names.
Result<void> find_renamed(const Recording& recording, const std::vector<std::string>& given,
                          const std::vector<std::string>& own, const std::string& flag, std::vector<Renamed>& renamed) {
  if (!given.empty() && given.size() != own.size()) {
    return Error{"--" + flag + " names " + std::to_string(given.size()) + " channels, the model has " +
                 std::to_string(own.size()) + ": name one for each, in the model's order"};
  }
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::string& name = given.empty() ? own[k] : given[k];
    const auto channel = find_channel(recording, name);
    if (!channel && given.empty()) continue;  // validate() reports the missing channel
    if (!channel) return Error{recording.source + ": has no channel " + name + ", which --" + flag + " names"};
    for (const Renamed& one : renamed) {
      if (one.channel != *channel) continue;
      return Error{recording.source + ": channel " + name + " stands for the model's " + one.name + " and for its " +
                   own[k] + ": name another for one of them with --inputs or --outputs"};
    }
    renamed.push_back({*channel, own[k]});
  }
  return {};
}

}  // namespace

double usual_rate(const Model& model) { return model.training.preparation.resample_hz > 0 ? 0 : model.rate_hz; }

Result<Recording> table_for(const Model& model, const std::string& path, const Arguments& arguments) {
  if (!is_table(path)) return Error{path + ": is not a table (.csv), which this model is judged on"};
  CsvOptions channels{.rate_hz = usual_rate(model)};
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  auto whole = read_table(path, arguments, channels);
  if (!whole) return whole;
  std::vector<Renamed> renamed;
  for (const auto& [flag, own] : {std::pair("inputs", &channels.inputs), std::pair("outputs", &channels.outputs)}) {
    if (auto ok = find_renamed(*whole, arguments.names(flag), *own, flag, renamed); !ok) return ok.error();
  }
  for (const Renamed& one : renamed) whole->channels[one.channel].name = one.name;
  return in_range(std::move(*whole), arguments, "range");
}

Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal) {
  const bool switched = std::holds_alternative<SwitchedArxModel>(model.dynamics);
  for (const char* flag : {"overlay", "film-strip", "film", "clip", "figures"}) {
    if (!arguments.has(flag) || (!switched && std::string_view(flag) == "figures")) continue;
    return Error{arguments.positional() + ": is " + (switched ? "a switched model" : "not a model of an outline") +
                 ", for which --" + flag + " draws nothing"};
  }
  auto starts = refuse(arguments, {"initial"}, "is for single models; a switched one starts from measured samples");
  if (switched && !starts) return starts;
  std::vector<Recording> recordings;
  for (std::size_t k = 1; k < arguments.positionals().size(); ++k) {
    auto recording = table_for(model, arguments.positionals()[k], arguments);
    if (!recording) return recording.error();
    recordings.push_back(std::move(*recording));
  }
  const ValidationOptions options{steps, *value_of<InitialState>(arguments.text("initial")), arguments.has("figures")};
  const auto report = validate(model, recordings, options, terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  if (!arguments.has("figures")) return {};
  return write_arx_figures(arguments.text("figures"), model, *report, terminal);
}

}  // namespace wisp::cli
