// Recipes, learn and validate.

#include "module.hpp"
#include "wisp/learn.hpp"
#include "wisp/learn/advice.hpp"
#include "wisp/learn/prepare.hpp"

namespace wisp::python {
namespace {

void bind_words(py::module_& module) {
  py::enum_<ArxOffset>(module, "ArxOffset")
      .value("MEAN", ArxOffset::kMean)
      .value("NONE", ArxOffset::kNone)
      .value("ESTIMATE", ArxOffset::kEstimate);
  py::enum_<ArxFocus>(module, "ArxFocus")
      .value("PREDICTION", ArxFocus::kPrediction)
      .value("SIMULATION", ArxFocus::kSimulation)
      .value("AUTO", ArxFocus::kAuto);
  py::enum_<ArxKernel>(module, "ArxKernel").value("NONE", ArxKernel::kNone).value("TC", ArxKernel::kTc);
  py::enum_<Coupling>(module, "Coupling")
      .value("FULL", Coupling::kFull)
      .value("DIAGONAL", Coupling::kDiagonal)
      .value("BAND", Coupling::kBand);
  py::enum_<OrderCriterion>(module, "OrderCriterion")
      .value("FPE", OrderCriterion::kFpe)
      .value("AIC", OrderCriterion::kAic)
      .value("AICC", OrderCriterion::kAicc)
      .value("BIC", OrderCriterion::kBic)
      .value("VALIDATION", OrderCriterion::kValidation);
  py::enum_<InitialState>(module, "InitialState")
      .value("MEASURED", InitialState::kMeasured)
      .value("ZERO", InitialState::kZero)
      .value("ESTIMATED", InitialState::kEstimated);
}

void bind_arx(py::module_& module) {
  py::class_<OrderRange>(module, "OrderRange")
      .def(py::init([](int first, int last) {
             return OrderRange{first, last};
           }),
           py::arg("first"), py::arg("last"))
      .def_readwrite("first", &OrderRange::first)
      .def_readwrite("last", &OrderRange::last);
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
  options<ArxRecipe>(module, "ArxRecipe")
      .def_readwrite("name", &ArxRecipe::name)
      .def_readwrite("inputs", &ArxRecipe::inputs)
      .def_readwrite("outputs", &ArxRecipe::outputs)
      .def_property(
          "na", [](const ArxRecipe& r) { return r.na; }, [](ArxRecipe& r, int order) { r.na = order; })
      .def_property(
          "nb", [](const ArxRecipe& r) { return r.nb; }, [](ArxRecipe& r, int order) { r.nb = order; })
      .def_property(
          "nk", [](const ArxRecipe& r) { return r.nk; },
          [](ArxRecipe& r, std::optional<int> delay) {
            r.nk.reset();
            if (delay) r.nk = *delay;
          })
      .def_readwrite("coupling", &ArxRecipe::coupling)
      .def_readwrite("offset", &ArxRecipe::offset)
      .def_readwrite("preparation", &ArxRecipe::preparation)
      .def_readwrite("kernel", &ArxRecipe::kernel)
      .def_readwrite("radius", &ArxRecipe::radius)
      .def_readwrite("keep_unstable", &ArxRecipe::keep_unstable)
      .def_readwrite("search", &ArxRecipe::search)
      .def_readwrite("focus", &ArxRecipe::focus)
      .def_readwrite("responses", &ArxRecipe::responses);
  options<SwitchedRecipe>(module, "SwitchedRecipe")
      .def_readwrite("name", &SwitchedRecipe::name)
      .def_readwrite("inputs", &SwitchedRecipe::inputs)
      .def_readwrite("outputs", &SwitchedRecipe::outputs)
      .def_readwrite("modes", &SwitchedRecipe::modes)
      .def_readwrite("seed", &SwitchedRecipe::seed);
  options<FlickerRecipe>(module, "FlickerRecipe")
      .def_readwrite("name", &FlickerRecipe::name)
      .def_readwrite("output", &FlickerRecipe::output)
      .def_readwrite("rate_hz", &FlickerRecipe::rate_hz)
      .def_readwrite("modes", &FlickerRecipe::modes)
      .def_readwrite("order", &FlickerRecipe::order)
      .def_readwrite("seed", &FlickerRecipe::seed);
}

void bind_outlines(py::module_& module) {
  options<OutlineRecipe>(module, "OutlineRecipe")
      .def_readwrite("paper", &OutlineRecipe::paper)
      .def_readwrite("align", &OutlineRecipe::align)
      .def_readwrite("inputs", &OutlineRecipe::inputs)
      .def_readwrite("holdout", &OutlineRecipe::holdout)
      .def_readwrite("seed", &OutlineRecipe::seed)
      .def_readwrite("name", &OutlineRecipe::name);
  options<FlameRecipe, OutlineRecipe>(module, "FlameRecipe");
}

void bind_chains(py::module_& module) {
  options<ChainRecipe>(module, "ChainRecipe")
      .def_readwrite("name", &ChainRecipe::name)
      .def_property(
          "event", [](const ChainRecipe& r) { return word_of(r.event); },
          [](ChainRecipe& r, const std::string& word) { r.event = unwrapped(parse_event(word)); })
      .def_property(
          "realisation", [](const ChainRecipe& r) { return std::string(word_of(r.realisation)); },
          [](ChainRecipe& r, const std::string& word) { r.realisation = unwrapped(parse_realisation(word)); })
      .def_readwrite("modes", &ChainRecipe::modes)
      .def_readwrite("history", &ChainRecipe::history)
      .def_readwrite("best_of", &ChainRecipe::best_of)
      .def_readwrite("min_seconds", &ChainRecipe::min_seconds)
      .def_readwrite("max_bytes", &ChainRecipe::max_bytes)
      .def_readwrite("holdout", &ChainRecipe::holdout)
      .def_readwrite("half_width", &ChainRecipe::half_width)
      .def_readwrite("half_length", &ChainRecipe::half_length)
      .def_readwrite("seed", &ChainRecipe::seed);
  options<LeafRecipe, ChainRecipe>(module, "LeafRecipe");
}

Fit learned(const std::vector<Recording>& recordings, const Recipe& recipe, py::object progress) {
  return Watch(std::move(progress)).run([&](const Progress& watch) { return learn(recordings, recipe, watch); });
}

}  // namespace

void bind_recipes(py::module_& module) {
  bind_words(module);
  bind_arx(module);
  bind_outlines(module);
  bind_chains(module);
  py::class_<Fit>(module, "Fit").def_readonly("model", &Fit::model).def_readonly("report", &Fit::report);
  // The one recording first: it has rows, and would pass for a list.
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
