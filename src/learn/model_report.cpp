#include "wisp/learn/model_report.hpp"

#include <algorithm>

#include "learn/flame/extinction_learning.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learn/report/fit_report.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/prepare.hpp"
#include "wisp/run/cost.hpp"

namespace wisp {
namespace {

using arx::add;
using arx::add_all;
using arx::element;

std::string shape_text(InputShape shape) {
  if (!has_powers(shape)) return "linear";
  return std::string("size and sign, its square root and its square") + (is_vector(shape) ? ", of a vector" : "");
}

void add_inputs(const std::vector<Input>& inputs, ReportSection& section) {
  ReportList names;
  for (const Input& input : inputs) names.push_back(input.name);
  add(section, inputs.empty() ? "inputs" : "", inputs.empty() ? ReportValue(ReportList()) : names,
      inputs.empty() ? "" : "inputs");
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const Input& input = inputs[k];
    add(section, element("inputs", k, "name"), input.name);
    add(section, element("inputs", k, "unit"), input.unit);
    add(section, element("inputs", k, "range"), ReportList{input.lowest, input.highest});
    add(section, element("inputs", k, "shape"), shape_text(input.shape));
  }
}

void add_outputs(const std::vector<Output>& outputs, ReportSection& section) {
  ReportList names;
  ReportTable table{"outputs", "", {{"name", ""}, {"unit", ""}, {"range", ""}}, {}};
  for (const Output& output : outputs) {
    names.push_back(output.name);
    table.rows.push_back({output.name, output.unit, ReportList{output.lowest, output.highest}});
  }
  add(section, "", std::move(names), "outputs");
  section.tables.push_back(std::move(table));
}

void add_orders(const ArxOrders& orders, ReportSection& section) {
  arx::add_orders(orders, "dynamics.", section);
  add(section, "dynamics.history", orders.history());
}

std::string samples(int history) { return "a history of " + std::to_string(history) + " samples"; }

void add_dynamics(const ArxModel& arx, ReportSection& section) {
  const double radius = spectral_radius(arx);
  add(section, "dynamics.kind", "arx");
  add_orders(arx.orders, section);
  add(section, "dynamics.radius", radius);
  add(section, "", "arx, " + samples(arx.orders.history()) + ", spectral radius " + number_text(radius, 5), "dynamics");
  arx::describe(arx, "dynamics.", section);
}

void add_dynamics(const SwitchedArxModel& switching, ReportSection& section) {
  add(section, "dynamics.kind", "switched arx");
  add_orders(switching.orders, section);
  add(section, "",
      "arx of " + std::to_string(switching.modes.size()) + " modes switched by a Markov chain, " +
          samples(switching.orders.history()),
      "dynamics");
  markov::describe(switching, "dynamics.", section);
}

void add_shape(const ShapeComponents& shape, ReportSection& section) {
  if (shape.empty()) return add(section, "view.shape", {});
  const auto ends = [](const std::vector<ValueRange>& ranges) {
    ReportList list;
    for (const ValueRange& range : ranges) list.push_back(ReportList{range.lowest, range.highest});
    return list;
  };
  add_all(section, "view.shape.", "symmetric", shape.symmetric, "antisymmetric", shape.antisymmetric, "across",
          shape.across, "rest", shape.rest, "basis", shape.basis, "coordinates", ends(shape.coordinates), "components",
          ends(shape.components));
}

void add_dynamics(const ChainModel& chain, ReportSection& section) {
  add_all(section, "dynamics.", "kind", "chain", "segments", chain.segments.size(), "modes", chain.modes, "history",
          chain.history, "heading_free", chain.heading_free, "best_of", chain.segments.breadth, "blend_steps",
          chain.blend_steps, "initial", chain.initial, "transitions",
          arx::matrix_of(chain.transitions(), static_cast<std::size_t>(chain.modes)));
  add(section, "",
      "chain of " + std::to_string(chain.segments.size()) + " segments" +
          (chain.modes > 1
               ? " in " + std::to_string(chain.modes) + " modes, each by the last " + std::to_string(chain.history)
               : ""),
      "dynamics");
}

struct ViewFields {
  const Model& model;
  ReportSection& section;

