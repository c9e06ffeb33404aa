#include "learn/outline/outline_synthesis.hpp"

#include <cmath>

#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

// Returns the input samples per row; empty without a recording, or for a model without inputs.
Result<std::vector<std::vector<float>>> input_rows(const Model& model, const Recording* input) {
  std::vector<std::vector<float>> rows;
  if (input == nullptr || model.inputs.empty()) return rows;
  rows.assign(input->rows(), std::vector<float>(model.inputs.size()));
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    const auto channel = find_channel(*input, model.inputs[k].name);
    if (!channel) return Error{input->source + ": there is no input " + model.inputs[k].name};
    const auto& samples = input->channels[*channel].samples;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      // A missing sample counts as calm, since every step needs an input.
      rows[row][k] = std::isnan(samples[row]) ? 0.0F : static_cast<float>(samples[row]);
    }
  }
  return rows;
}

// Steps a bank along the inputs. Row 0 drives the first step after the warm-up.
class Player {
 public:
  Player(Bank& bank, const std::vector<std::vector<float>>& rows, std::size_t warm_up)
      : bank_(bank), rows_(rows), at_(rows.empty() ? 0 : (rows.size() - warm_up % rows.size()) % rows.size()) {}

  void step() {
    if (!rows_.empty()) {
      bank_.set_common_inputs(rows_[at_]);
      at_ = (at_ + 1) % rows_.size();
    }
    bank_.step();
  }

 private:
  Bank& bank_;
  const std::vector<std::vector<float>>& rows_;
  std::size_t at_;
};

Recording empty_recording(const Model& model, std::size_t rows) {
  Recording out;
  out.source = model.name + " (synthesized)";
  out.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs) {
    out.channels.push_back({output.name, output.unit, Role::kOutput, {}});
    out.channels.back().samples.reserve(rows);
  }
  return out;
}

double share(const Bank::Clamped& before, const Bank::Clamped& after) {
  const std::uint64_t steps = after.steps - before.steps;
  return steps == 0 ? 0 : static_cast<double>(after.clamped - before.clamped) / static_cast<double>(steps);
}

}  // namespace

Result<Synthesis> synthesize(const Model& model, const SynthesisOptions& options) {
  const auto inputs = input_rows(model, options.input);
  if (!inputs) return inputs.error();
  Model burning = model;  // extinction is judged separately
  burning.extinction.reset();
  auto bank = Bank::create(burning, {.capacity = 1, .seed = options.seed});
  if (!bank) return bank.error();
  bank->set_noise(options.noise);
  const InstanceId id = bank->spawn();
  const auto warm_up = static_cast<std::size_t>(std::ceil(options.warm_up_seconds * model.rate_hz));
  Player player(*bank, *inputs, warm_up);
  for (std::size_t t = 0; t < warm_up; ++t) player.step();
  const Bank::Clamped before = bank->clamped();
  const std::size_t rows = options.rows > 0 ? options.rows : inputs->size();
  Synthesis out{empty_recording(model, rows), 0};
  std::vector<float> values(model.outputs.size());
  for (std::size_t t = 0; t < rows; ++t) {
    player.step();
    bank->outputs(id, values);
    for (std::size_t k = 0; k < values.size(); ++k) out.recording.channels[k].samples.push_back(values[k]);
  }
  out.held_share = share(before, bank->clamped());
  return out;
}

}  // namespace wisp
