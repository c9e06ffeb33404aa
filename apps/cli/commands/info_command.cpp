// `wisp info`: describes a model file, or examines a recording before a model is learned from it.

#include "commands/commands.hpp"
#include "flags/recordings.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/advice.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

Result<void> plot_channels(const std::string& path, const Report& report, Terminal& terminal) {
  PlotSheet sheet{.columns = 1, .plot_width = 800};
  for (const ReportSeries& series : report.sections.front().series) {
    if (sheet.plots.size() == 8) break;
    sheet.plots.push_back({.x = {.label = series.x_label}, .y = {.label = series.y_label}});
    sheet.plots.back().series.push_back({.label = series.label, .x = series.x, .y = series.y});
  }
  if (auto ok = write_plots(path, sheet); !ok) return ok;
  terminal.add("output", path);
  terminal.say("wrote " + path);
  return {};
}

Result<void> look_at_recordings(const Arguments& arguments, Terminal& terminal) {
  const auto preparation = preparation_of(arguments);
  if (!preparation) return preparation.error();
  std::vector<Recording> recordings;
  for (const std::string& path : arguments.positionals()) {
    if (!is_table(path)) return Error{path + ": is no table, expected recordings, or a single model to look at"};
    auto recording = read_table(path, arguments, {.rate_hz = 1, .every_column = !arguments.has("outputs")});
    if (recording) recording = prepare(*recording, *preparation);
    if (!recording) return recording.error();
    recordings.push_back(std::move(*recording));
  }
  Report report = advise(recordings.front());
  if (recordings.size() > 1 || find_channel(recordings.front(), "p0.x")) {
    auto motion = outline_motion(recordings);
    if (!motion) return motion.error();
    report.append(std::move(*motion));
  }
  terminal.show(report);
  return arguments.has("output") ? plot_channels(arguments.text("output"), report, terminal) : Result<void>();
}

Result<void> run_info(const Arguments& arguments, Terminal& terminal) {
  const bool several = arguments.positionals().size() > 1;
  if (several || is_table(arguments.positional())) return look_at_recordings(arguments, terminal);
  const auto bytes = read_file(arguments.positional());
  if (!bytes) return bytes.error();
  const auto model = parse_model(*bytes, arguments.positional());
  if (!model) return model.error();
  auto of_tables = refuse(arguments, {"output", "inputs", "outputs", "prepare", "columns", "rate", "dt"},
                          "is of a recording, not of a model");
  if (!of_tables) return of_tables;
  auto report = model_report(*model);
  if (!report) return report.error();
  if (terminal.json()) report->append(model_contents(*model));
  report->add("File").entries = {{"bytes", bytes->size(), "size", "bytes"},
                                 {"format_version", kModelFormatVersion, "version of the format", ""}};
  terminal.show(*report);
  return {};
}

}  // namespace

Command info_command() {
  return {
      "info",
      "Looks at a recording before any model: rate, channels, and what will spoil a model, with cures; or says what a "
      "model file holds, how it was made, and what it costs a frame.",
      {{"FILE", "a recording (.csv, .mat) or a model (.wisp); two outlines filmed at once: also their phase", true}},
      {
          {"output", Kind::kOutput, "OUT.png", "", "plot every channel of a recording (.png or .svg)"},
          {"inputs", Kind::kNames, "A,B", "", "channels that are inputs"},
          {"outputs", Kind::kNames, "C,D", "", "channels that are outputs; without it all that are no inputs"},
          prepare_flag(),
          {"columns", Kind::kNames, "A,B,…", "", "names of all columns of a plain table, in their order"},
          {"rate", Kind::kNumber, "HZ", "", "samples a second of a plain table; default: by its time, else 1"},
          {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
      },
      {{"wisp info flame.wisp", "The facts of a model"},
       {"wisp info heater.csv --inputs power --outputs temperature", "What is remarkable of a table"}},
      run_info,
  };
}

}  // namespace wisp::cli
