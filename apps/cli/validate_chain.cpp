#include "validate_chain.hpp"

#include <algorithm>

#include "chain_figures.hpp"
#include "chain_json.hpp"
#include "recordings.hpp"
#include "wisp/learn/chain_fidelity.hpp"

namespace wisp::cli {
namespace {

// How the model's motion was cut when it was learned.
Result<SegmentationOptions> segmentation_of(const Model& model) {
  SegmentationOptions options;
  for (const Note& note : model.provenance.options) {
    if (note.name == "event") {
      auto event = parse_event(note.value);
      if (!event) return event.error();
      options.event = std::move(*event);
    }
    if (note.name == "shortest") options.least_seconds = std::strtod(note.value.c_str(), nullptr);
    if (note.name == "debounce") options.debounce = std::strtod(note.value.c_str(), nullptr);
  }
  return options;
}

int smooth_rows_of(const Model& model) {
  for (const Note& note : model.provenance.options) {
    if (note.name == "smooth") return std::atoi(note.value.c_str());
  }
  return 0;
}

}  // namespace

Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip", "clip"}) {
    if (arguments.has(flag)) return Error{"--" + std::string(flag) + " is for outlines; this model is a segment chain"};
  }
  auto whole = read_table(arguments.positionals()[1], arguments);
  if (!whole) return whole.error();
  auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  auto segmentation = segmentation_of(model);
  if (!segmentation) return segmentation.error();
  const ChainFidelityOptions options{.segmentation = std::move(*segmentation),
                                     .smooth_rows = smooth_rows_of(model),
                                     .seed = static_cast<std::uint64_t>(arguments.integer("seed"))};
  const std::vector<Recording> real = {std::move(*recording)};
  const auto fidelity = chain_fidelity(model, real, options);
  if (!fidelity) return fidelity.error();
  terminal.result()["rows"] = real.front().rows();
  terminal.result()["channels"] = Json::array();
  terminal.result()["fidelity"] = fidelity_json(*fidelity);
  terminal.result()["join_defect"] = join_defect_json(fidelity->join_defect);
  say_fidelity(*fidelity, terminal);
  if (!arguments.has("figures")) return {};
  if (auto ok = write_chain_figures(arguments.text("figures"), model, real, options); !ok) return ok;
  terminal.say("wrote figures to " + arguments.text("figures"));
  return {};
}

}  // namespace wisp::cli
