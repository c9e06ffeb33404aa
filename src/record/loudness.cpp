#include "record/loudness.hpp"

#include <cmath>

namespace wisp {
namespace {

std::string attribute_name(const std::string& input) { return input + ".one_rms"; }

}  // namespace

Result<std::optional<double>> one_rms(const Recording& recording, const std::string& input) {
  const auto values = numbers_attribute(recording, attribute_name(input));
  if (!values) return values.error();
  if (!*values) return std::optional<double>();
  if ((*values)->size() != 1 || !((*values)->front() > 0)) {
    return Error{recording.source + ": \"# " + attribute_name(input) + "\" holds \"" +
                 std::string(*find_attribute(recording, attribute_name(input))) + "\", expected one number above 0"};
  }
  return std::optional((*values)->front());
}

void set_one_rms(Recording& recording, const std::string& input, double rms) {
  set_numbers_attribute(recording, attribute_name(input), {&rms, 1});
}

Result<double> factor_at(const Recording& recording, const std::string& input, double rms) {
  const auto own = one_rms(recording, input);
  if (!own) return own.error();
  return *own ? std::sqrt(**own / rms) : 1.0;
}

Result<Recording> heard_at(Recording recording, const std::string& input, double rms) {
  const auto factor = factor_at(recording, input, rms);
  if (!factor) return factor.error();
  const auto channel = find_channel(recording, input);
  if (!channel || *factor == 1) return recording;
  for (double& value : recording.channels[*channel].samples) value *= *factor;
  set_one_rms(recording, input, rms);
  return recording;
}

}  // namespace wisp
