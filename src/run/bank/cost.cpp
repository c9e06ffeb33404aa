#include "wisp/run/cost.hpp"

#include <algorithm>
#include <vector>

#include "run/bank/extinction_lanes.hpp"
#include "run/bank/outline_lanes.hpp"
#include "run/bank/shape_lanes.hpp"
#include "run/bank/stepper.hpp"
#include "run/lanes/counting.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

template <class Work>
OperationCount count(Work work) {
  operation_count = {};
  work();
  return operation_count;
}

// Returns regressors for inputs at their highest values: strong wind from one side.
std::vector<CountingReal> blowing_regressors(const Model& model, const Channels& channels) {
  std::vector<CountingReal> values(channels.regressors.size());
  const auto highest = [&](int input) {
    return all<Reals<CountingNumbers>>(static_cast<float>(model.inputs[static_cast<std::size_t>(input)].highest));
  };
  Regressing<CountingNumbers, decltype(highest)> regressing(highest);
  for (std::size_t k = 0; k < values.size(); ++k) store(regressing(channels.regressors[k]), &values[k]);
  return values;
}

// Course of the inputs while steps are counted.
enum class Course {
  kSteady,    // every input is at its highest
  kSwinging,  // inputs rise from 0 nearly to their highest again and again, so that resampled residuals search
  kSteered,   // inputs as in kSteady, while a chain is steered
};

// Returns the factor on the regressors in a step: 1, or in kSwinging a ramp from 0 to 23/24 over every 24 steps.
float share_of(Course course, std::uint64_t step) {
  constexpr std::uint64_t kSwing = 24;
  return course == Course::kSwinging ? static_cast<float>(step % kSwing) / kSwing : 1.0f;
}

// Operations of one step: the rounded mean, and the maximum, over kFrames steps.
struct StepCount {
  OperationCount mean;
  std::int64_t most = 0;
};

template <class Stepper>
StepCount count_step(Stepper& stepper, std::span<const CountingReal> regressors, float noise,
                     Course course = Course::kSteady) {
  constexpr int kFrames = Stepper::kCountedFrames;
  const RandomKeys keys = random_keys(1);
  const std::uint64_t stream = 0, born = 0;
  std::uint32_t clamped = 0;
  stepper.set_noise(noise);
  stepper.start(0, 0, {&keys, {&stream, &born, 0}, &clamped});
  if constexpr (requires { stepper.can_steer(); }) {
    if (course == Course::kSteered) stepper.steer(0, 0, {}, 3.0f * kFrames, 0.1f);
  }
  const auto play = [&](std::uint64_t step) {
    stepper.turn();
    for (std::size_t k = 0; k < regressors.size(); ++k) {
      stepper.regressors(0)[k] = CountingReal(share_of(course, step) * regressors[k].value);
    }
    stepper.step(0, {&keys, {&stream, &born, step}, &clamped});
  };
  for (std::uint64_t step = 0; step < kFrames; ++step) play(step);  // warms up; not counted
  OperationCount all;
  std::int64_t most = 0;
  for (std::uint64_t step = kFrames; step < 2 * kFrames; ++step) {
    const OperationCount one = count([&] { play(step); });
    all.numbers += one.numbers;
    all.words += one.words;
    most = std::max(most, one.numbers + one.words);
  }
  const auto mean = [](std::int64_t sum) { return (sum + kFrames / 2) / kFrames; };
  const std::int64_t numbers = mean(all.numbers);
  return {{numbers, mean(all.numbers + all.words) - numbers}, most};
}

// The counted parts of an instance: its dynamics, and its display with a polyline of `points` points (0: none).
template <class Stepper>
struct Played {
  template <class Kind>
  Played(const Model& model, const Kind& dynamics, int points, Arena& arena)
      : channels(make_channels(model, Stepper::operating_point(dynamics), arena)),
        shape(make_shape_program(model, arena)),
        stepper(model, dynamics, channels, 1, arena) {
    if (points > 0) polyline = make_polyline(std::get<OutlineView>(model.view), points, arena);
  }

  Channels channels;
  ShapeProgram shape;
  PolylineProgram polyline;
  Stepper stepper;
};

