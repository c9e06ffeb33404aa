#include "reports/switched_validation.hpp"

#include "reports/arx_validation.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp::cli {

Result<void> validate_switched(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                               Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip", "figures"}) {
    if (arguments.has(flag))
      return Error{arguments.positional() + ": is a switched model, for which --" + flag + " draws nothing"};
  }
  const auto recording = table_for(model, arguments.positionals()[1], arguments);
  if (!recording) return recording.error();
  const auto report = validate(model, *recording, {.steps = steps}, terminal.progress());
  if (!report) return report.error();
  terminal.show(*report);
  return {};
}

}  // namespace wisp::cli
