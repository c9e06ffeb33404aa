#include "run/bank_state.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

OperatingPoint operating_point(const Model& model) {
  const auto of_kind = []<class Type>(const auto& dynamics, std::type_identity<Type>) {
    return Type::operating_point(dynamics);
  };
  return visit_dynamics<LiveNumbers>(model, of_kind);
}

Stepper make_stepper(const Model& model, const Channels& channels, int blocks, Arena& arena) {
  const auto of_kind = [&]<class Type>(const auto& dynamics, std::type_identity<Type>) -> Stepper {
    return Type(model, dynamics, channels, blocks, arena);
  };
  return visit_dynamics<LiveNumbers>(model, of_kind);
}

std::span<PolylinePoint> make_view(const Model& model, int points, Arena& arena) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  return outline ? make_polyline(*outline, points, arena) : std::span<PolylinePoint>();
}

}  // namespace

std::chrono::nanoseconds step_time(const Model& model) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(kNanosecondsPerSecond / model.rate_hz + 0.5));
}

Bank::State::State(const Model& model, const BankOptions& options, Arena& arena)
    : capacity(options.capacity),
      inputs(static_cast<int>(model.inputs.size())),
      seed(options.seed),
      keys(random_keys(options.seed)),
      step_time(wisp::step_time(model).count()),
      channels(make_channels(model, operating_point(model), arena)),
      stepper(make_stepper(model, channels, (capacity + kLanes - 1) / kLanes, arena)),
      polyline(make_view(model, options.polyline_points, arena)) {
  const std::size_t lanes = static_cast<std::size_t>((capacity + kLanes - 1) / kLanes) * kLanes;
  model_hash = std::visit([&](const auto& dynamics) { return dynamics.hash(hash_of(channels, step_time)); }, stepper);
  set_noise(1.0f);
  generation = arena.take<std::uint32_t>(lanes);
  alive = arena.take<std::uint8_t>(lanes);
  stream = arena.take<std::uint64_t>(lanes);
  born = arena.take<std::uint64_t>(lanes);
  regressors = arena.take<float>(lanes * regressor_count(model.inputs));
  shown = arena.take<float>(lanes * model.outputs.size());
  if (arena.measures()) return;
  for (std::size_t slot = 0; slot < lanes; ++slot) start(static_cast<int>(slot));
}

void Bank::State::start(int slot) {
  const int block = slot / kLanes, lane = slot % kLanes;
  born[slot] = steps;
  std::uint32_t flags[kLanes];
  std::visit([&](auto& dynamics) { dynamics.start(block, lane, moment(block, flags)); }, stepper);
  show_block(block);
}

// Rows of the first `count` lanes of a block; what the others get is cleared when an instance is spawned there.
void Bank::State::set_inputs(int block, const float* values, int count) {
  float* out = regressors_of(block);
  for (const RegressorChannel& channel : channels.regressors) {
    float lanes[kLanes] = {};
    const float* row = lanes;
    if (inputs == 1 && count == kLanes) {
      row = values;  // they lie as lanes do
    } else {
      for (int lane = 0; lane < count; ++lane) lanes[lane] = values[lane * inputs + channel.input];
    }
    store(regress<LiveNumbers>(channel, load<Reals<LiveNumbers>>(row)), out);
    out += kLanes;
  }
}

void Bank::State::set_common_inputs(int block, const float* values) {
  float* out = regressors_of(block);
  for (const RegressorChannel& channel : channels.regressors) {
    store(regress<LiveNumbers>(channel, all<Reals<LiveNumbers>>(values[channel.input])), out);
    out += kLanes;
  }
}

void Bank::State::set_lane_inputs(int slot, const float* values) {
  float* out = regressors_of(slot / kLanes) + slot % kLanes;
  for (const RegressorChannel& channel : channels.regressors) {
    const float input = values ? values[channel.input] : 0.0f;
    float lanes[kLanes];
    store(regress<LiveNumbers>(channel, all<Reals<LiveNumbers>>(input)), lanes);
    *out = lanes[0];
    out += kLanes;
  }
}

void Bank::State::set_noise(float scale) {
  noise = scale;
  std::visit([&](auto& dynamics) { dynamics.set_noise(scale); }, stepper);
}

Moment<LiveNumbers> Bank::State::moment(int block, std::uint32_t* flags) const {
  const std::size_t first = static_cast<std::size_t>(block) * kLanes;
  return {&keys, {stream.data() + first, born.data() + first, steps}, flags};
}

void Bank::State::step_all() {
  std::visit(
      [&](auto& dynamics) {
        dynamics.turn();
        const std::size_t size = channels.regressors.size() * kLanes;
        for (int block = 0; block < blocks(); ++block) {
          if (size > 0) std::copy_n(regressors_of(block), size, dynamics.regressors(block));
          std::uint32_t flags[kLanes];
          dynamics.step(block, moment(block, flags));
          const std::uint8_t* living_lanes = alive.data() + static_cast<std::size_t>(block) * kLanes;
          for (int lane = 0; lane < kLanes; ++lane) held.held += (flags[lane] & 1) & living_lanes[lane];
        }
      },
      stepper);
  ++steps;
  held.steps += static_cast<std::uint64_t>(living);
}

void Bank::State::show() {
  for (int block = 0; block < blocks(); ++block) show_block(block);
}

void Bank::State::show_block(int block) {
  std::visit(
      [&](const auto& dynamics) {
        if (between) {
          const float share = static_cast<float>(passed) / static_cast<float>(step_time);
          dynamics.show_between(block, share, shown_of(block));
        } else {
          dynamics.show(block, shown_of(block));
        }
      },
      stepper);
}

void Bank::State::read_outputs(int slot, float* values) const {
  const float* row = shown_of(slot / kLanes) + slot % kLanes;
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) values[i] = row[i * kLanes];
}

}  // namespace wisp
