#include "learn/outline/outline_inputs.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"

namespace wisp {
namespace {

constexpr double kWindOne = 0.95;
constexpr double kLargest = 0.99;

// Fewer calm rows than this say little about the calm height; then all rows are taken.
constexpr double kCalmSeconds = 0.5;

struct Strengths {
  std::vector<double> all;  // |sample|, missing ones left out
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

// Below this an input is calm: its scale stands for its 95th percentile while it blows, which is near enough to the
// 99th percentile for the same threshold.
double calm_below(const OutlineInput& input) { return kCalmShare * input.scale; }

// NaN stays NaN in all of them.
double whole(double u) { return u; }
double positive(double u) { return u < 0 ? 0 : u; }
double negative(double u) { return u > 0 ? 0 : -u; }

double root(double u) { return std::sqrt(u); }
double square(double u) { return u * u; }

// One regressor of an input: a power of a part, and what follows the input's name.
struct Form {
  const char* suffix;
  double (*part)(double);
  double (*power)(double);
};

std::vector<Form> forms_of(RegressorShape shape) {
  if (shape.powers) {
    return {{"+", positive, whole}, {"+ root", positive, root}, {"+ square", positive, square},
            {"-", negative, whole}, {"- root", negative, root}, {"- square", negative, square}};
  }
  return {{"", whole, whole}};
}

}  // namespace

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
    for (std::size_t row = 0; row < calm.size(); ++row) {
      if (!(std::abs(samples[row]) <= calm_below(input))) calm[row] = 0;
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
  const auto rows = undisturbed_rows(recording, inputs);
  if (inputs.empty() || rows.empty()) return mean_height_pixels(recording, layout, rows);
  return quantile(heights_pixels(recording, layout, rows), 0.5);
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
    const std::vector<double>& samples = recording.channels[*find_channel(recording, input.name)].samples;
    for (const Form& form : forms_of(shape)) {
      Channel channel{input.name + form.suffix, "", Role::kInput, {}};
      for (double u : samples) {
        channel.samples.push_back(form.power(form.part(u / input.scale)));
      }
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
    const auto missing = [&](std::size_t c) { return std::isnan(recording.channels[c].samples[row]); };
    if (rows[row] == 0 || std::any_of(layout.outputs.begin(), layout.outputs.end(), missing)) continue;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += recording.channels[layout.outputs[k]].samples[row];
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
