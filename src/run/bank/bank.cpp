#include "wisp/run/bank.hpp"

#include <algorithm>
#include <new>
#include <string>
#include <type_traits>

#include "run/bank/bank_state.hpp"
#include "wisp/model/file.hpp"

namespace wisp {
namespace {

constexpr int kMaxCapacity = 1 << 20;
constexpr int kMaxPolylinePoints = 4096;

Result<void> check_options(const BankOptions& options) {
  if (options.capacity < 1 || options.capacity > kMaxCapacity) {
    return Error{"a bank's capacity is " + std::to_string(options.capacity) + ", expected 1 to 1048576"};
  }
  if (options.polyline_points < 2 || options.polyline_points > kMaxPolylinePoints) {
    return Error{"a bank's polyline has " + std::to_string(options.polyline_points) + " points, expected 2 to 4096"};
  }
  if (options.longest_advance.count() <= 0 || options.longest_advance > kLongestAdvance) {
    return Error{"a bank's longest advance is " + std::to_string(options.longest_advance.count()) +
                 " ns, expected above 0 and at most 10 s"};
  }
  return {};
}

Result<void> check_all(const Model& model, const BankOptions& options) {
  if (auto ok = check_options(options); !ok) return ok;
  if (const auto path = choose_frame_path(); !path) return path.error();
  if (auto ok = check(model); !ok) return ok;
  const auto check_kind = [&]<class Type>(const auto& dynamics, std::type_identity<Type>) -> Result<void> {
    if (auto ok = check_channels(model, Type::operating_point(dynamics)); !ok) return ok;
    return Type::check(model, dynamics);
  };
  return visit_dynamics<LiveNumbers>(model, check_kind);
}

bool has_outline(const Bank::State& state) {
  if (state.polyline.points > 0) return true;
  report_misuse("a polyline was asked of a bank whose model is no outline: look at polyline_points() first");
  return false;
}

}  // namespace

void Bank::Release::operator()(State* state) const {
  static_assert(std::is_trivially_destructible_v<State>);  // freeing the bank's memory destroys a State
  if (owned) ::operator delete(static_cast<void*>(state), std::align_val_t(kArenaAlignment));
}

Bank::Bank(std::unique_ptr<State, Release> state) : state_(std::move(state)) {}
Bank::Bank(Bank&&) noexcept = default;
Bank& Bank::operator=(Bank&&) noexcept = default;
Bank::~Bank() = default;

Result<std::size_t> bank_bytes(const Model& model, const BankOptions& options) {
  if (auto ok = check_all(model, options); !ok) return ok.error();
  Arena arena;
  arena.take<std::byte>(sizeof(Bank::State));
  const Bank::State measured(model, options, arena);
  return arena.bytes();
}

Result<Bank> Bank::create(const Model& model, const BankOptions& options) {
  const auto bytes = bank_bytes(model, options);
  if (!bytes) return bytes.error();
  std::span<std::byte> memory = options.memory;
  const bool owned = memory.data() == nullptr;
  if (!owned && memory.size() < *bytes) {
    return Error{"a bank was given " + std::to_string(memory.size()) + " bytes, expected at least " +
                 std::to_string(*bytes) + ": ask bank_bytes()"};
  }
  if (owned) {
    void* fresh = ::operator new(*bytes, std::align_val_t(kArenaAlignment), std::nothrow);
    if (!fresh) return Error{"no memory for a bank of " + std::to_string(*bytes) + " bytes: choose a smaller capacity"};
    memory = {static_cast<std::byte*>(fresh), *bytes};
  }
  Arena arena(memory);
  void* place = arena.take<std::byte>(sizeof(State)).data();
  std::unique_ptr<State, Release> state(new (place) State(model, options, arena), Release{owned});
  state->path = *choose_frame_path();
  return Bank(std::move(state));
}

int Bank::capacity() const { return state_->capacity; }
int Bank::size() const { return state_->living; }
int Bank::slots() const { return state_->rows; }
int Bank::input_count() const { return state_->inputs; }
int Bank::output_count() const { return static_cast<int>(state_->visible); }
int Bank::polyline_points() const { return state_->polyline.points; }
std::chrono::nanoseconds Bank::step_time() const { return std::chrono::nanoseconds(state_->step_time); }
bool Bank::valid(InstanceId id) const { return state_->valid(id); }
Bank::Clamped Bank::clamped() const { return state_->clamped; }
float Bank::noise() const { return state_->noise; }

ChainFacet* Bank::chain() { return state_->chain_stepper() ? &state_->chain_facet : nullptr; }
const ChainFacet* Bank::chain() const { return const_cast<Bank*>(this)->chain(); }
ExtinctionFacet* Bank::extinction() { return state_->extinction.present ? &state_->extinction_facet : nullptr; }
const ExtinctionFacet* Bank::extinction() const { return const_cast<Bank*>(this)->extinction(); }
BodyFacet* Bank::body() { return state_->shape.across > 0 ? &state_->body_facet : nullptr; }
const BodyFacet* Bank::body() const { return const_cast<Bank*>(this)->body(); }

std::optional<int> Bank::mode(InstanceId id) const {
  const auto* switched = state_->switched_stepper();
  if (!switched || !valid(id)) return {};
  return switched->mode(static_cast<int>(id.slot) / State::kLanes, static_cast<int>(id.slot) % State::kLanes);
}

InstanceId Bank::at(int slot) const {
  if (slot < 0 || slot >= state_->rows || !state_->alive[slot]) return {};
  return {static_cast<std::uint32_t>(slot), state_->generation[slot]};
}

InstanceId Bank::spawn() { return spawn(state_->spawned); }

InstanceId Bank::spawn(std::uint64_t stream) {
  State& s = *state_;
  if (s.living == s.capacity) return {};
  int slot = s.lowest_free;
  while (s.alive[slot]) ++slot;
  s.lowest_free = slot + 1;
  s.alive[slot] = 1;
  s.generation[slot] = std::max(s.generation[slot] + 1, 1U);
  s.stream[slot] = stream;
  s.rows = std::max(s.rows, slot + 1);
  ++s.living;
  ++s.spawned;
  s.set_lane_inputs(slot, nullptr);
  s.start(slot);
  return at(slot);
}

bool Bank::end(InstanceId id) {
  State& s = *state_;
  if (!s.valid(id)) return false;
  const int slot = static_cast<int>(id.slot);
  s.alive[slot] = 0;
  --s.living;
  s.lowest_free = std::min(s.lowest_free, slot);
  while (s.rows > 0 && !s.alive[s.rows - 1]) --s.rows;
  return true;
}

void Bank::set_inputs(std::span<const float> values) {
  State& s = *state_;
  if (!check_size("Bank::set_inputs()", values.size(), static_cast<std::size_t>(s.rows) * s.inputs, true)) return;
  s.path->set_inputs(&s, values.data());
}

void Bank::set_common_inputs(std::span<const float> values) {
  State& s = *state_;
  if (!check_size("Bank::set_common_inputs()", values.size(), static_cast<std::size_t>(s.inputs))) return;
  s.path->set_common_inputs(&s, values.data());
}

bool Bank::set_inputs(InstanceId id, std::span<const float> values) {
  if (!valid(id)) return false;
  if (!check_size("Bank::set_inputs()", values.size(), static_cast<std::size_t>(state_->inputs))) return false;
  state_->set_lane_inputs(static_cast<int>(id.slot), values.data());
  return true;
}

void Bank::set_noise(float scale) {
  const float clamped = std::min(scale, kMaxNoise);
  state_->set_noise(clamped >= kMinNoise ? clamped : 0.0f);
}

void Bank::set_crew(const Crew& crew) {
  if (crew.parts < 1) return report_misuse("Bank::set_crew() was given less than one part");
  state_->crew = crew;
}

void Bank::step() { step(1); }

void Bank::step(int count, std::span<const float> inputs, std::span<float> outputs) {
  State& s = *state_;
  const auto row_in = static_cast<std::size_t>(s.rows) * s.inputs;
  const auto row_out = static_cast<std::size_t>(s.rows) * s.visible;
  if (count <= 0) return count < 0 ? report_misuse("Bank::step() was given a negative count") : void();
  if (!inputs.empty() && !check_size("Bank::step()", inputs.size(), static_cast<std::size_t>(count) * row_in)) return;
  if (!outputs.empty() && !check_size("Bank::step()", outputs.size(), static_cast<std::size_t>(count) * row_out))
    return;
  s.begin_call();
  s.passed = 0;
  s.between = false;
  if (kAhead) {
    return s.step_all({count, inputs.empty() ? nullptr : inputs.data(), outputs.empty() ? nullptr : outputs.data()});
  }
  for (std::size_t t = 0; t < static_cast<std::size_t>(count); ++t) {
    if (!inputs.empty()) set_inputs(inputs.subspan(t * row_in, row_in));
    s.step_all({});
    if (!outputs.empty()) this->outputs(outputs.subspan(t * row_out, row_out));
  }
}

int Bank::advance(std::chrono::nanoseconds time) {
  State& s = *state_;
  s.begin_call();
  s.passed += std::clamp<std::int64_t>(time.count(), 0, s.longest);
  const auto steps = static_cast<int>(s.passed / s.step_time);
  s.passed %= s.step_time;
  s.between = true;
  if (kAhead && steps > 1) {
    s.step_all({.count = steps});
  } else {
    for (int k = 1; k <= steps; ++k) s.step_all({.show = k == steps});
  }
  if (steps == 0) s.show();
  return steps;
}

int Bank::advance(double seconds) {
  const double longest = std::chrono::duration<double>(kLongestAdvance).count();
  const double time = seconds > 0 ? std::min(seconds, longest) : 0;
  return advance(std::chrono::nanoseconds(static_cast<std::int64_t>(time * 1e9 + 0.5)));
}

void Bank::outputs(std::span<float> values) const {
  const State& s = *state_;
  const std::size_t used = s.rows * s.visible;
  if (!check_size("Bank::outputs()", values.size(), used, true)) return;
  for (int block = 0; block < s.blocks(); ++block) s.read_block(block, values.data());
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(used), values.end(), 0.0F);
}

