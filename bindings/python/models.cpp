// Models and banks of their living instances.

#include <algorithm>
#include <chrono>
#include <span>

#include "module.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

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

/// A new array, or the one that is given, after a look at its shape.
py::array_t<float> room(const py::object& out, std::vector<py::ssize_t> shape) {
  if (out.is_none()) return py::array_t<float>(shape);
  if (!py::isinstance<py::array_t<float, py::array::c_style>>(out))
    throw py::type_error("out: expected a contiguous array of float32");
  auto array = out.cast<py::array_t<float>>();
  if (!array.writeable() || std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()) != shape)
    throw py::value_error("out: expected a writable array of " + std::to_string(shape[0]) + " rows, see Bank.slots");
  return array;
}

std::span<float> values_of(py::array_t<float>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// One row a slot, or one row for all.
void set_inputs(Bank& bank, const Floats& values) {
  const std::span<const float> all(values.data(), static_cast<std::size_t>(values.size()));
  const auto width = static_cast<std::size_t>(bank.input_count());
  if (all.size() == width && values.ndim() <= 1) return bank.set_common_inputs(all);
  if (all.size() != width * static_cast<std::size_t>(bank.slots()))
    throw py::value_error("inputs: found " + std::to_string(all.size()) + " numbers, expected " +
                          std::to_string(width) + " for all or " + std::to_string(width) + " for each of " +
                          std::to_string(bank.slots()) + " slots");
  bank.set_inputs(all);
}

std::vector<bool> lit(const Bank& bank) {
  const ExtinctionFacet* extinction = bank.extinction();
  if (extinction == nullptr) throw py::attribute_error("nothing extinguishes this model");
  std::vector<bool> burning;
  for (int slot = 0; slot < bank.slots(); ++slot) {
    const auto state = extinction->state_of(bank.at(slot));
    burning.push_back(state && state->lit);
  }
  return burning;
}

void relight(Bank& bank) {
  if (ExtinctionFacet* extinction = bank.extinction())
    for (int slot = 0; slot < bank.slots(); ++slot) extinction->relight(bank.at(slot));
}

py::bytes save(const Bank& bank) {
  std::string bytes(bank.save_bytes(), '\0');
  bank.save(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

void bind_bank(py::module_& module) {
  py::class_<Bank>(module, "Bank", "Living instances of one model, stepped together. Rows of arrays are slots.")
      .def(py::init([](const Model& model, int instances, std::uint64_t seed, int polyline_points) {
             Bank bank = unwrapped(
                 Bank::create(model, {.capacity = instances, .seed = seed, .polyline_points = polyline_points}));
             for (int k = 0; k < instances; ++k) bank.spawn();
             return bank;
           }),
           py::arg("model"), py::arg("instances") = 1, py::kw_only(), py::arg("seed") = 1,
           py::arg("polyline_points") = 32)
      .def_property_readonly("slots", &Bank::slots)
      .def_property("noise", &Bank::noise, &Bank::set_noise)
      .def("set_inputs", &set_inputs, py::arg("values"), "One row for all instances, or one for each slot.")
      .def(
          "step", [](Bank& bank, int steps) { bank.step(std::max(steps, 0)); }, py::arg("steps") = 1,
          py::call_guard<py::gil_scoped_release>())
      .def(
          "advance",
          [](Bank& bank, double seconds) {
            return bank.advance(
                std::chrono::nanoseconds(static_cast<std::int64_t>(std::clamp(seconds, 0.0, 60.0) * 1e9)));
          },
          py::arg("seconds"), py::call_guard<py::gil_scoped_release>(), "Returns the steps that were made.")
      .def(
          "outputs",
          [](const Bank& bank, const py::object& out) {
            auto array = room(out, {bank.slots(), bank.output_count()});
            bank.outputs(values_of(array));
            return array;
          },
          py::arg("out") = py::none(), "slots x outputs; into `out` where it is given.")
      .def(
          "polylines",
          [](const Bank& bank, const py::object& out) {
            if (bank.polyline_points() == 0) throw py::attribute_error("the model's view is not an outline");
            auto array = room(out, {bank.slots(), bank.polyline_points(), 2});
            bank.polylines(values_of(array));
            return array;
          },
          py::arg("out") = py::none(), "slots x points x 2; into `out` where it is given.")
      .def_property_readonly("lit", &lit, "Whether each slot burns.")
      .def("relight", &relight, "Lights what is out.")
      .def("reset", [](Bank& bank) { bank.reset(); })
      .def("save", &save, "The whole state, as bytes.")
      .def(
          "restore",
          [](Bank& bank, const py::bytes& bytes) {
            const std::string_view view = bytes;
            unwrap(bank.restore(std::as_bytes(std::span(view))));
          },
          py::arg("bytes"));
}

}  // namespace

void bind_models(py::module_& module) {
  py::class_<Model>(module, "Model")
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
  bind_bank(module);
}

}  // namespace wisp::python
