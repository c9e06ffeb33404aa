#include "wisp/learn/validate.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/prepare.hpp"

namespace wisp {
namespace {

// Predictions of one model for one number of steps: a channel NAME.predicted per output.
struct Said {
  std::size_t model;
  int steps;
  Recording table;
};

const std::vector<double>* series_of(const Recording& table, const std::string& name) {
  const auto channel = find_channel(table, name);
  return channel ? &table.channels[*channel].samples : nullptr;
}

Result<std::vector<Said>> all_said(std::span<const NamedModel> models, const Recording& recording,
                                   const ValidationOptions& options, const Progress& progress) {
  std::vector<Said> out;
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (int steps : options.steps) {
      const double share = static_cast<double>(out.size()) / static_cast<double>(models.size() * options.steps.size());
      if (!go_on(progress, "predicting", share)) return Error{std::string(kStopped)};
      auto table = predict(models[m].model, recording, {steps, options.initial});
      if (!table) return Error{models[m].name + ": " + table.error().message};
      out.push_back({m, steps, std::move(*table)});
    }
  }
  return out;
}

// Rows of an output that are measured, and predicted `steps` ahead by every model that has the output.
std::vector<std::size_t> common_rows(const std::vector<double>& measured, const std::vector<Said>& said,
                                     const std::string& output, int steps) {
  std::vector<const std::vector<double>*> all{&measured};
  for (const Said& one : said) {
    const auto* predicted = one.steps == steps ? series_of(one.table, output + ".predicted") : nullptr;
    if (predicted) all.push_back(predicted);
  }
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < measured.size(); ++row) {
    if (std::all_of(all.begin(), all.end(), [row](const auto* one) { return std::isfinite((*one)[row]); }))
      rows.push_back(row);
  }
  return rows;
}

double fit_percent(const std::vector<double>& measured, const std::vector<double>& predicted,
                   const std::vector<std::size_t>& rows) {
  double mean = 0, error = 0, spread = 0;
  for (std::size_t row : rows) mean += measured[row] / static_cast<double>(rows.size());
  for (std::size_t row : rows) {
    error += (measured[row] - predicted[row]) * (measured[row] - predicted[row]);
    spread += (measured[row] - mean) * (measured[row] - mean);
  }
  return spread > 1e-24 * mean * mean * static_cast<double>(rows.size()) ? 100 * (1 - std::sqrt(error / spread)) : 0;
}

// Outputs of any of the models, in order of first appearance.
std::vector<std::string> outputs_of(std::span<const NamedModel> models) {
  std::vector<std::string> names;
  for (const NamedModel& one : models) {
    for (const Output& output : one.model.outputs) {
      if (std::find(names.begin(), names.end(), output.name) == names.end()) names.push_back(output.name);
    }
  }
  return names;
}

