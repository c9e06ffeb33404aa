// `wisp info`: what a model file holds.

#include "commands/commands.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

Result<void> run_info(const Arguments& arguments, Terminal& terminal) {
  const auto bytes = read_file(arguments.positional());
  if (!bytes) return bytes.error();
  const auto model = parse_model(*bytes, arguments.positional());
  if (!model) return model.error();
  auto report = model_report(*model);
  if (!report) return report.error();
  if (terminal.json()) report->append(model_contents(*model));
  report->add("File").entries = {{"bytes", bytes->size(), "size", "bytes"},
                                 {"format_version", kModelFormatVersion, "version of the format", ""}};
  terminal.show(*report);
  return {};
}

}  // namespace

Command info_command() {
  return {
      "info",
      "Says what a model file holds, how it was made, and what it costs a frame.",
      {{"MODEL", "the model, a .wisp file"}},
      {},
      {{"wisp info flame.wisp", "The facts of a model"}},
      run_info,
  };
}

}  // namespace wisp::cli