  void kind(const char* word) const { add(section, "view.kind", word, "view"); }
  void operator()(const PlainView&) const { kind("plain"); }
  void operator()(const PoseView& pose) const {
    kind("pose");
    add_all(section, "view.", "half_width", pose.half_width, "half_length", pose.half_length);
  }
  void operator()(const PositionView& position) const {
    kind("position");
    add(section, "view.half_width", position.half_width);
  }
  void operator()(const OutlineView& outline) const {
    kind("outline");
    add_all(section, "view.", "points", model.outputs.size() / 2, "knots", outline.knots);
    add_shape(outline.shape, section);
    add(section, "view.in_the_round", is_in_the_round(model) ? "recorded" : in_the_round(model) ? "symmetry" : "no");
    if (!is_in_the_round(model) && in_the_round(model)) {
      add(section, "", "a body by the assumption of rotational symmetry", "in the round");
    }
    add_all(section, "view.", "metres_per_unit", outline.metres_per_unit, "pixels_per_unit", outline.pixels_per_unit);
  }
};

ReportSection made_section(const Training& made) {
  ReportSection section{"Training"};
  add(section, "made.program", made.program, "by");
  add(section, "made.sources", ReportList(made.sources.begin(), made.sources.end()), "from");
  if (made.preparation != Preparation{}) add(section, "made.preparation", text_of(made.preparation), "prepared by");
  if (made.own_levels) add(section, "made.own_levels", true, "each recording about its own means");
  for (const Note& note : made.recipe) {
    add(section, "made.options." + arx::as_id(note.name), note.value, "option " + note.name);
  }
  for (const Figure& figure : made.figures) {
    add(section, "made.figures." + arx::as_id(figure.name), figure.value, "figure " + figure.name);
  }
  return section;
}

// Parts of model_contents(): the fields of a file that model_report() omits.

template <class Values>
ReportList list(const Values& values) {
  return ReportList(values.begin(), values.end());
}

// Splits values into rows of `width` values; none for a width of 0.
template <class Values>
ReportList rows(const Values& values, std::size_t width) {
  ReportList out;
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
  add_all(section, id, "sd", noise.sd, "sd_ci95", std::move(intervals));
  const ResampledResiduals& resampled = noise.resampled;
  if (resampled.empty()) return add(section, id + "resampled", {});
  const std::string to = id + "resampled.";
  add_all(section, to, "scale", resampled.scale, "rows", rows(resampled.rows, resampled.scale.size()), "ends",
          list(resampled.ends), "wind_scale", resampled.wind_scale, "winds", list(resampled.winds), "toward",
          resampled.toward, "lags", list(resampled.lags), "tolerance", resampled.tolerance, "margin", resampled.margin,
          "longest", resampled.longest, "mirror", list(resampled.mirror), "across", resampled.across);
}

void add_contents(const ArxModel& arx, ReportSection& section) {
  add_all(section, "dynamics.", "constant", arx.constant, "output_mean", arx.output_mean, "input_mean", arx.input_mean);
  add_noise(arx.noise, section);
}

void add_contents(const SwitchedArxModel& switched, ReportSection& section) {
  add_all(section, "dynamics.", "output_mean", switched.output_mean, "input_mean", switched.input_mean);
}

void add_gust(const GustResponse& gust, ReportSection& section) {
  const auto add_axis = [&](const std::string& id, const GustResponse::Axis& axis) {
    add_all(section, id + ".", "change", axis.change, "wind", axis.wind, "press", axis.press);
  };
  add_axis("dynamics.gust.ground", gust.ground);
  add_axis("dynamics.gust.vertical", gust.vertical);
}

void add_drift(const ChainDrift& drift, ReportSection& section) {
  add_all(section, "dynamics.drift.", "lead", rows(drift.lead, 3), "lead_scale", drift.lead_scale, "drift",
          list(drift.drift), "spread_ground", drift.spread_ground, "spread_height", drift.spread_height,
          "memory_seconds", drift.memory_seconds);
}

void add_contents(const ChainModel& chain, ReportSection& section) {
  const ChainSegments& segments = chain.segments;
  const std::string id = "dynamics.";
  add_all(section, id, "motion", chain.motion == ChainMotion::kPose ? "pose" : "position", "segment_modes",
          list(segments.mode), "segment_steps", list(segments.steps), "rows",
          rows(segments.rows, static_cast<std::size_t>(channel_count(chain.motion))), "row_scale", segments.row_scale,
          "rates", rows(segments.rates, static_cast<std::size_t>(rate_count(chain.motion))), "rate_scale",
          segments.rate_scale, "follow", rows(segments.follow, static_cast<std::size_t>(segments.breadth)), "height",
          list(segments.height), "height_scale", segments.height_scale, "probabilities",
          rows(chain.probabilities, static_cast<std::size_t>(chain.modes)));
  chain.gust ? add_gust(*chain.gust, section) : add(section, id + "gust", {});
  chain.drift ? add_drift(*chain.drift, section) : add(section, id + "drift", {});
}

constexpr const char* kForms[] = {"linear", "even_odd", "wind_along", "wind_across"};  // indexed by InputShape

void add_events(const std::string& id, const FlameEvents& own, const FlameEvents& played, ReportSection& section) {
  add_all(section, id + ".", "borrowed", own.empty(), "sizes", list(played.sizes), "ends", list(played.ends), "scale",
          list(played.scale), "shapes", list(played.shapes));
}

void add_extinction(const std::string& id, const ExtinctionTraining& made, ReportSection& section) {
  add_all(section, id + ".", "origin", word_of(made.origin), "deaths", made.deaths, "died", made.died, "gusts",
          made.gusts, "spared", made.spared, "vanishing_seconds", made.vanishing_seconds);
}

void add_training(const Training& made, ReportSection& section) {
  const std::string id = "training.";
  add_all(section, id, "program", made.program, "sources", list(made.sources));
  ReportTable recipe{"training.recipe", "", {{"name", ""}, {"value", ""}}, {}};
  for (const Note& note : made.recipe) recipe.rows.push_back({note.name, note.value});
  ReportTable figures{"training.figures", "", {{"name", ""}, {"value", ""}}, {}};
  for (const Figure& figure : made.figures) figures.rows.push_back({figure.name, figure.value});
  ReportTable inputs{"training.inputs", "", {{"scale", ""}, {"one_rms", ""}}, {}};
  for (const InputTraining& input : made.inputs) inputs.rows.push_back({input.scale, input.one_rms});
  section.tables.insert(section.tables.end(), {std::move(recipe), std::move(figures), std::move(inputs)});
  add_all(section, id, "residual_sd", made.residual_sd, "underside",
          made.underside ? ReportValue(*made.underside) : ReportValue());
  if (made.motion) {
    add_all(section, id, "motion.event", made.motion->event, "motion.min_seconds", made.motion->min_seconds,
            "motion.debounce", made.motion->debounce, "motion.smooth_rows", made.motion->smooth_rows);
  } else {
    add(section, id + "motion", {});
  }
  made.extinction ? add_extinction(id + "extinction", *made.extinction, section) : add(section, id + "extinction", {});
  add_all(section, id, "multiply_adds_per_frame", made.multiply_adds_per_frame, "operations_per_frame",
          made.operations_per_frame);
}

}  // namespace