// Table with one row per model and output.
ReportTable table_of(std::span<const NamedModel> models, const Recording& recording, const std::vector<Said>& said,
                     const std::vector<int>& steps) {
  ReportTable table{"compared", "fit of every model", {{"output", "output"}, {"model", "model"}}, {}};
  for (int step : steps) {
    const std::string label = step == kFreeRun ? "free" : std::to_string(step) + " ahead";
    table.columns.push_back({"fit_percent." + arx::steps_id(step), "fit " + label, "%"});
    table.columns.push_back({"rows." + arx::steps_id(step), ""});
  }
  for (const std::string& output : outputs_of(models)) {
    const auto& measured = *series_of(recording, output);
    for (std::size_t m = 0; m < models.size(); ++m) {
      std::vector<ReportValue> row{output, models[m].name};
      for (const Said& one : said) {
        const auto* predicted = one.model == m ? series_of(one.table, output + ".predicted") : nullptr;
        if (!predicted) continue;
        const auto rows = common_rows(measured, said, output, one.steps);
        row.emplace_back(rows.empty() ? std::nan("") : fit_percent(measured, *predicted, rows));
        row.emplace_back(rows.size());
      }
      if (row.size() == table.columns.size()) table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// Series of every output: measured, and predicted by each model for the last number of steps, which is free simulation
// unless options say otherwise.
void add_series(std::span<const NamedModel> models, const Recording& recording, const std::vector<Said>& said,
                int steps, ReportSection& section) {
  const std::vector<double> seconds = seconds_of(recording);
  const std::string way = steps == kFreeRun ? ", free simulation" : ", " + std::to_string(steps) + " ahead";
  const auto outputs = outputs_of(models);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Channel& measured = recording.channels[*find_channel(recording, outputs[i])];
    const std::string y = outputs[i] + (measured.unit.empty() ? "" : ", " + measured.unit);
    const std::string place = "." + std::to_string(i);
    section.series.push_back({"measured" + place, "measured", "time, s", y, seconds, measured.samples});
    for (const Said& one : said) {
      const auto* predicted = one.steps == steps ? series_of(one.table, outputs[i] + ".predicted") : nullptr;
      if (!predicted) continue;
      section.series.push_back({"model" + place + "." + std::to_string(one.model), models[one.model].name + way,
                                "time, s", y, seconds, *predicted});
    }
  }
}

constexpr double kBadlyFitted = 30;  // percentage points: a fit this far below the median fit gets a warning

// Joins the first tables of the reports, with the recording's name first in each row.
ReportTable joined(const std::vector<Report>& reports, std::span<const Recording> recordings) {
  ReportTable all = reports.front().sections.front().tables.front();
  all.columns.insert(all.columns.begin(), {"recording", "recording"});
  all.rows.clear();
  for (std::size_t r = 0; r < reports.size(); ++r) {
    for (std::vector<ReportValue> row : reports[r].sections.front().tables.front().rows) {
      row.insert(row.begin(), std::filesystem::path(recordings[r].source).filename().string());
      all.rows.push_back(std::move(row));
    }
  }
  return all;
}

// Warns of rows of the table whose fit, in the last column of fits, is far below the median of all rows.
void name_badly_fitted(const ReportTable& all, Report& report) {
  std::size_t column = 0;
  for (std::size_t c = 0; c < all.columns.size(); ++c) {
    if (all.columns[c].id.starts_with("fit_percent.")) column = c;
  }
  std::vector<double> fits;
  for (const auto& row : all.rows) {
    if (const auto* fit = std::get_if<double>(&row[column])) fits.push_back(*fit);
  }
  const double middle = median(present(std::move(fits)));  // a recording without common rows has no fit
  for (const auto& row : all.rows) {
    const auto* fit = std::get_if<double>(&row[column]);
    if (!fit || !(*fit < middle - kBadlyFitted)) continue;
    report.warnings.push_back(std::get<std::string>(row[0]) + " is fitted badly: " + all.columns[column].label +
                              " of '" + std::get<std::string>(row[1]) + "' is " + number_text(*fit, 3) +
                              " %, the median of all is " + number_text(middle, 3) + " %; look at it with wisp info");
  }
}

// Runs `judge` on every recording and joins the tables. Series are those of the first recording.
template <class Judge>
Result<Report> of_every(std::span<const Recording> recordings, Judge judge) {
  std::vector<Report> reports;
  for (const Recording& one : recordings) {
    auto report = judge(one);
    if (!report) return report;
    reports.push_back(std::move(*report));
  }
  ReportTable all = joined(reports, recordings);
  Report out = std::move(reports.front());
  out.sections.front().tables = {std::move(all)};
  out.sections.front().entries = {{"recordings", recordings.size(), "recordings"}};
  for (std::size_t r = 1; r < reports.size(); ++r) {
    out.warnings.insert(out.warnings.end(), reports[r].warnings.begin(), reports[r].warnings.end());
  }
  name_badly_fitted(out.sections.front().tables.front(), out);
  return out;
}

// Warns of channels whose unit is not that of the model.
void warn_of_units(const Model& model, const std::string& name, const Recording& recording, Report& report) {
  const auto look_at = [&](const auto& channels) {
    for (const auto& one : channels) {
      const auto found = find_channel(recording, one.name);
      const std::string unit = found ? recording.channels[*found].unit : "";
      if (unit.empty() || one.unit.empty() || unit == one.unit) continue;
      report.warnings.push_back(recording.source + ": '" + one.name + "' is in " + unit + ", in " + name + " in " +
                                one.unit + ": units are not converted");
    }
  };
  look_at(model.inputs);
  look_at(model.outputs);
}

Result<Report> validate_prepared(const Model& model, const Recording& recording, const ValidationOptions& options,
                                 const Progress& progress) {
  const auto prepared = prepare(recording, model.training.preparation);
  if (!prepared) return prepared.error();
  if (auto ok = check_rate(model, *prepared); !ok) return ok.error();
  const bool switched = std::holds_alternative<SwitchedArxModel>(model.dynamics);
  auto report = (switched ? validate_switched : validate_arx)(model, *prepared, options, progress);
  if (report) warn_of_units(model, "the model", recording, *report);
  if (report && model.training.preparation != Preparation{}) {
    arx::add(report->sections.front(), "preparation", text_of(model.training.preparation), "prepared by", "",
             "as the recordings that the model was learned from");
  }
  return report;
}

}  // namespace

Result<Report> compare(std::span<const NamedModel> models, const Recording& measured, const ValidationOptions& options,
                       const Progress& progress) {
  if (models.empty() || options.steps.empty()) return Error{"there is no model, or no number of steps, to compare"};
  for (const NamedModel& one : models) {
    if (!std::holds_alternative<OutlineView>(one.model.view)) continue;
    return Error{one.name + ": is a model of an outline, expected models of plain channels; wisp validate judges it"};
  }
  const Preparation& preparation = models.front().model.training.preparation;
  for (const NamedModel& one : models) {
    if (one.model.training.preparation == preparation) continue;
    return Error{one.name + ": was learned from recordings prepared by \"" + text_of(one.model.training.preparation) +
                 "\", the first model by \"" + text_of(preparation) + "\": their fits are of different recordings"};
  }
  const auto prepared = prepare(measured, preparation);
  if (!prepared) return prepared.error();
  const auto said = all_said(models, measured, options, progress);
  if (!said) return said.error();
  Report report;
  ReportSection& section = report.add("Comparison, over the rows that every model predicts");
  section.tables.push_back(table_of(models, *prepared, *said, options.steps));
  add_series(models, *prepared, *said, options.steps.back(), section);
  for (const NamedModel& one : models) warn_of_units(one.model, one.name, measured, report);
  return report;
}

Result<Report> compare(std::span<const NamedModel> models, std::span<const Recording> recordings,
                       const ValidationOptions& options, const Progress& progress) {
  if (recordings.empty()) return Error{"there is no recording to compare on"};
  if (recordings.size() == 1) return compare(models, recordings.front(), options, progress);
  return of_every(recordings, [&](const Recording& one) { return compare(models, one, options, progress); });
}

Result<Report> validate(const Model& model, const Recording& recording, const ValidationOptions& options,
                        const Progress& progress) {
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return validate_chain(model, std::span(&recording, 1), options.seed, progress);
  }
  const bool switched = std::holds_alternative<SwitchedArxModel>(model.dynamics);
  if (switched || !std::holds_alternative<OutlineView>(model.view)) {
    return validate_prepared(model, recording, options, progress);
  }
  auto validated = validate_outline(model, recording, options, progress);
  if (!validated) return validated.error();
  return std::move(validated->report);
}

Result<Report> validate(const Model& model, std::span<const Recording> recordings, const ValidationOptions& options,
                        const Progress& progress) {
  if (recordings.empty()) return Error{model.name + ": there is no recording to validate it on"};
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return validate_chain(model, recordings, options.seed, progress);
  }
  if (recordings.size() == 1) return validate(model, recordings.front(), options, progress);
  if (std::holds_alternative<ArxModel>(model.dynamics) && !std::holds_alternative<OutlineView>(model.view)) {
    return of_every(recordings, [&](const Recording& one) { return validate(model, one, options, progress); });
  }
  return Error{recordings[1].source + ": is one recording too many, expected a single one for a model of this kind"};
}

Result<void> check_rate(const Model& model, const Recording& recording) {
  constexpr double kSame = 1e-3;  // maximum relative difference; errors of clocks and rounded periods are smaller
  if (std::abs(recording.rate_hz - model.rate_hz) <= kSame * model.rate_hz) return {};
  return Error{recording.source + ": has " + number_text(recording.rate_hz, 6) + " samples a second, the model " +
               number_text(model.rate_hz, 6) + ": resample the recording, or learn the model at that rate"};
}

}  // namespace wisp
