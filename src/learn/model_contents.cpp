#include <algorithm>
#include <string>

#include "learn/report/report_values.hpp"
#include "wisp/learn/model_report.hpp"

namespace wisp {
namespace {

using arx::add;
using arx::element;

template <class Values>
ReportList list(const Values& values) {
  return ReportList(values.begin(), values.end());
}

// Splits values into rows of `width` values; for a width of 0, returns the wanted number of empty rows.
template <class Values>
ReportList rows(const Values& values, std::size_t width, std::size_t empty_rows = 0) {
  ReportList out(width == 0 ? empty_rows : 0, ReportList());
  for (std::size_t at = 0; width > 0 && at < values.size(); at += width) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(at);
    out.push_back(ReportList(begin, begin + static_cast<std::ptrdiff_t>(std::min(width, values.size() - at))));
  }
  return out;
}

void add_noise(const ResidualNoise& noise, ReportSection& section) {
  const std::string id = "dynamics.noise.";
  ReportList intervals;
  for (const auto& interval : noise.sd_ci95) intervals.push_back(list(interval));
  add(section, id + "sd", noise.sd);
  add(section, id + "sd_ci95", std::move(intervals));
  const ResampledResiduals& resampled = noise.resampled;
  if (resampled.empty()) return add(section, id + "resampled", {});
  const std::string to = id + "resampled.";
  add(section, to + "scale", resampled.scale);
  add(section, to + "rows", rows(resampled.rows, resampled.scale.size()));
  add(section, to + "ends", list(resampled.ends));
  add(section, to + "wind_scale", resampled.wind_scale);
  add(section, to + "winds", list(resampled.winds));
  add(section, to + "toward", resampled.toward);
  add(section, to + "lags", list(resampled.lags));
  add(section, to + "tolerance", resampled.tolerance);
  add(section, to + "margin", resampled.margin);
  add(section, to + "longest", resampled.longest);
  add(section, to + "mirror", list(resampled.mirror));
  add(section, to + "across", resampled.across);
}

void add_contents(const ArxModel& arx, ReportSection& section) {
  add(section, "dynamics.constant", arx.constant);
  add(section, "dynamics.output_mean", arx.output_mean);
  add(section, "dynamics.input_mean", arx.input_mean);
  add_noise(arx.noise, section);
}

void add_contents(const SwitchedArxModel& switched, ReportSection& section) {
  add(section, "dynamics.output_mean", switched.output_mean);
  add(section, "dynamics.input_mean", switched.input_mean);
}

void add_gust(const GustResponse& gust, ReportSection& section) {
  const auto add_axis = [&](const std::string& id, const GustResponse::Axis& axis) {
    add(section, id + ".change", axis.change);
    add(section, id + ".wind", axis.wind);
    add(section, id + ".press", axis.press);
  };
  add_axis("dynamics.gust.ground", gust.ground);
  add_axis("dynamics.gust.vertical", gust.vertical);
}

void add_drift(const ChainDrift& drift, ReportSection& section) {
  add(section, "dynamics.drift.lead", rows(drift.lead, 3));
  add(section, "dynamics.drift.lead_scale", drift.lead_scale);
  add(section, "dynamics.drift.drift", list(drift.drift));
  add(section, "dynamics.drift.spread_ground", drift.spread_ground);
  add(section, "dynamics.drift.spread_height", drift.spread_height);
  add(section, "dynamics.drift.memory_seconds", drift.memory_seconds);
}

void add_contents(const ChainModel& chain, ReportSection& section) {
  const ChainSegments& segments = chain.segments;
  const std::string id = "dynamics.";
  add(section, id + "motion", chain.motion == ChainMotion::kPose ? "pose" : "position");
  add(section, id + "segment_modes", list(segments.mode));
  add(section, id + "segment_steps", list(segments.steps));
  add(section, id + "rows", rows(segments.rows, static_cast<std::size_t>(channel_count(chain.motion))));
  add(section, id + "row_scale", segments.row_scale);
  add(section, id + "rates", rows(segments.rates, static_cast<std::size_t>(rate_count(chain.motion))));
  add(section, id + "rate_scale", segments.rate_scale);
  add(section, id + "follow", rows(segments.follow, static_cast<std::size_t>(segments.breadth)));
  add(section, id + "height", list(segments.height));
  add(section, id + "height_scale", segments.height_scale);
  add(section, id + "probabilities", rows(chain.probabilities, static_cast<std::size_t>(chain.modes)));
  chain.gust ? add_gust(*chain.gust, section) : add(section, id + "gust", {});
  chain.drift ? add_drift(*chain.drift, section) : add(section, id + "drift", {});
}

const char* form_of(InputShape shape) {
  switch (shape) {
    case InputShape::kLinear:
      return "linear";
    case InputShape::kEvenOdd:
      return "even_odd";
    case InputShape::kWindAlong:
      return "wind_along";
    case InputShape::kWindAcross:
      return "wind_across";
  }
  return "";
}

const char* word_of(Origin origin) {
  return origin == Origin::kLearned ? "learned" : origin == Origin::kGiven ? "given" : "default";
}

void add_events(const std::string& id, const FlameEvents& own, const FlameEvents& played, ReportSection& section) {
  add(section, id + ".borrowed", own.empty());
  add(section, id + ".sizes", list(played.sizes));
  add(section, id + ".ends", list(played.ends));
  add(section, id + ".scale", list(played.scale));
  add(section, id + ".shapes", list(played.shapes));
}

void add_extinction(const std::string& id, const ExtinctionTraining& made, ReportSection& section) {
  add(section, id + ".origin", word_of(made.origin));
  add(section, id + ".deaths", made.deaths);
  add(section, id + ".died", made.died);
  add(section, id + ".gusts", made.gusts);
  add(section, id + ".spared", made.spared);
  add(section, id + ".vanishing_seconds", made.vanishing_seconds);
}

void add_training(const Training& made, ReportSection& section) {
  const std::string id = "training.";
  add(section, id + "program", made.program);
  add(section, id + "sources", list(made.sources));
  ReportTable recipe{"training.recipe", "", {{"name", ""}, {"value", ""}}, {}};
  for (const Note& note : made.recipe) recipe.rows.push_back({note.name, note.value});
  ReportTable figures{"training.figures", "", {{"name", ""}, {"value", ""}}, {}};
  for (const Figure& figure : made.figures) figures.rows.push_back({figure.name, figure.value});
  ReportTable inputs{"training.inputs", "", {{"scale", ""}, {"one_rms", ""}}, {}};
  for (const InputTraining& input : made.inputs) inputs.rows.push_back({input.scale, input.one_rms});
  section.tables.insert(section.tables.end(), {std::move(recipe), std::move(figures), std::move(inputs)});
  add(section, id + "residual_sd", made.residual_sd);
  add(section, id + "underside", made.underside ? ReportValue(*made.underside) : ReportValue());
  if (made.motion) {
    add(section, id + "motion.event", made.motion->event);
    add(section, id + "motion.min_seconds", made.motion->min_seconds);
    add(section, id + "motion.debounce", made.motion->debounce);
    add(section, id + "motion.smooth_rows", made.motion->smooth_rows);
  } else {
    add(section, id + "motion", {});
  }
  if (made.extinction) {
    add_extinction(id + "extinction", *made.extinction, section);
  } else {
    add(section, id + "extinction", {});
  }
  add(section, id + "multiply_adds_per_frame", made.multiply_adds_per_frame);
  add(section, id + "operations_per_frame", made.operations_per_frame);
}

}  // namespace

Report model_contents(const Model& model) {
  Report report;
  ReportSection& section = report.add("");
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    add(section, element("inputs", k, "form"), form_of(model.inputs[k].shape));
  }
  std::visit([&](const auto& dynamics) { add_contents(dynamics, section); }, model.dynamics);
  if (model.extinction) {
    const Extinction& rule = *model.extinction;
    add_events("extinction.dying", rule.dying, dying_of(rule, model.rate_hz), section);
    add_events("extinction.catching", rule.catching, catching_of(rule, model.rate_hz), section);
  }
  add_training(model.training, section);
  add(section, "random.generator", "Philox4x32-7");
  add(section, "random.deviates", "Box-Muller");
  return report;
}

}  // namespace wisp
