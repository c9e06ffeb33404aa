#include "learn/complete.hpp"

namespace wisp {

ReportSection cost_section(const Cost& cost) {
  return {"Cost",
          {{.id = "cost.multiply_adds_per_frame",
            .value = cost.multiply_adds_per_frame,
            .label = "multiply-adds a frame",
            .meaning = "by the paper's count"},
           {.id = "cost.operations_per_frame",
            .value = cost.operations_per_frame,
            .label = "operations a frame",
            .meaning = "all arithmetic, noise and view included"},
           {.id = "cost.worst_operations_per_frame",
            .value = cost.worst_operations,
            .label = "operations in the worst frame"},
           {.id = "cost.steered_operations_per_frame", .value = cost.steered_operations}}};
}

void complete(Fit& fit) {
  fit.model.training.program = "wisp " WISP_VERSION;
  const auto cost = count_operations(fit.model);
  if (!cost) return;
  // Runtimes with little memory read the cost from the model instead of counting.
  fit.model.training.multiply_adds_per_frame = cost->multiply_adds_per_frame;
  fit.model.training.operations_per_frame = cost->operations_per_frame;
  fit.report.sections.push_back(cost_section(*cost));
}

}  // namespace wisp
