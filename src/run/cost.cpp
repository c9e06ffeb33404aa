#include "wisp/run/cost.hpp"

#include <vector>

#include "run/arx_stepper.hpp"
#include "run/counting.hpp"
#include "run/outline_lanes.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

std::vector<std::byte> room_for(const Arena& measured) { return std::vector<std::byte>(measured.bytes()); }

// Operations of `work`.
template <class Work>
OperationCount count(Work work) {
  operation_count = {};
  work();
  return operation_count;
}

OperationCount count_inputs(const Channels& channels) {
  return count([&] {
    for (const RegressorChannel& channel : channels.regressors) regress(channel, CountingReal(channel.low));
  });
}

template <class Stepper>
OperationCount count_step(Stepper& stepper, float noise) {
  const RandomKeys keys = random_keys(1);
  const std::uint64_t stream = 0, age = 0;
  std::uint32_t held = 0;
  stepper.set_noise(noise);
  return count([&] {
    stepper.turn();
    stepper.step(0, {&keys, {&stream, &age}, &held});
  });
}

template <class Stepper>
OperationCount count_view(const Channels& channels, const Stepper& stepper, std::span<const PolylinePoint> polyline) {
  std::vector<CountingReal> shown(channels.outputs.size());
  return count([&] {
    show_between<CountingNumbers>(channels, stepper.previous(0), stepper.newest(0), 0.5f, shown.data());
    for (const PolylinePoint& point : polyline) {
      for (int coordinate : {0, 1}) polyline_lanes<CountingNumbers>(point, coordinate, shown.data());
    }
  });
}

Cost count_frame(const Model& model, const ArxModel& arx, const Channels& channels,
                 std::span<const PolylinePoint> polyline) {
  Arena measured;
  ArxStepper<CountingNumbers>(model, arx, channels, 1, measured);
  std::vector<std::byte> memory = room_for(measured);
  Arena arena(memory);
  ArxStepper<CountingNumbers> stepper(model, arx, channels, 1, arena);
  const OperationCount quiet = count_step(stepper, 0), noisy = count_step(stepper, 1);
  Cost cost;
  cost.multiply_adds_per_frame = stepper.multiply_adds();
  cost.dynamics_operations = count_inputs(channels).numbers + quiet.numbers;
  cost.noise_operations = noisy.numbers - quiet.numbers;
  cost.random_operations = noisy.words - quiet.words;
  cost.view_operations = count_view(channels, stepper, polyline).numbers;
  cost.operations_per_frame =
      cost.dynamics_operations + cost.noise_operations + cost.random_operations + cost.view_operations;
  return cost;
}

}  // namespace

Result<Cost> count_operations(const Model& model, int polyline_points) {
  if (const auto bytes = bank_bytes(model, {.polyline_points = polyline_points ? polyline_points : 2}); !bytes) {
    return bytes.error();
  }
  const auto* outline = std::get_if<OutlineView>(&model.view);
  const int points = outline ? polyline_points : 0;
  return std::visit(
      [&](const auto& dynamics) -> Result<Cost> {
        const OperatingPoint point{dynamics.output_mean, dynamics.input_mean};
        Arena measured;
        make_channels(model, point, measured);
        if (points) make_polyline(*outline, points, measured);
        std::vector<std::byte> memory = room_for(measured);
        Arena arena(memory);
        const Channels channels = make_channels(model, point, arena);
        const auto polyline = points ? make_polyline(*outline, points, arena) : std::span<PolylinePoint>();
        return count_frame(model, dynamics, channels, polyline);
      },
      model.dynamics);
}

}  // namespace wisp
