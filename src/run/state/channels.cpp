#include "run/state/channels.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "run/state/model_hash.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

// Returns the unit in which the deviations of a power of an input are measured.
double regressor_unit(const Input& input, RegressorPower power) {
  const double scale = channel_scale(input.lowest, input.highest);
  if (power == RegressorPower::kRoot) return std::sqrt(scale);
  return power == RegressorPower::kSquare ? scale * scale : scale;
}

constexpr double kLargest = 1e12;    // largest range or mean, in the model's units
constexpr double kSmallest = 1e-12;  // smallest nonzero range

double margin(double lowest, double highest) { return kRangeMargin * (highest - lowest); }

float first_lane(const Reals<LiveNumbers>& reals) {
  float lanes[LiveNumbers::kLanes];
  store(reals, lanes);
  return lanes[0];
}

float regress(const RegressorChannel& channel, float input) {
  return first_lane(wisp::regress<LiveNumbers>(channel, all<Reals<LiveNumbers>>(input)));
}

OutputChannel make_output(const ValueRange& output, double mean) {
  const double scale = channel_scale(output.lowest, output.highest);
  const double room = margin(output.lowest, output.highest);
  const double lowest = output.lowest - room, highest = output.highest + room;
  OutputChannel channel{};
  channel.mean = static_cast<float>(mean);
  channel.scale = static_cast<float>(scale);
  channel.low = static_cast<float>((lowest - mean) / scale);
  channel.high = static_cast<float>((highest - mean) / scale);
  channel.lowest = static_cast<float>(lowest);
  channel.highest = static_cast<float>(highest);
  channel.start = first_lane(settle(all<Reals<LiveNumbers>>(std::clamp(0.0f, channel.low, channel.high))));
  return channel;
}

RegressorChannel make_regressor(const Input& input, int index, RegressorForm form, double mean) {
  const double room = margin(input.lowest, input.highest);
  RegressorChannel channel{};
  channel.input = index;
  channel.part = form.part;
  channel.power = form.power;
  channel.low = static_cast<float>(input.lowest - room);
  channel.high = static_cast<float>(input.highest + room);
  const bool power = form.power != RegressorPower::kOne;
  channel.mean = static_cast<float>(power ? mean / regressor_unit(input, form.power) : mean);
  channel.inverse_scale = static_cast<float>(1.0 / channel_scale(input.lowest, input.highest));
  // The bounds of z include 0, which is the history of a new instance, whatever the range.
  if (form.part >= RegressorPart::kLength) {
    channel.part = RegressorPart::kSize;  // bounded like the size of a wind along its direction
    channel.most = regress(channel, channel.high);
    channel.least = form.part == RegressorPart::kLength ? 0.0f : -channel.most;
    channel.part = form.part;
    return channel;
  }
  const float ends[] = {regress(channel, channel.low), regress(channel, channel.high), regress(channel, 0.0f), 0.0f};
  channel.least = *std::min_element(std::begin(ends), std::end(ends));
  channel.most = *std::max_element(std::begin(ends), std::end(ends));
  return channel;
}

Result<void> check_channel(const std::string& what, double lowest, double highest, double mean) {
  const double size = std::max({std::abs(lowest), std::abs(highest), std::abs(mean)});
  if (!(size <= kLargest)) {
    return Error{what + " reaches " + std::to_string(size) + ", expected at most 1e12: choose a larger unit"};
  }
  if (!(highest >= lowest)) return Error{what + " has a range that ends before it begins"};
  if (highest > lowest && highest - lowest < kSmallest) {
    return Error{what + " has a range narrower than 1e-12: choose a smaller unit"};
  }
  return {};
}

}  // namespace

double channel_scale(double lowest, double highest) {
  constexpr double kPlain = 128;  // a range within this factor of 1 keeps the channel's unit, which saves a product
  if (!(highest - lowest < 1 / kPlain || highest - lowest > kPlain) || !(highest > lowest)) return 1.0;
  int exponent = 0;
  std::frexp(highest - lowest, &exponent);
  return std::ldexp(1.0, exponent - 1);
}