Result<Report> model_report(const Model& model) {
  const auto cost = count_operations(model);
  if (!cost) return cost.error();
  Report report;
  report.verdict = ReportVerdict{model.training.usable.verdict, model.training.usable.reason};
  ReportSection& section = report.add("Model");
  add(section, "name", model.name, "name");
  add(section, "rate_hz", model.rate_hz, "rate", "steps a second");
  std::visit(ViewFields{model, section}, model.view);
  add_inputs(model.inputs, section);
  add_outputs(model.outputs, section);
  std::visit([&](const auto& dynamics) { add_dynamics(dynamics, section); }, model.dynamics);
  if (const auto* plain = std::get_if<ArxModel>(&model.dynamics)) {
    const bool named = std::holds_alternative<PlainView>(model.view) &&
                       plain->orders.inputs() == static_cast<int>(model.inputs.size());
    named ? arx::tell(*plain, model, report) : arx::tell_poles(*plain, model.rate_hz, report);
  }
  report.sections.push_back(arx::cost_section(*cost));
  report.sections.push_back(extinction_section(model));
  report.sections.push_back(made_section(model.training));
  return report;
}

Report model_contents(const Model& model) {
  Report report;
  ReportSection& section = report.add("");
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    add(section, element("inputs", k, "form"), kForms[static_cast<std::size_t>(model.inputs[k].shape)]);
  }
  std::visit([&](const auto& dynamics) { add_contents(dynamics, section); }, model.dynamics);
  if (model.extinction) {
    const Extinction& rule = *model.extinction;
    add_events("extinction.dying", rule.dying, dying_of(rule, model.rate_hz), section);
    add_events("extinction.catching", rule.catching, catching_of(rule, model.rate_hz), section);
  }
  add_training(model.training, section);
  add_all(section, "random.", "generator", "Philox4x32-7", "deviates", "Box-Muller");
  return report;
}

}  // namespace wisp
