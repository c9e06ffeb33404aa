// Reports as dictionaries and text.

#include "wisp/base/report.hpp"

#include "module.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"

namespace wisp::python {
namespace {

py::list series_of(const Report& report) {
  py::list all;
  for (const ReportSection& section : report.sections) {
    for (const ReportSeries& one : section.series) {
      py::dict made;
      made["id"] = one.id;
      made["label"] = one.label;
      made["x_label"] = one.x_label;
      made["y_label"] = one.y_label;
      made["x"] = py::array_t<double>(static_cast<py::ssize_t>(one.x.size()), one.x.data());
      made["y"] = py::array_t<double>(static_cast<py::ssize_t>(one.y.size()), one.y.data());
      all.append(made);
    }
  }
  return all;
}

}  // namespace

void bind_report(py::module_& module) {
  py::class_<Report>(module, "Report", "What was found: verdict, figures, tables, curves, warnings.")
      .def_property_readonly(
          "usable",
          [](const Report& self) { return self.verdict ? py::object(py::bool_(self.verdict->usable)) : py::none(); },
          "Whether the thing may be used; None where that is not judged.")
      .def_property_readonly("reason", [](const Report& self) { return self.verdict ? self.verdict->reason : ""; })
      .def_readonly("warnings", &Report::warnings)
      .def_property_readonly("series", &series_of, "Curves to plot: dictionaries with x, y and what the axes are.")
      .def(
          "to_dict", [](const Report& self) { return py::module_::import("json").attr("loads")(to_json(self)); },
          "The fields of the program's --json document.")
      .def("__str__", [](const Report& self) { return to_text(self); })
      .def(
          "to_html", [](const Report& self) { return to_html(self); }, "A piece of an HTML page; notebooks show it.")
      .def("_repr_html_", [](const Report& self) { return to_html(self); })
      .def("__repr__", [](const Report& self) {
        if (!self.verdict) return std::string("<wisp.Report>");
        return "<wisp.Report " + std::string(self.verdict->usable ? "usable: " : "not usable: ") +
               self.verdict->reason + ">";
      });
}

}  // namespace wisp::python
