#include "learn/outline/outline_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/statistics.hpp"
#include "record/loudness.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {
namespace {

constexpr double kSame = 0.02;  // factors closer to 1 than this count as 1

// An input whose loudness at value 1 all recordings state (one_rms()), and the largest RMS stated.
struct Loudest {
  std::string input;
  double rms = 0;
};

Result<std::vector<Loudest>> loudest_inputs(std::span<const Recording> recordings) {
  std::vector<Loudest> out;
  for (std::size_t c : channels_with_role(recordings.front(), Role::kInput)) {
    Loudest one{recordings.front().channels[c].name, 0};
    bool all = true;
    for (const Recording& recording : recordings) {
      const auto rms = one_rms(recording, one.input);
      if (!rms) return rms.error();
      all = all && *rms;
      one.rms = std::max(one.rms, rms->value_or(0));
    }
    if (all) out.push_back(std::move(one));
  }
  return out;
}

// Returns the value of a channel that equals 1 in the model's input; 1 if that is unknown.
Result<double> value_of_one(const Model& model, std::size_t input, const Recording& recording, const Channel& heard,
                            bool own_gain) {
  if (!heard.unit.empty() && heard.unit == model.inputs[input].unit) return 1.0;
  if (own_gain) {
    if (!std::holds_alternative<OutlineView>(model.view)) return 1.0;
    const auto own = scaled_input({&recording, 1}, heard.name);
    return own ? own->scale : 1.0;  // a calm recording has no scale
  }
  if (input >= model.training.inputs.size()) return 1.0;
  const InputTraining& trained = model.training.inputs[input];
  if (trained.one_rms == 0) return trained.scale;
  const auto factor = factor_at(recording, heard.name, trained.one_rms);
  if (!factor) return factor.error();
  return trained.scale / *factor;
}

// Divides a channel by `one`, and updates the loudness that the recording states for it.
Result<void> divide(Recording& recording, Channel& channel, double one) {
  if (one == 1) return {};
  for (double& value : channel.samples) value /= one;
  const auto rms = one_rms(recording, channel.name);
  if (!rms) return rms.error();
  if (*rms) set_one_rms(recording, channel.name, **rms * one * one);
  return {};
}

constexpr double kWindOne = 0.95;  // quantile of |input| over windy rows that becomes 1
constexpr double kLargest = 0.99;  // quantile of |input| over all rows, of which kCalmShare is calm

// Minimum total seconds of calm rows: over fewer, the calm height is unreliable, and all rows are used.
constexpr double kCalmSeconds = 0.5;

struct Strengths {
  std::vector<double> all;  // |sample|, without missing samples
  double lowest = 0;
  double highest = 0;
  std::string unit;
};

Result<Strengths> strengths(std::span<const Recording> recordings, const std::string& name) {
  Strengths out;
  for (const Recording& recording : recordings) {
    const auto index = find_channel(recording, name);
    if (!index) return Error{recording.source + ": there is no input " + name + ", which the others have"};
    out.unit = recording.channels[*index].unit;
    for (double value : recording.channels[*index].samples) {
      if (std::isnan(value)) continue;
      out.all.push_back(std::abs(value));
      out.lowest = std::min(out.lowest, value);
      out.highest = std::max(out.highest, value);
    }
  }
  return out;
}

double whole(double size) { return size; }
double root(double size) { return std::sqrt(size); }
double square(double size) { return size * size; }

// One regressor of an input: a power of its size, signed or not, and the suffix of its name.
struct Form {
  const char* suffix;
  bool has_sign;
  double (*power)(double);

  // Value of the regressor at input u; NaN for NaN.
  double of(double u) const { return (has_sign && u < 0 ? -1 : 1) * power(std::abs(u)); }
};

std::vector<Form> forms_of(RegressorShape shape) {
  if (shape.powers) {
    return {{" size", false, whole}, {" size root", false, root}, {" size square", false, square},
            {"", true, whole},       {" root", true, root},       {" square", true, square}};
  }
  return {{"", true, whole}};
}

}  // namespace

Result<std::vector<Recording>> at_common_gain(std::vector<Recording> recordings) {
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  for (const Loudest& loudest : *inputs) {
    for (Recording& recording : recordings) {
      auto heard = heard_at(std::move(recording), loudest.input, loudest.rms);
      if (!heard) return heard.error();
      recording = *std::move(heard);
    }
  }
  return recordings;
}

Result<std::vector<double>> common_gain_factors(std::span<const Recording> recordings) {
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  if (inputs->empty()) return std::vector<double>();
  std::vector<double> factors;
  for (const Recording& recording : recordings) {
    // No error: loudest_inputs() has read this input's loudness in every recording.
    factors.push_back(*factor_at(recording, inputs->front().input, inputs->front().rms));
  }
  if (*std::min_element(factors.begin(), factors.end()) > 1 - kSame) factors.clear();
  return factors;
}

Result<double> factor_to_trained_gain(const Model& model, const Recording& recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained > 0) return factor_at(recording, model.inputs[k].name, trained);
  }
  return 1.0;
}

Result<Recording> at_trained_gain(const Model& model, Recording recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained == 0) continue;
    auto heard = heard_at(std::move(recording), model.inputs[k].name, trained);
    if (!heard) return heard.error();
    recording = *std::move(heard);
  }
  return recording;
}