std::span<const RegressorForm> regressor_forms(InputShape shape) {
  using enum RegressorPart;
  using enum RegressorPower;
  static constexpr RegressorForm kLinear[] = {{kWhole}};
  static constexpr RegressorForm kPowers[] = {{kSize, kOne},  {kSize, kRoot},  {kSize, kSquare},
                                              {kWhole, kOne}, {kWhole, kRoot}, {kWhole, kSquare}};
  static constexpr RegressorForm kVector[] = {{kLength, kOne}, {kLength, kRoot}, {kLength, kSquare},
                                              {kAlong, kOne},  {kAlong, kRoot},  {kAlong, kSquare},
                                              {kAcross, kOne}, {kAcross, kRoot}, {kAcross, kSquare}};
  if (shape == InputShape::kWindAlong) return std::span(kVector).first(6);
  if (shape == InputShape::kWindAcross) return std::span(kVector).last(3);
  if (has_powers(shape)) return kPowers;
  return kLinear;
}

double regressor_scale(const Model& model, int regressor) {
  for (const Input& input : model.inputs) {
    const auto forms = regressor_forms(input.shape);
    if (regressor < static_cast<int>(forms.size())) return regressor_unit(input, forms[regressor].power);
    regressor -= static_cast<int>(forms.size());
  }
  return 1;
}

std::uint64_t hash_of(const Channels& channels, std::uint64_t before) {
  std::uint64_t hash = before;
  for (const OutputChannel& c : channels.outputs) hash = hash_floats({c.mean, c.scale, c.low, c.high}, hash);
  for (const RegressorChannel& c : channels.regressors) {
    const auto place = static_cast<float>((c.input * 3 + static_cast<int>(c.part)) * 3 + static_cast<int>(c.power));
    hash = hash_floats({place, c.low, c.high, c.mean, c.inverse_scale}, hash);
  }
  return hash;
}

std::vector<ValueRange> moved_ranges(const Model& model) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  if (outline && !outline->shape.empty()) return outline->shape.components;
  std::vector<ValueRange> ranges;
  for (const Output& output : model.outputs) ranges.push_back({output.lowest, output.highest});
  return ranges;
}

Channels make_channels(const Model& model, const OperatingPoint& point, Arena& arena) {
  const std::vector<ValueRange> ranges = moved_ranges(model);
  Channels channels{arena.take<OutputChannel>(ranges.size()),
                    arena.take<RegressorChannel>(regressor_count(model.inputs))};
  if (arena.measures()) return channels;
  for (std::size_t i = 0; i < ranges.size(); ++i) channels.outputs[i] = make_output(ranges[i], point.outputs[i]);
  std::size_t next = 0;
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    const Input& input = model.inputs[k];
    for (const RegressorForm form : regressor_forms(input.shape)) {
      const int first = static_cast<int>(k) - (input.shape == InputShape::kWindAcross ? 1 : 0);
      channels.regressors[next] = make_regressor(input, first, form, point.regressors[next]);
      ++next;
    }
  }
  return channels;
}

Result<void> check_channels(const Model& model, const OperatingPoint& point) {
  const std::vector<ValueRange> ranges = moved_ranges(model);
  const bool shaped = ranges.size() != model.outputs.size();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::string what = shaped ? "component " + std::to_string(i) : "output " + model.outputs[i].name;
    if (auto ok = check_channel(what, ranges[i].lowest, ranges[i].highest, point.outputs[i]); !ok) return ok;
  }
  std::size_t next = 0;
  for (const Input& input : model.inputs) {
    const auto means = point.regressors.subspan(next, static_cast<std::size_t>(regressor_count(input.shape)));
    if (is_vector(input.shape) && std::any_of(means.begin(), means.end(), [](double one) { return one != 0; })) {
      return Error{"input " + input.name + " is of a vector and has a mean, expected 0"};
    }
    for (const double mean : means) {
      if (auto ok = check_channel("input " + input.name, input.lowest, input.highest, mean); !ok) return ok;
    }
    next += means.size();
  }
  return {};
}

}  // namespace wisp
