// Recordings as named columns of numpy arrays.

#include "wisp/record/recording.hpp"

#include "module.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::python {
namespace {

using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Adds the columns of a mapping (a dictionary, a pandas frame) with a role.
void add_columns(Recording& recording, const py::object& columns, Role role) {
  if (columns.is_none()) return;
  for (const auto& name : columns) {
    const auto values = Column::ensure(columns[py::reinterpret_borrow<py::object>(name)]);
    if (!values || values.ndim() != 1)
      throw Failure("column " + py::str(name).cast<std::string>() + ": expected one number a row");
    recording.channels.push_back({py::str(name), "", role, {values.data(), values.data() + values.size()}});
  }
}

Recording make(double rate_hz, const py::object& outputs, const py::object& inputs,
               const std::vector<std::int64_t>& episodes, const std::string& source) {
  Recording recording;
  recording.source = source;
  recording.rate_hz = rate_hz;
  add_columns(recording, inputs, Role::kInput);
  add_columns(recording, outputs, Role::kOutput);
  recording.episode_ids = episodes;
  if (!episodes.empty() && episodes.size() != recording.rows())
    throw Failure("found " + std::to_string(episodes.size()) + " episode ids, expected one for each of the " +
                  std::to_string(recording.rows()) + " rows");
  unwrap(check(recording));
  return recording;
}

/// Returns a channel's samples, without a copy; the array keeps the recording alive.
py::array column(const py::object& self, const std::string& name) {
  auto& recording = self.cast<Recording&>();
  const auto found = find_channel(recording, name);
  if (!found) throw py::key_error(name);
  auto& samples = recording.channels[*found].samples;
  return py::array_t<double>(static_cast<py::ssize_t>(samples.size()), samples.data(), self);
}

std::vector<std::string> names(const Recording& recording, Role role) {
  std::vector<std::string> found;
  for (const std::size_t index : channels_with_role(recording, role)) found.push_back(recording.channels[index].name);
  return found;
}

}  // namespace

void bind_recording(py::module_& module) {
  py::class_<Recording>(module, "Recording", "Inputs and outputs over time at one fixed rate; a missing sample is NaN.")
      .def(py::init(&make), py::arg("rate_hz"), py::arg("outputs"), py::arg("inputs") = py::none(),
           py::arg("episodes") = std::vector<std::int64_t>{}, py::arg("source") = "",
           "From mappings of names to columns: dictionaries of arrays, pandas frames, xarray datasets.")
      .def("__repr__",
           [](const Recording& self) {
             const auto listed = [&](Role role) { return py::repr(py::cast(names(self, role))).cast<std::string>(); };
             return "<wisp.Recording of " + std::to_string(self.rows()) + " rows at " +
                    py::repr(py::cast(self.rate_hz)).cast<std::string>() + " Hz, inputs " + listed(Role::kInput) +
                    ", outputs " + listed(Role::kOutput) + ">";
           })
      .def_readonly("source", &Recording::source)
      .def_readonly("rate_hz", &Recording::rate_hz)
      .def_property_readonly("inputs", [](const Recording& self) { return names(self, Role::kInput); })
      .def_property_readonly("outputs", [](const Recording& self) { return names(self, Role::kOutput); })
      .def_property_readonly("attributes",
                             [](const Recording& self) {
                               py::dict all;
                               for (const auto& [name, value] : self.attributes) all[py::str(name)] = value;
                               return all;
                             })
      .def("__len__", &Recording::rows)
      .def("__getitem__", &column, "The samples of a channel: an array that lives in the recording.")
      .def(
          "rows",
          [](const Recording& self, std::size_t first, std::size_t last) {
            if (first > last || last > self.rows())
              throw py::index_error("rows " + std::to_string(first) + " to " + std::to_string(last) +
                                    ": the recording has " + std::to_string(self.rows()));
            return slice(self, first, last);
          },
          py::arg("first"), py::arg("last"), "Rows [first, last).")
      .def(
          "write_csv", [](const Recording& self, const std::filesystem::path& path) { unwrap(write_csv(path, self)); },
          py::arg("path"));
  module.def(
      "read_csv",
      [](const std::filesystem::path& path, double rate_hz, std::vector<std::string> inputs,
         std::vector<std::string> outputs) {
        const CsvOptions options{.rate_hz = rate_hz, .inputs = std::move(inputs), .outputs = std::move(outputs)};
        return unwrapped(read_csv(path, options));
      },
      py::arg("path"), py::arg("rate_hz") = 0.0, py::arg("inputs") = std::vector<std::string>{},
      py::arg("outputs") = std::vector<std::string>{}, py::call_guard<py::gil_scoped_release>(),
      "A recording from a CSV file: Wisp's own, or a table whose rate and columns are given.");
}

}  // namespace wisp::python