Result<Recording> in_model_units(const Model& model, Recording recording, std::span<const std::string> names,
                                 bool own_gain) {
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    const auto found = find_channel(recording, names[k]);
    if (!found) return Error{recording.source + ": has no channel " + names[k] + ", which the model takes as input"};
    Channel& channel = recording.channels[*found];
    const auto one = value_of_one(model, k, recording, channel, own_gain);
    if (!one) return one.error();
    if (auto ok = divide(recording, channel, *one); !ok) return ok.error();
    channel.unit = model.inputs[k].unit;
  }
  return recording;
}

Result<OutlineInput> scaled_input(std::span<const Recording> recordings, const std::string& name) {
  auto found = strengths(recordings, name);
  if (!found) return found.error();
  const std::string& source = recordings.front().source;
  if (found->all.empty()) return Error{source + ": its input " + name + " has no sample"};
  const double calm = kCalmShare * quantile(found->all, kLargest);
  std::erase_if(found->all, [&](double strength) { return !(strength > calm); });
  if (found->all.empty()) {
    return Error{source + ": its input " + name + " is 0 throughout; learn without inputs instead"};
  }
  OutlineInput input{name, found->unit, quantile(found->all, kWindOne), 0, 0};
  input.lowest = found->lowest / input.scale;
  input.highest = found->highest / input.scale;
  return input;
}

std::vector<std::uint8_t> calm_rows(const Recording& recording, std::span<const OutlineInput> inputs) {
  std::vector<std::uint8_t> calm(recording.rows(), 1);
  for (const OutlineInput& input : inputs) {
    const auto index = find_channel(recording, input.name);
    if (!index) continue;
    const auto& samples = recording.channels[*index].samples;
    // The scale, the 95th percentile of windy rows, stands in for the 99th of all rows, to which kCalmShare refers.
    for (std::size_t row = 0; row < calm.size(); ++row) {
      if (!(std::abs(samples[row]) <= kCalmShare * input.scale)) calm[row] = 0;
    }
  }
  return calm;
}

std::vector<std::uint8_t> resting_rows(const Recording& recording, std::span<const OutlineInput> inputs) {
  std::vector<std::uint8_t> rows = calm_rows(recording, inputs);
  if (inputs.empty()) return rows;
  const auto settle = static_cast<std::size_t>(std::ceil(kSettleSeconds * recording.rate_hz));
  for (const Episode& episode : episodes(recording)) {
    std::size_t calm = 0;
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      calm = rows[row] != 0 ? calm + 1 : 0;
      rows[row] = calm > settle ? 1 : 0;
    }
  }
  return rows;
}

std::vector<std::uint8_t> undisturbed_rows(const Recording& recording, std::span<const OutlineInput> inputs) {
  for (auto rows : {resting_rows(recording, inputs), calm_rows(recording, inputs)}) {
    const auto count = static_cast<double>(std::count(rows.begin(), rows.end(), std::uint8_t{1}));
    if (count >= kCalmSeconds * recording.rate_hz) return rows;
  }
  return {};
}

double resting_height_pixels(const Recording& recording, const OutlineLayout& layout,
                             std::span<const OutlineInput> inputs) {
  const auto calm = heights_pixels(recording, layout, undisturbed_rows(recording, inputs));
  return inputs.empty() || calm.empty() ? mean(heights_pixels(recording, layout, {})) : quantile(calm, 0.5);
}

std::vector<std::string> regressor_names(std::span<const OutlineInput> inputs, RegressorShape shape) {
  std::vector<std::string> names;
  for (const OutlineInput& input : inputs) {
    for (const Form& form : forms_of(shape)) names.push_back(input.name + form.suffix);
  }
  return names;
}

Recording with_regressors(const Recording& recording, std::span<const OutlineInput> inputs, RegressorShape shape) {
  Recording out = recording;
  std::erase_if(out.channels, [](const Channel& channel) { return channel.role == Role::kInput; });
  for (const OutlineInput& input : inputs) {
    const std::vector<double>& samples = samples_of(recording, input.name);
    for (const Form& form : forms_of(shape)) {
      Channel channel{input.name + form.suffix, "", Role::kInput, {}};
      for (double u : samples) channel.samples.push_back(form.of(u / input.scale));
      out.channels.push_back(std::move(channel));
    }
  }
  return out;
}

std::vector<double> mean_shape(const Recording& recording, const OutlineLayout& layout,
                               std::span<const std::uint8_t> rows) {
  std::vector<double> sum(layout.outputs.size(), 0.0);
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::vector<double> control = whole_row(recording, layout, row);
    if (rows[row] == 0 || control.empty()) continue;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += control[k];
    ++count;
  }
  if (count == 0) return {};
  for (double& value : sum) value /= static_cast<double>(count);
  return sum;
}

Result<double> trained_scale(const Model& model, const std::string& input) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    if (model.inputs[k].name == input) return model.training.inputs[k].scale;
  }
  return Error{model.name + ": does not say what its input " + input + " was in recordings, expected a model that " +
               "was learned from some; learn it with this program"};
}

}  // namespace wisp
