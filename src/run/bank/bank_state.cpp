#include "run/bank/bank_state.hpp"
#include "run/lanes/columns.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

namespace wisp {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;
constexpr int kGroupOfBlocks = 8;

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

PolylineProgram make_view(const Model& model, int points, Arena& arena) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  return outline ? make_polyline(*outline, points, arena) : PolylineProgram();
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
      shape(make_shape_program(model, arena)),
      visible(model.outputs.size()),
      polyline(make_view(model, options.polyline_points, arena)),
      extinction(make_extinction_program(model, arena)) {
  const std::size_t lanes = static_cast<std::size_t>((capacity + kLanes - 1) / kLanes) * kLanes;
  model_hash = std::visit([&](const auto& dynamics) { return dynamics.hash(hash_of(channels, step_time)); }, stepper);
  model_hash = hash_of(extinction, hash_of(shape, model_hash));
  set_noise(1.0f);
  generation = arena.take<std::uint32_t>(lanes);
  alive = arena.take<std::uint8_t>(lanes);
  stream = arena.take<std::uint64_t>(lanes);
  born = arena.take<std::uint64_t>(lanes);
  regressors = arena.take<float>(lanes * regressor_count(model.inputs));
  shown = arena.take<float>(lanes * visible);
  components = arena.take<float>(lanes * shape.components());
  if (extinction.present) {
    for (auto* values : {&wind, &harm, &lit, &size, &previous_size, &event, &carried})
      *values = arena.take<float>(lanes);
    last_shape = arena.take<float>(lanes * visible);
    lit_at = arena.take<std::uint64_t>(lanes);
    out_at = arena.take<std::uint64_t>(lanes);
  }
  if (arena.measures()) return;
  for (std::size_t slot = 0; slot < lanes; ++slot) start(static_cast<int>(slot));
}

void Bank::State::start(int slot) {
  const int block = slot / kLanes, lane = slot % kLanes;
  born[slot] = steps;
  std::uint32_t flags[kLanes];
  std::visit([&](auto& dynamics) { dynamics.start(block, lane, moment(block, flags)); }, stepper);
  if (extinction.present) {
    harm[slot] = 0.0f;
    lit[slot] = size[slot] = previous_size[slot] = 1.0f;
    event[slot] = kNoEvent;
    carried[slot] = 0.0f;
    lit_at[slot] = out_at[slot] = kNeverInSteps;
    for (std::size_t i = 0; i < visible; ++i) last_shape_of(block)[i * kLanes + lane] = 0.0f;
  }
  show_block(block);
}

// The instance starts from rest, as a new one does. Its random stream goes on, so that it does not repeat its first
// flicker.
void Bank::State::relight(int slot) {
  if (burns(slot)) return;
  const int block = slot / kLanes, lane = slot % kLanes;
  std::uint32_t flags[kLanes];
  std::visit([&](auto& dynamics) { dynamics.start(block, lane, moment(block, flags)); }, stepper);
  harm[slot] = 0.0f;
  lit[slot] = 1.0f;
  lit_at[slot] = steps;
  begin_event(slot, extinction.catching, steps);
  if (size[slot] > 0.0f) carried[slot] = size[slot] - extinction.sizes[static_cast<std::size_t>(event[slot])];
  show_block(block);
}

void Bank::State::extinguish(int slot) {
  if (!burns(slot)) return;
  harm[slot] = 1.0f;
  lit[slot] = 0.0f;
  const int block = slot / kLanes;
  go_out(slot, std::visit([&](const auto& dynamics) { return dynamics.newest(block); }, stepper), steps);
}

LitState Bank::State::lit_state(int slot) const {
  const std::int64_t shown_late = between ? step_time - passed : 0;
  const auto since = [&](std::uint64_t then) {
    constexpr auto kLongest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (steps - then > kLongest / static_cast<std::uint64_t>(step_time)) return kNever;  // true of kNeverInSteps too
    const auto ago = static_cast<std::int64_t>(steps - then) * step_time - shown_late;
    return std::chrono::nanoseconds(std::max<std::int64_t>(ago, 0));
  };
  LitState state{lit[slot] != 0.0f, size[slot], since(lit_at[slot]), since(out_at[slot])};
  if (between) {
    const float share = static_cast<float>(passed) / static_cast<float>(step_time);
    state.size = previous_size[slot] + share * (size[slot] - previous_size[slot]);
  }
  return state;
}

void Bank::State::set_lane_inputs(int slot, const float* values) {
  float lanes[kLanes];
  float* out = regressors_of(slot / kLanes) + slot % kLanes;
  for (const RegressorChannel& channel : channels.regressors) {
    const float input = values ? values[channel.input] : 0.0f;
    store(regress<LiveNumbers>(channel, all<Reals<LiveNumbers>>(input)), lanes);
    *out = lanes[0];
    out += kLanes;
  }
  if (!extinction.present) return;
  const float input = values ? values[extinction.input] : 0.0f;
  store(blowing<LiveNumbers>(extinction, all<Reals<LiveNumbers>>(input)), lanes);
  wind[slot] = lanes[0];
}

void Bank::State::set_noise(float scale) {
  noise = scale;
  std::visit([&](auto& dynamics) { dynamics.set_noise(scale); }, stepper);
}

void Bank::State::set_chain(const ChainSettings& settings) {
  chain = settings;
  if (auto* stepped = chain_stepper()) stepped->set_chain(settings);
}

// Work is divided into whole groups of blocks, so that no two threads write to one cache line.
template <class Work>
std::uint64_t Bank::State::share(Work work) {
  const bool shared = crew.run && std::visit([](const auto& dynamics) { return dynamics.can_be_shared(); }, stepper);
  const int groups = (blocks() + kGroupOfBlocks - 1) / kGroupOfBlocks;
  const int parts = shared ? std::min(crew.parts, groups) : 1;
  if (parts <= 1) return work(0, blocks());
  struct Task {
    const State& state;
    Work& work;
    int groups;
    int parts;
    std::atomic<std::uint64_t> sum = 0;

    int begin(int part) const {
      const auto group = static_cast<int>(static_cast<std::int64_t>(groups) * part / parts);
      return std::min(group * kGroupOfBlocks, state.blocks());
    }
  } task{*this, work, groups, parts};
  const auto do_part = [](void* of, int part) {
    Task& own = *static_cast<Task*>(of);
    own.sum.fetch_add(own.work(own.begin(part), own.begin(part + 1)), std::memory_order_relaxed);
  };
  crew.run(crew.pool, parts, do_part, &task);
  return task.sum;
}

// The outputs that are shown depend on `passed` and `between`, which the caller sets before.
void Bank::State::step_all(const Steps& made) {
  const auto turn = [this](int samples) { std::visit([&](auto& dynamics) { dynamics.turn(samples); }, stepper); };
  turn(1);
  clamped.clamped += share([&](int first, int last) { return path->step(*this, first, last, made); });
  if (kAhead) turn(made.count - 1);
  steps += static_cast<std::uint64_t>(made.count);
  clamped.steps += static_cast<std::uint64_t>(made.count) * static_cast<std::uint64_t>(living);
}

void Bank::State::show() {
  share([this](int first, int last) {
    path->show(*this, first, last);
    return std::uint64_t{0};
  });
}

}  // namespace wisp