template <class Stepper>
OperationCount count_view(const Played<Stepper>& played) {
  const ShapeProgram& shape = played.shape;
  const PolylineProgram& polyline = played.polyline;
  std::vector<CountingReal> made(played.channels.outputs.size()), points(2 * shape.points);
  std::vector<CountingReal>& shown = shape.empty() ? made : points;
  return count([&] {
    played.stepper.show_frame(0, made.data());
    if (!shape.empty()) {
      shape_lanes<CountingNumbers>(shape, made.data(),
                                   [&](std::size_t i, const auto& value) { store(value, &points[i]); });
    }
    if (polyline.points == 0) return;
    for (int coordinate : {0, 1}) {
      polyline_lanes<CountingNumbers>(polyline, coordinate, shown.data(), [](int, const auto&) {});
    }
  });
}

struct ExtinctionCount {
  std::int64_t burning = 0;    // operations to read the wind and make a step of the rule
  std::int64_t shrinking = 0;  // additional operations of an instance in an event of extinction or re-ignition
};

ExtinctionCount count_extinction(const Model& model) {
  Arena unused;
  const ExtinctionProgram rule = make_extinction_program(model, unused);
  if (!rule.present) return {};
  const auto* outline = std::get_if<OutlineView>(&model.view);
  const std::size_t recorded = outline && !model.extinction->catching.scale.empty() ? outline->shape.count() : 0;
  CountingReal wind, harm, lit(1.0f), size(1.0f);
  std::vector<CountingReal> shown(model.outputs.size());
  const OperationCount burning = count([&] {
    blowing<CountingNumbers>(rule, [](int) { return Reals<CountingNumbers>{}; });
    live<CountingNumbers>(rule, {&wind, &harm, &lit});
  });
  const OperationCount shrinking = count([&] {
    // Interpolates each recorded component; for a model without recorded components, the size.
    for (std::size_t k = 0; k < std::max<std::size_t>(recorded, 1); ++k) size = nearer(size, CountingReal(1.0f), 0.5f);
    const auto now = load<Reals<CountingNumbers>>(&size);
    shrink<CountingNumbers>(size_between<CountingNumbers>(now, now, 0.5f), shown.size(), shown.data());
  });
  return {burning.numbers, shrinking.numbers};
}

template <class Stepper>
Cost count_frame(const Model& model, Played<Stepper>& played) {
  Stepper& stepper = played.stepper;
  std::vector<CountingReal> blowing;
  const OperationCount inputs = count([&] { blowing = blowing_regressors(model, played.channels); });
  const OperationCount quiet = count_step(stepper, blowing, 0).mean;
  const auto [noisy, steady] = count_step(stepper, blowing, 1);
  const std::int64_t most = std::max(steady, count_step(stepper, blowing, 1, Course::kSwinging).most);
  Cost cost;
  cost.multiply_adds_per_frame = stepper.multiply_adds();
  cost.dynamics_operations = inputs.numbers + quiet.numbers + quiet.words;
  cost.noise_operations = noisy.numbers - quiet.numbers;
  cost.random_operations = noisy.words - quiet.words;
  cost.view_operations = count_view(played).numbers;
  const ExtinctionCount extinction = count_extinction(model);
  cost.extinction_operations = extinction.burning;
  cost.operations_per_frame = cost.dynamics_operations + cost.noise_operations + cost.random_operations +
                              cost.view_operations + cost.extinction_operations;
  cost.worst_operations = cost.operations_per_frame - (noisy.numbers + noisy.words) + most + extinction.shrinking;
  if constexpr (requires { stepper.can_steer(); }) {
    const std::int64_t steered = stepper.can_steer() ? count_step(stepper, blowing, 1, Course::kSteered).most : 0;
    if (steered > 0) cost.steered_operations = cost.worst_operations - most + steered;
  }
  return cost;
}

}  // namespace

Result<Cost> count_operations(const Model& model, int polyline_points) {
  if (const auto bytes = bank_bytes(model, {.polyline_points = polyline_points ? polyline_points : 2}); !bytes) {
    return bytes.error();
  }
  const int points = std::holds_alternative<OutlineView>(model.view) ? polyline_points : 0;
  const auto count_kind = [&]<class Type>(const auto& dynamics, std::type_identity<Type>) -> Result<Cost> {
    Arena measured;
    Played<Type>(model, dynamics, points, measured);
    std::vector<std::byte> memory(measured.bytes());
    Arena arena(memory);
    Played<Type> played(model, dynamics, points, arena);
    return count_frame(model, played);
  };
  return visit_dynamics<CountingNumbers>(model, count_kind);
}

}  // namespace wisp
