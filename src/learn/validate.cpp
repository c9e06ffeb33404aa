#include "wisp/learn/validate.hpp"

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

constexpr double kBadlyFitted = 30;  // percentage points of fit below the median over recordings

// Joins the same table of several reports, with the recording's name first in each row.
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

// Warns of recordings whose last fit is far below the median of the others.
void name_badly_fitted(const ReportTable& all, Report& report) {
  std::size_t column = 0;
  for (std::size_t c = 0; c < all.columns.size(); ++c) {
    if (all.columns[c].id.starts_with("fit_percent.")) column = c;
  }
  std::vector<double> fits;
  for (const auto& row : all.rows) {
    if (const auto* fit = std::get_if<double>(&row[column])) fits.push_back(*fit);
  }
  const double middle = median(fits);
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

}  // namespace

Result<Report> compare(std::span<const NamedModel> models, std::span<const Recording> recordings,
                       const ValidationOptions& options, const Progress& progress) {
  if (recordings.empty()) return Error{"there is no recording to compare on"};
  if (recordings.size() == 1) return compare(models, recordings.front(), options, progress);
  return of_every(recordings, [&](const Recording& one) { return compare(models, one, options, progress); });
}

namespace {

// Validates on a recording after preparing it as in training.
Result<Report> validate_prepared(const Model& model, const Recording& recording, const ValidationOptions& options,
                                 const Progress& progress) {
  const auto prepared = prepare(recording, model.training.preparation);
  if (!prepared) return prepared.error();
  if (auto ok = check_rate(model, *prepared); !ok) return ok.error();
  auto report = validate_arx(model, *prepared, options, progress);
  if (report && model.training.preparation != Preparation{}) {
    arx::add(report->sections.front(), "preparation", text_of(model.training.preparation), "prepared by", "",
             "as the recordings that the model was learned from");
  }
  return report;
}

}  // namespace

Result<Report> validate(const Model& model, const Recording& recording, const ValidationOptions& options,
                        const Progress& progress) {
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return validate_chain(model, std::span(&recording, 1), options.seed, progress);
  }
  const bool outline = std::holds_alternative<OutlineView>(model.view);
  if (std::holds_alternative<SwitchedArxModel>(model.dynamics)) {
    if (auto ok = check_rate(model, recording); !ok) return ok.error();
    return validate_switched(model, recording, options, progress);
  }
  if (!outline) return validate_prepared(model, recording, options, progress);
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
  constexpr double kSame = 1e-3;  // clocks and rounded periods differ by less
  if (std::abs(recording.rate_hz - model.rate_hz) <= kSame * model.rate_hz) return {};
  return Error{recording.source + ": has " + number_text(recording.rate_hz, 6) + " samples a second, the model " +
               number_text(model.rate_hz, 6) + ": resample the recording, or learn the model at that rate"};
}

}  // namespace wisp