bool Bank::outputs(InstanceId id, std::span<float> values) const {
  if (!valid(id)) return false;
  if (!check_size("Bank::outputs()", values.size(), state_->visible)) return false;
  state_->read_outputs(static_cast<int>(id.slot), values.data());
  return true;
}

void Bank::polylines(std::span<float> values) const {
  const State& s = *state_;
  const std::size_t used = static_cast<std::size_t>(s.rows) * s.polyline.points * 2;
  if (!has_outline(s) || !check_size("Bank::polylines()", values.size(), used, true)) return;
  s.path->polylines(&s, values.data());
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(used), values.end(), 0.0F);
}

bool Bank::polyline(InstanceId id, std::span<float> values) const {
  const State& s = *state_;
  if (!s.valid(id)) return false;
  if (!has_outline(s)) return false;
  if (!check_size("Bank::polyline()", values.size(), static_cast<std::size_t>(s.polyline.points) * 2)) return false;
  const int block = static_cast<int>(id.slot) / State::kLanes, lane = static_cast<int>(id.slot) % State::kLanes;
  s.polyline_of(block, [&](int number, const float* lane_values) { values[number] = lane_values[lane]; });
  return true;
}

bool Bank::reset(InstanceId id) {
  if (!valid(id)) return false;
  state_->start(static_cast<int>(id.slot));
  return true;
}

void Bank::reset() {
  for (int slot = 0; slot < state_->rows; ++slot) {
    if (state_->alive[slot]) state_->start(slot);
  }
  state_->passed = 0;
}

}  // namespace wisp
