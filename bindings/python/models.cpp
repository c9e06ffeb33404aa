// Python class Model.

#include <algorithm>
#include <span>

#include "module.hpp"
#include "wisp/base/file.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/file.hpp"

namespace wisp::python {
namespace {

py::bytes bytes_of(const Model& model) {
  const auto bytes = unwrapped(model_bytes(model));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Model from_bytes(const py::bytes& bytes) {
  const std::string_view view = bytes;
  return unwrapped(parse_model(std::as_bytes(std::span(view)), "model"));
}

template <class Channels>
std::vector<std::string> names(const Channels& channels) {
  std::vector<std::string> found;
  for (const auto& channel : channels) found.push_back(channel.name);
  return found;
}

const char* kind_of(const ArxModel&) { return "arx"; }
const char* kind_of(const SwitchedArxModel&) { return "switched"; }
const char* kind_of(const ChainModel&) { return "chain"; }

const char* word_of(const View& view) {
  constexpr const char* kWords[] = {"plain", "outline", "pose", "position"};
  return kWords[std::holds_alternative<OutlineView>(view)    ? 1
                : std::holds_alternative<PoseView>(view)     ? 2
                : std::holds_alternative<PositionView>(view) ? 3
                                                             : 0];
}

// Returns the ARX models of all modes.
std::vector<ArxModel> arx_of(const Model& model) {
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) return {*arx};
  std::vector<ArxModel> modes;
  if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    for (std::size_t mode = 0; mode < switched->modes.size(); ++mode) modes.push_back(mode_model(*switched, mode));
    return modes;
  }
  throw py::attribute_error("the model is a chain of segments, which has no coefficients");
}

// Returns dense coefficients [mode, if switched][lag][output][column]; columns are outputs for A, inputs for B.
py::array_t<double> coefficients(const Model& model, bool of_inputs) {
  const auto modes = arx_of(model);
  const int outputs = modes[0].orders.outputs(), columns = of_inputs ? modes[0].orders.inputs() : outputs;
  int lags = 0;
  for (int i = 0; i < outputs; ++i) {
    for (int k = 0; k < columns; ++k) {
      const ArxOrders& orders = modes[0].orders;
      lags = std::max(lags, of_inputs ? orders.nk(i, k) + orders.nb(i, k) : orders.na(i, k));
    }
  }
  py::array_t<double> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(modes.size()), lags, outputs, columns});
  auto values = array.mutable_unchecked<4>();
  std::fill_n(array.mutable_data(), array.size(), 0.0);
  for (std::size_t mode = 0; mode < modes.size(); ++mode) {
    for (int i = 0; i < outputs; ++i) {
      for (int k = 0; k < columns; ++k) {
        const auto found = of_inputs ? modes[mode].b(i, k) : modes[mode].a(i, k);
        const int first = of_inputs ? modes[mode].orders.nk(i, k) : 0;
        for (std::size_t l = 0; l < found.size(); ++l) {
          values(static_cast<py::ssize_t>(mode), first + static_cast<int>(l), i, k) = found[l];
        }
      }
    }
  }
  if (std::holds_alternative<SwitchedArxModel>(model.dynamics)) return array;
  return array[py::int_(0)].cast<py::array_t<double>>();
}

// Returns one value an output, and for a switched model a list of them for each mode.
py::object noise_sd(const Model& model) {
  std::vector<std::vector<double>> modes;
  for (const ArxModel& mode : arx_of(model)) modes.push_back(mode.noise.sd);
  return std::holds_alternative<SwitchedArxModel>(model.dynamics) ? py::cast(modes) : py::cast(modes[0]);
}

py::dict training_of(const Model& model) {
  py::dict recipe, figures, all;
  for (const auto& note : model.training.recipe) recipe[py::str(note.name)] = note.value;
  for (const auto& figure : model.training.figures) figures[py::str(figure.name)] = figure.value;
  all["program"] = model.training.program;
  all["sources"] = model.training.sources;
  all["recipe"] = recipe;
  all["figures"] = figures;
  return all;
}

py::dict ranges_of(const Model& model) {
  py::dict ranges;
  for (const Input& input : model.inputs) ranges[py::str(input.name)] = py::make_tuple(input.lowest, input.highest);
  for (const Output& output : model.outputs)
    ranges[py::str(output.name)] = py::make_tuple(output.lowest, output.highest);
  return ranges;
}

std::string shown(const Model& model) {
  const auto kind = std::visit([](const auto& dynamics) { return kind_of(dynamics); }, model.dynamics);
  return "<wisp.Model '" + model.name + "': " + kind + ", " + word_of(model.view) + ", " +
         std::to_string(model.inputs.size()) + " inputs, " + std::to_string(model.outputs.size()) + " outputs, " +
         py::str(py::float_(model.rate_hz)).cast<std::string>() + " Hz, " +
         (model.training.usable.verdict ? "usable" : "not usable") + ">";
}

