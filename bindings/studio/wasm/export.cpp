// Conversion of models to files for other tools: a separate module, loaded at first use.

#include "wisp/export/export.hpp"

#include "answer.hpp"
#include "wisp/model/file.hpp"

namespace wisp::studio {
namespace {

void hand_over(std::span<const std::byte> bytes) { fresh().bytes.assign(bytes.begin(), bytes.end()); }

enum class Format { kGltf, kLottie, kC };

// Writes the file; for C the source, with its header as the answer's text.
Result<void> write(const Model& model, Format format, const TakeOptions& options, int height, const char* name) {
  // A plain model with inputs is exported as a linear system, any other as a lamp's firmware.
  if (format == Format::kC && std::holds_alternative<PlainView>(model.view) && !model.inputs.empty()) {
    auto plant = plant_text(model, PlantLanguage::kC, name);
    if (!plant) return plant.error();
    hand_over(std::as_bytes(std::span(plant->text)));
    answer().text = std::move(plant->header);
    return {};
  }
  if (format == Format::kC) {
    auto lamp = firmware_source(model, name);
    if (!lamp) return lamp.error();
    hand_over(std::as_bytes(std::span(lamp->source)));
    answer().text = std::move(lamp->header);
    return {};
  }
  const auto taken = take(model, options);
  if (!taken) return taken.error();
  if (format == Format::kGltf) {
    const auto bytes = gltf_bytes(model, *taken);
    if (!bytes) return bytes.error();
    hand_over(*bytes);
    return {};
  }
  const auto text = lottie_text(model, *taken, height);
  if (!text) return text.error();
  hand_over(std::as_bytes(std::span(*text)));
  return {};
}

}  // namespace
}  // namespace wisp::studio

using namespace wisp;
using namespace wisp::studio;

// Writes a model's play as a file; `wind` is a constant value of every input. `name` is zero-terminated and the prefix
// of all names in C.
extern "C" __attribute__((export_name("studio_export"))) int studio_export(const std::byte* bytes, std::size_t size,
                                                                           int format, double seconds, int loop,
                                                                           int instances, double wind, double seed,
                                                                           int height, const char* name) {
  const auto model = parse_model({bytes, size}, "the model");
  if (!model) return fail(model.error());
  const TakeOptions options{.seconds = seconds,
                            .loop = loop != 0,
                            .instances = instances,
                            .seed = static_cast<std::uint64_t>(seed),
                            .inputs = std::vector<double>(model->inputs.size(), wind),
                            .round = static_cast<Format>(format) == Format::kGltf};
  const auto written = write(*model, static_cast<Format>(format), options, height, name);
  return written ? kDone : fail(written.error());
}
