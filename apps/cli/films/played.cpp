#include "films/played.hpp"

namespace wisp::cli {

Recording played_channels(const Model& model, int instances, const std::string& seed) {
  Recording recording;
  recording.rate_hz = model.rate_hz;
  recording.attributes = {{"model", model.name}, {"seed", seed}};
  if (const auto* outline = std::get_if<OutlineView>(&model.view)) {
    set_numbers_attribute(recording, "knots", outline->knots);
  }
  for (const Input& input : model.inputs) recording.channels.push_back({input.name, input.unit, Role::kInput, {}});
  for (int k = 0; k < instances; ++k) {
    const std::string prefix = instances == 1 ? "" : "i" + std::to_string(k) + ".";
    for (const Output& output : model.outputs) {
      recording.channels.push_back({prefix + output.name, output.unit, Role::kOutput, {}});
    }
  }
  return recording;
}

Recording one_after_the_other(const Recording& side_by_side, const Model& model, int instances,
                              const std::string& seed) {
  const std::size_t inputs = model.inputs.size(), outputs = model.outputs.size();
  Recording recording = played_channels(model, 1, seed);
  for (int k = 0; k < instances; ++k) {
    for (std::size_t c = 0; c < recording.channels.size(); ++c) {
      const std::size_t from = c < inputs ? c : c + static_cast<std::size_t>(k) * outputs;
      const std::vector<double>& samples = side_by_side.channels[from].samples;
      recording.channels[c].samples.insert(recording.channels[c].samples.end(), samples.begin(), samples.end());
    }
    recording.episode_ids.insert(recording.episode_ids.end(), side_by_side.rows(), k);
  }
  return recording;
}

bool are_bodies(const Model& model, int instances) {
  return instances > 1 && std::holds_alternative<ChainModel>(model.dynamics);
}

}  // namespace wisp::cli
