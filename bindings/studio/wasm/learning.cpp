// Learning and validation as WebAssembly functions: JSON and recordings in, models and reports out.

#include <optional>
#include <span>
#include <string_view>

#include "learns.hpp"
#include "reported.hpp"
#include "settings.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"

// Reports progress to the host, which returns whether to continue.
extern "C" __attribute__((import_module("env"), import_name("studio_progress"))) int studio_progress(const char* stage,
                                                                                                     std::size_t size,
                                                                                                     double share);

namespace wisp::studio {
namespace {

using nlohmann::json;

// Recordings added for learning or validation.
std::vector<Recording>& recordings() {
  static std::vector<Recording> all;
  return all;
}

Progress progress() {
  return [](std::string_view stage, double share) { return studio_progress(stage.data(), stage.size(), share) != 0; };
}

// Reads a recipe's fields by name from the settings; any may be missing.
template <class SomeRecipe>
SomeRecipe with_settings(const json& from, SomeRecipe recipe) {
  for_each_field(recipe, [&](const auto& field) {
    auto& value = recipe.*(field.member);
    using Value = std::remove_reference_t<decltype(value)>;
    const auto found = from.find(field.name);
    if (found == from.end()) return;
    if constexpr (std::is_same_v<Value, std::string>) {
      if (found->is_string()) value = found->template get<std::string>();
    } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
      value = names(from, field.name);
    } else if constexpr (std::is_same_v<Value, OrderChoice> || std::is_same_v<Value, std::optional<OrderChoice>>) {
      if (found->is_number()) value = found->template get<int>();
    } else if constexpr (std::is_arithmetic_v<Value>) {
      if (found->is_number() || found->is_boolean()) value = found->template get<Value>();
    }
  });
  return recipe;
}

// Returns the recipe. For a kind that the other module learns, a default recipe by which of_chain() detects that.
Recipe recipe_of(const json& from) {
  const std::string kind = from.value("kind", "flame");
  const bool chain = kind == "chain" || kind == "leaf";
  if constexpr (kLearnsChains) {
    if (!chain) return FlameRecipe{};
    if (kind == "leaf") return with_settings(from, LeafRecipe{});
    return with_settings(from, ChainRecipe{});
  } else {
    if (chain) return ChainRecipe{};
    if (kind == "outline") return with_settings(from, OutlineRecipe{});
    if (kind != "arx") return with_settings(from, FlameRecipe{});
    ArxRecipe defaults{.name = "table", .responses = true};
    defaults.nk.reset();
    if (const auto order = whole(from, "order"); order && *order > 0) defaults.na = defaults.nb = *order;
    return with_settings(from, std::move(defaults));
  }
}

// Judges, on the last `share` of the rows, a model learned from the rows before; empty if either step fails.
std::optional<json> judged_on_the_end(const std::vector<Recording>& recordings, const Recipe& recipe, double share) {
  std::vector<Recording> begins, ends;
  for (const Recording& recording : recordings) {
    const auto cut = static_cast<std::size_t>((1 - share) * static_cast<double>(recording.rows()));
    begins.push_back(slice(recording, 0, cut));
    ends.push_back(slice(recording, cut, recording.rows()));
  }
  const auto fit = learn(begins, recipe, progress());
  if (!fit) return std::nullopt;
  const auto report = validate(fit->model, ends, {}, progress());
  if (!report) return std::nullopt;
  return report_json(*report);
}

bool of_chain(const Recipe& recipe) {
  return std::visit([]<class Kind>(const Kind&) { return std::is_base_of_v<ChainRecipe, Kind>; }, recipe);
}

int elsewhere() {
  fail({"chains are learned and judged by chains.wasm, everything else by studio.wasm"});
  return kElsewhere;
}

}  // namespace
}  // namespace wisp::studio

using namespace wisp;
using namespace wisp::studio;

extern "C" {

// Adds a recording, as CSV, to those to be learned from; {name, rate, inputs, outputs}.
WISP_STUDIO(add) int studio_add(const char* bytes, std::size_t size, const char* text, std::size_t text_size) {
  auto recording = read_recording(bytes, size, parsed(text, text_size));
  if (!recording) return fail(recording.error());
  recordings().push_back(std::move(*recording));
  return kDone;
}

WISP_STUDIO(clear) void studio_clear() { recordings().clear(); }

// Learns from the added recordings, or answers that the other module is responsible. Bytes: the model. With
// `kept_back`, `judged` has the results on the last rows.
WISP_STUDIO(learn) int studio_learn(const char* text, std::size_t size) {
  const json settings = parsed(text, size);
  const Recipe recipe = recipe_of(settings);
  if (of_chain(recipe) != kLearnsChains) return elsewhere();
  const auto fit = learn(recordings(), recipe, progress());
  if (!fit) return fail(fit.error());
  auto bytes = model_bytes(fit->model);
  if (!bytes) return fail(bytes.error());
  json answer = report_json(fit->report);
  if (const double share = settings.value("kept_back", 0.0); share > 0 && share < 1) {
    if (auto judged = judged_on_the_end(recordings(), recipe, share)) answer["judged"] = *std::move(judged);
  }
  Answer& out = fresh();
  out.bytes = std::move(*bytes);
  out.text = answer.dump(-1, ' ', false, json::error_handler_t::replace);
  return kDone;
}

// Judges a model on the added recordings.
WISP_STUDIO(validate) int studio_validate(const std::byte* bytes, std::size_t size) {
  const auto model = parse_model({bytes, size}, "the model");
  if (!model) return fail(model.error());
  if (std::holds_alternative<ChainModel>(model->dynamics) != kLearnsChains) return elsewhere();
  const auto report = validate(*model, recordings(), {.responses = true}, progress());
  if (!report) return fail(report.error());
  fresh().text = report_json(*report).dump(-1, ' ', false, json::error_handler_t::replace);
  return kDone;
}
}
