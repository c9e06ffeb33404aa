// `wisp compare`: compares several models on one recording, in one table and one plot.

#include <algorithm>
#include <filesystem>

#include "commands/commands.hpp"
#include "flags/arx_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_validation.hpp"
#include "terminal.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

constexpr std::size_t kMaxPlots = 4;

// Reads models and names each by its file's name, or by its whole path if an earlier model has that name.
Result<std::vector<NamedModel>> read_models(const std::vector<std::string>& paths) {
  std::vector<NamedModel> models;
  for (const std::string& path : paths) {
    auto model = read_model(path);
    if (!model) return model.error();
    const std::string stem = std::filesystem::path(path).stem().string();
    const bool taken = std::ranges::find(models, stem, &NamedModel::name) != models.end();
    models.push_back({taken ? path : stem, std::move(*model)});
  }
  return models;
}

// Returns options for reading plain tables: the inputs and outputs of all models, and the rate of the first model.
CsvOptions channels_of(const std::vector<NamedModel>& models) {
  CsvOptions all{.rate_hz = usual_rate(models.front().model)};
  const auto add = [&](const auto& channels, std::vector<std::string>& names) {
    for (const auto& channel : channels) {
      if (std::find(names.begin(), names.end(), channel.name) == names.end()) names.push_back(channel.name);
    }
  };
  for (const NamedModel& one : models) {
    add(one.model.inputs, all.inputs);
    add(one.model.outputs, all.outputs);
  }
  return all;
}

// Returns one plot per output, up to kMaxPlots: first the measured line, then a line per model.
PlotSheet sheet_of(const Report& report) {
  PlotSheet sheet{.columns = 1, .plot_width = 800};
  for (const ReportSeries& series : report.sections.front().series) {
    if (series.id.starts_with("measured.")) {
      if (sheet.plots.size() == kMaxPlots) break;
      sheet.plots.push_back({.x = {.label = series.x_label}, .y = {.label = series.y_label}});
    }
    sheet.plots.back().series.push_back({.label = series.label, .x = series.x, .y = series.y});
  }
  return sheet;
}

Result<void> run_compare(const Arguments& arguments, Terminal& terminal) {
  std::vector<std::string> paths, tables;
  for (const std::string& path : arguments.positionals()) (path.ends_with(".wisp") ? paths : tables).push_back(path);
  if (paths.empty() || tables.empty())
    return Error{"found no model or no recording, expected at least one .wisp file and one table"};
  const auto models = read_models(paths);
  if (!models) return models.error();
  const auto steps = steps_in(arguments);
  if (!steps) return steps.error();
  auto whole = read_tables(tables, arguments, terminal, channels_of(*models));
  if (!whole) return whole.error();
  const auto recordings = in_range(std::move(*whole), arguments, terminal);
  if (!recordings) return recordings.error();
  const auto report =
      compare(*models, *recordings, {.steps = *steps, .initial = *value_of<InitialState>(arguments.text("initial"))},
              terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  if (!arguments.has("output")) return {};
  const std::string& output = arguments.text("output");
  if (auto ok = write_plots(output, sheet_of(*report)); !ok) return ok;
  terminal.add("output", output);
  terminal.say("wrote " + output);
  return {};
}

}  // namespace

Command compare_command() {
  return {
      "compare",
      "Holds several models against one recording: one table of fits, and a plot.",
      {{"REC", "recordings (.csv), plain tables or MATLAB files"},
       {"MODEL", "models, .wisp files, over the rows that all of them predict", true}},
      {
          {"output", Kind::kOutput, "OUT.png", "", "plot what was measured and what every model says (.png or .svg)"},
          {"steps", Kind::kNames, "K,…", "1,inf", "steps ahead; inf is free simulation; the last is plotted"},
          initial_flag(),
          {"range", Kind::kSamples, "A:B", "", "rows of the recording, 1-based and inclusive"},
          {"columns", Kind::kNames, "A,B,…", "", "names of all columns of a plain table, in their order"},
          {"rate", Kind::kNumber, "HZ", "", "samples a second of a plain table; default: as the first model's"},
          {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
      },
      {
          {"wisp compare hairdryer.csv order2.wisp order4.wisp --range 501:1000 -o compared.png",
           "Which order simulates unseen rows best"},
      },
      run_compare,
  };
}

}  // namespace wisp::cli
