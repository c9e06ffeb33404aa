// Python classes of recipes, and functions prepare, advise, learn, validate and in_model_units.

#include <algorithm>
#include <cctype>
#include <cmath>

#include "module.hpp"
#include "wisp/learn.hpp"
#include "wisp/learn/advice.hpp"
#include "wisp/learn/prepare.hpp"

namespace wisp::python {
namespace {

// Binds an enumeration; its values are named by the command line's words, in capitals.
template <class Enumeration>
void bind_words(py::module_& module, const char* name) {
  py::enum_<Enumeration> words(module, name);
  for (const std::string_view word : kWordsOf<Enumeration>) {
    std::string capitals(word);
    std::transform(capitals.begin(), capitals.end(), capitals.begin(), [](unsigned char c) { return std::toupper(c); });
    words.value(capitals.c_str(), *value_of<Enumeration>(word));
  }
}

// Binds a field as a property: orders as plain numbers, events and realisations as the command line's words.
template <class Class, class Recipe, class Value>
void bind_field(Class& to, const RecipeField<Recipe, Value>& field, const char* help) {
  const auto member = field.member;
  if constexpr (std::is_same_v<Value, EventSpec>) {
    to.def_property(
        field.name, [member](const Recipe& r) { return word_of(r.*member); },
        [member](Recipe& r, const std::string& word) { r.*member = unwrapped(parse_event(word)); }, help);
  } else if constexpr (std::is_same_v<Value, Realisation>) {
    to.def_property(
        field.name, [member](const Recipe& r) { return std::string(word_of(r.*member)); },
        [member](Recipe& r, const std::string& word) {
          const auto value = value_of<Realisation>(word);
          if (!value)
            throw Failure("the realisation is \"" + word + "\", expected segments, spline, linear, ode or chain");
          r.*member = *value;
        },
        help);
  } else if constexpr (std::is_same_v<Value, OrderChoice>) {
    to.def_property(
        field.name, [member](const Recipe& r) { return r.*member; },
        [member](Recipe& r, int order) { r.*member = order; }, help);
  } else if constexpr (std::is_same_v<Value, std::optional<OrderChoice>>) {
    to.def_property(
        field.name, [member](const Recipe& r) { return r.*member; },
        [member](Recipe& r, std::optional<int> order) {
          r.*member = order ? std::optional<OrderChoice>(*order) : std::nullopt;
        },
        help);
  } else {
    to.def_readwrite(field.name, member, help);
  }
}

// Binds a recipe: its fields, with help and ranges from the table.
template <class Recipe>
void bind_recipe(py::module_& module, const char* name) {
  Options<Recipe> made(module, name);
  for_each_field(Recipe{}, [&](const auto& field) {
    std::string help = field.help;
    const FieldTraits& traits = field.traits;
    if (std::isfinite(traits.highest)) help += "; " + range_text(traits.lowest, traits.highest);
    bind_field(static_cast<py::class_<Recipe>&>(made), field, help.c_str());
  });
}

// Binds types of recipe fields other than numbers, words and names.
void bind_parts(py::module_& module) {
  py::class_<OrderRange>(module, "OrderRange")
      .def(py::init([](int first, int last) {
             return OrderRange{first, last};
           }),
           py::arg("first"), py::arg("last"))
      .def_readwrite("first", &OrderRange::first)
      .def_readwrite("last", &OrderRange::last);
  options<ExtinctionRecipe>(module, "ExtinctionRecipe")
      .def_readwrite("source", &ExtinctionRecipe::source)
      .def_readwrite("level", &ExtinctionRecipe::level)
      .def_readwrite("seconds", &ExtinctionRecipe::seconds);
  options<Preparation>(module, "Preparation")
      .def_readwrite("detrend", &Preparation::detrend)
      .def_readwrite("highpass_hz", &Preparation::highpass_hz)
      .def_readwrite("lowpass_hz", &Preparation::lowpass_hz)
      .def_readwrite("resample_hz", &Preparation::resample_hz);
  module.def(
      "prepare", [](const Recording& recording, const Preparation& how) { return unwrapped(prepare(recording, how)); },
      py::arg("recording"), py::arg("preparation"),
      "The recording without its straight lines, filtered, and at another rate, as the preparation says.");
  module.def("advise", &advise, py::arg("recording"),
             "What there is to see in a recording before any model: rate, channels, and what will spoil a model, with "
             "cures.");
  options<ArxSearch>(module, "ArxSearch")
      .def_readwrite("na", &ArxSearch::na)
      .def_readwrite("nb", &ArxSearch::nb)
      .def_readwrite("nk", &ArxSearch::nk)
      .def_readwrite("by", &ArxSearch::by)
      .def_readwrite("steps", &ArxSearch::steps)
      .def_readwrite("validation", &ArxSearch::validation);
}

Fit learned(const std::vector<Recording>& recordings, const Recipe& recipe, py::object progress) {
  return Watch(std::move(progress)).run([&](const Progress& watch) { return learn(recordings, recipe, watch); });
}

}  // namespace

void bind_recipes(py::module_& module) {
  bind_words<ArxOffset>(module, "ArxOffset");
  bind_words<ArxFocus>(module, "ArxFocus");
  bind_words<ArxKernel>(module, "ArxKernel");
  bind_words<Coupling>(module, "Coupling");
  bind_words<OrderCriterion>(module, "OrderCriterion");
  bind_words<InitialState>(module, "InitialState");
  bind_words<ExtinctionSource>(module, "ExtinctionSource");
  bind_parts(module);
  bind_recipe<ArxRecipe>(module, "ArxRecipe");
  bind_recipe<SwitchedRecipe>(module, "SwitchedRecipe");
  bind_recipe<FlickerRecipe>(module, "FlickerRecipe");
  bind_recipe<OutlineRecipe>(module, "OutlineRecipe");
  options<FlameRecipe, OutlineRecipe>(module, "FlameRecipe");
  bind_recipe<ChainRecipe>(module, "ChainRecipe");
  options<LeafRecipe, ChainRecipe>(module, "LeafRecipe");
  py::class_<Fit>(module, "Fit").def_readonly("model", &Fit::model).def_readonly("report", &Fit::report);
  // The overload for one recording comes first: a recording has a length, and would match a list.
  module.def(
      "learn",
      [](const Recording& recording, const Recipe& recipe, py::object progress) {
        return learned({recording}, recipe, std::move(progress));
      },
      py::arg("recording"), py::arg("recipe"), py::kw_only(), py::arg("progress") = py::none(),
      "Learns a model from one recording or a list of them.");
  module.def("learn", &learned, py::arg("recordings"), py::arg("recipe"), py::kw_only(),
             py::arg("progress") = py::none());
  options<ValidationOptions>(module, "ValidationOptions")
      .def_readwrite("steps", &ValidationOptions::steps)
      .def_readwrite("initial", &ValidationOptions::initial)
      .def_readwrite("responses", &ValidationOptions::responses)
      .def_readwrite("play_seconds", &ValidationOptions::play_seconds)
      .def_readwrite("fidelity", &ValidationOptions::fidelity)
      .def_readwrite("seed", &ValidationOptions::seed);
  module.def(
      "validate",
      [](const Model& model, const Recording& recording, const ValidationOptions& how, py::object progress) {
        return Watch(std::move(progress)).run([&](const Progress& watch) {
          return validate(model, recording, how, watch);
        });
      },
      py::arg("model"), py::arg("recording"), py::arg("options") = ValidationOptions{}, py::kw_only(),
      py::arg("progress") = py::none(), "Holds a model against a recording that it was not learned from.");
  module.attr("FREE_RUN") = kFreeRun;
  module.def(
      "in_model_units",
      [](const Model& model, const Recording& recording, bool own_gain) {
        std::vector<std::string> names;
        for (const Input& input : model.inputs) names.push_back(input.name);
        return unwrapped(in_model_units(model, recording, names, own_gain));
      },
      py::arg("model"), py::arg("recording"), py::kw_only(), py::arg("own_gain") = false,
      "A recording whose inputs are in the model's units: what a bank takes.");
}

}  // namespace wisp::python