// Writes a file for another tool, by its extension: .glb, .json (Lottie) or .c with its .h. As in the program, .c and
// .json of a plant, an ARX model with inputs and plain outputs, are the linear system itself.
void export_to(const Model& model, const std::filesystem::path& path, double seconds, bool loop, int instances,
               std::uint64_t seed, bool noise, const std::vector<double>& inputs) {
  const std::string kind = path.extension().string(), name = path.stem().string();
  const auto write_source = [&](const std::string& text, const std::string& declared) {
    if (!declared.empty()) unwrap(write_file(std::filesystem::path(path).replace_extension(".h"), declared));
    unwrap(write_file(path, text));
  };
  if (std::holds_alternative<ArxModel>(model.dynamics) && std::holds_alternative<PlainView>(model.view) &&
      !model.inputs.empty() && (kind == ".c" || kind == ".json")) {
    const auto plant = unwrapped(plant_text(model, kind == ".c" ? PlantLanguage::kC : PlantLanguage::kJson, name));
    return write_source(plant.text, plant.header);
  }
  if (kind == ".c") {
    const auto lamp = unwrapped(firmware_source(model, name));
    return write_source(lamp.source, lamp.header);
  }
  if (kind != ".glb" && kind != ".json") throw Failure(path.string() + ": expected a name in .glb, .json or .c");
  const auto taken = unwrapped(take(model, {.seconds = seconds,
                                            .loop = loop,
                                            .instances = instances,
                                            .seed = seed,
                                            .noise = noise,
                                            .inputs = inputs,
                                            .round = kind == ".glb"}));
  if (kind == ".glb") return unwrap(write_file(path, unwrapped(gltf_bytes(model, taken))));
  unwrap(write_file(path, unwrapped(lottie_text(model, taken))));
}

}  // namespace

void bind_models(py::module_& module) {
  py::class_<Model>(module, "Model", "A model of a thing's behaviour; two models are equal if their files are.")
      .def(py::init(&from_bytes), py::arg("bytes"), "From the bytes of a .wisp file.")
      .def_property_readonly(
          "dynamics",
          [](const Model& self) {
            return std::visit([](const auto& dynamics) { return kind_of(dynamics); }, self.dynamics);
          },
          "'arx', 'switched' or 'chain'.")
      .def_property_readonly(
          "view", [](const Model& self) { return word_of(self.view); },
          "'plain', 'outline', 'pose' or 'position': what the outputs mean.")
      .def_property_readonly(
          "usable", [](const Model& self) { return self.training.usable.verdict; },
          "Whether the learner found it fit for use.")
      .def_property_readonly(
          "reason", [](const Model& self) { return self.training.usable.reason; }, "Why, or why not.")
      .def_property_readonly("training", &training_of, "What it was learned from and how: a dictionary.")
      .def_property_readonly("ranges", &ranges_of, "Trained or seen range of each channel: name to (lowest, highest).")
      .def_property_readonly(
          "a", [](const Model& self) { return coefficients(self, false); },
          "A[lag - 1, i, j] of y(t) + A1 y(t-1) + ... = B u + e; of each mode of a switched model.")
      .def_property_readonly(
          "b", [](const Model& self) { return coefficients(self, true); },
          "B[lag, i, k] from lag 0, of inputs as the dynamics see them.")
      .def_property_readonly("noise_sd", &noise_sd,
                             "Standard deviation of each output's own noise; of each mode of a switched model.")
      .def(
          "in_the_round", [](const Model& self) { return unwrapped(in_the_round(self)); },
          "The same flame in the round, by rotational symmetry: its wind is x and z.")
      .def("export", &export_to, py::arg("path"), py::kw_only(), py::arg("seconds") = 4.0, py::arg("loop") = false,
           py::arg("instances") = 1, py::arg("seed") = 1, py::arg("noise") = true,
           py::arg("inputs") = std::vector<double>{}, py::call_guard<py::gil_scoped_release>(),
           "Writes .glb, .json (Lottie, or a linear system) or .c, as `wisp export` does.")
      .def(
          "__eq__",
          [](const Model& self, const Model& other) {
            return unwrapped(model_bytes(self)) == unwrapped(model_bytes(other));
          },
          py::is_operator())
      .def("__hash__", [](const Model& self) { return py::hash(bytes_of(self)); })
      .def("__repr__", &shown)
      .def_readonly("name", &Model::name)
      .def_readonly("rate_hz", &Model::rate_hz)
      .def_property_readonly("inputs", [](const Model& self) { return names(self.inputs); })
      .def_property_readonly("outputs", [](const Model& self) { return names(self.outputs); })
      .def(
          "write", [](const Model& self, const std::filesystem::path& path) { unwrap(write_model(path, self)); },
          py::arg("path"))
      .def("__bytes__", &bytes_of)
      .def(py::pickle(&bytes_of, &from_bytes));
  module.def(
      "read_model", [](const std::filesystem::path& path) { return unwrapped(read_model(path)); }, py::arg("path"));
}

}  // namespace wisp::python
