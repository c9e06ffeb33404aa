#include "wisp/learn/model_report.hpp"

#include <span>

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
  add(section, "dynamics.na", arx::list_of(orders.na));
  add(section, "dynamics.nb", arx::list_of(orders.nb));
  add(section, "dynamics.nk", arx::list_of(orders.nk));
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
  add(section, "view.shape.symmetric", shape.symmetric);
  add(section, "view.shape.antisymmetric", shape.antisymmetric);
  add(section, "view.shape.across", shape.across);
  add(section, "view.shape.rest", shape.rest);
  add(section, "view.shape.basis", shape.basis);
  add(section, "view.shape.coordinates", ends(shape.coordinates));
  add(section, "view.shape.components", ends(shape.components));
}

void add_dynamics(const ChainModel& chain, ReportSection& section) {
  add(section, "dynamics.kind", "chain");
  add(section, "dynamics.segments", chain.segments.size());
  add(section, "dynamics.modes", chain.modes);
  add(section, "dynamics.history", chain.history);
  add(section, "dynamics.heading_free", chain.heading_free);
  add(section, "dynamics.best_of", chain.segments.breadth);
  add(section, "dynamics.blend_steps", chain.blend_steps);
  add(section, "dynamics.initial", chain.initial);
  add(section, "dynamics.transitions", arx::matrix_of(chain.transitions(), static_cast<std::size_t>(chain.modes)));
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
    add(section, "view.half_width", pose.half_width);
    add(section, "view.half_length", pose.half_length);
  }
  void operator()(const PositionView& position) const {
    kind("position");
    add(section, "view.half_width", position.half_width);
  }
  void operator()(const OutlineView& outline) const {
    kind("outline");
    add(section, "view.points", model.outputs.size() / 2);
    add(section, "view.knots", outline.knots);
    add_shape(outline.shape, section);
    add(section, "view.in_the_round", is_in_the_round(model) ? "recorded" : in_the_round(model) ? "symmetry" : "no");
    if (!is_in_the_round(model) && in_the_round(model)) {
      add(section, "", "a body by the assumption of rotational symmetry", "in the round");
    }
    add(section, "view.metres_per_unit", outline.metres_per_unit);
    add(section, "view.pixels_per_unit", outline.pixels_per_unit);
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

}  // namespace wisp
