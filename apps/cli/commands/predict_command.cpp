// `wisp predict`: predictions of a model on a recording, row by row.

#include "commands/commands.hpp"
#include "flags/arx_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_validation.hpp"
#include "terminal.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

// Reads the recording with the model's channels. An outline's channels have fixed names, which need no flags.
Result<Recording> recording_for(const Model& model, const std::string& path, const Arguments& arguments) {
  if (!std::holds_alternative<OutlineView>(model.view)) return table_for(model, path, arguments);
  auto whole = read_table(path, arguments, {.rate_hz = model.rate_hz});
  if (!whole) return whole;
  return in_range(std::move(*whole), arguments, "range");
}

Result<void> run_predict(const Arguments& arguments, Terminal& terminal) {
  const auto model = read_model(arguments.positionals()[0]);
  if (!model) return model.error();
  const int steps = arguments.text("steps") == "inf" ? kFreeRun : arguments.integer("steps");
  const auto recording = recording_for(*model, arguments.positionals()[1], arguments);
  if (!recording) return recording.error();
  const auto predicted = predict(*model, *recording, {steps, *value_of<InitialState>(arguments.text("initial"))});
  if (!predicted) return predicted.error();
  const std::string& output = arguments.text("output");
  if (auto ok = write_csv(output, *predicted); !ok) return ok;
  terminal.add("output", output);
  terminal.add("rows", predicted->rows());
  terminal.say("wrote " + output + ": " + std::to_string(predicted->rows()) + " rows, " +
               (steps == kFreeRun ? std::string("free run") : std::to_string(steps) + " ahead"));
  return {};
}

}  // namespace

Command predict_command() {
  return {
      "predict",
      "Writes what a model says of a recording: predictions and their 95 % intervals, row by row.",
      {{"MODEL", "the model, a .wisp file"}, {"REC", "a recording (.csv), a plain table or a MATLAB file"}},
      {
          {"output", Kind::kOutput, "OUT.csv", "", "where to write them", {}, true},
          ranged({"steps",
                  Kind::kIntegerOrWord,
                  "K|inf",
                  "1",
                  "steps ahead; inf: a free run, from the inputs alone",
                  {"inf"}},
                 1, 100000),
          initial_flag(),
          {"range", Kind::kSamples, "A:B", "", "rows of the recording, 1-based and inclusive"},
          {"inputs", Kind::kNames, "A,B", "",
           "columns that are the model's inputs, in its order, where they have other names"},
          {"outputs", Kind::kNames, "C,D", "",
           "columns that are the model's outputs, in its order, where they have other names"},
          {"columns", Kind::kNames, "A,B,…", "", "names of all columns of a plain table, in their order"},
          {"rate", Kind::kNumber, "HZ", "", "samples a second of a plain table; default: as the model's"},
          {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
      },
      {
          {"wisp predict dryer.wisp hairdryer.csv --range 501:1000 --steps 5 -o five.csv",
           "Half a second ahead, from all that was measured until then"},
          {"wisp predict dryer.wisp hairdryer.csv --steps inf --initial zero -o free.csv",
           "What the heater alone says of the temperature, from rest"},
      },
      run_predict,
  };
}

}  // namespace wisp::cli
