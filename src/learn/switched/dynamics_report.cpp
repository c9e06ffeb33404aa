#include "wisp/learn/dynamics_report.hpp"

#include "learn/arx/report/arx_description.hpp"
#include "learn/switched/learn_switched.hpp"

namespace wisp {

Report dynamics_report(const Model& model, const std::string& prefix) {
  Report report;
  ReportSection& section = report.add("Dynamics");
  if (const auto* plain = std::get_if<ArxModel>(&model.dynamics)) {
    arx::describe(*plain, prefix, section);
    arx::tell_poles(*plain, model.rate_hz, report);
  } else if (const auto* switching = std::get_if<SwitchedArxModel>(&model.dynamics)) {
    switched::describe(*switching, prefix, section);
  }
  return report;
}

}  // namespace wisp
