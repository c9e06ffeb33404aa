// The state of a bank, and its serialised form. Little-endian: 8 bytes magic, 4 version, 4 zero, 8 size of the part
// after the header, 8 hash of that part; then the bank's own fields, then one record of equal size for every slot.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/hash.hpp"
#include "run/bank/bank_state.hpp"
#include "run/lanes/columns.hpp"
#include "run/state/model_hash.hpp"

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
      extinction(make_extinction_program(model, arena)),
      longest(options.longest_advance.count()) {
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
  round_points = arena.take<float>(shape.across > 0 ? 2 * visible * kLanes : 0);
  round_lines = arena.take<float>(shape.across > 0 ? static_cast<std::size_t>(4 * polyline.points) * kLanes : 0);
  if (extinction.present) {
    for (auto* values : {&wind, &harm, &lit, &size, &previous_size, &event, &left, &previous_left})
      *values = arena.take<float>(lanes);
    offset = arena.take<float>(lanes * moved());
    lit_at = arena.take<std::uint64_t>(lanes);
    out_at = arena.take<std::uint64_t>(lanes);
    by_hand = arena.take<std::uint8_t>(lanes);
  }
  if (arena.measures()) return;
  for (std::size_t slot = 0; slot < lanes; ++slot) start(static_cast<int>(slot));
  rest_area = 1;
  if (polyline.points > 0) rest_area = light_of(0).intensity;
}

void Bank::State::start(int slot) {
  const int block = slot / kLanes, lane = slot % kLanes;
  born[slot] = steps;
  std::visit([&](auto& dynamics) { dynamics.start(block, lane, moment(block, nullptr)); }, stepper);
  if (extinction.present) {
    harm[slot] = 0.0f;
    lit[slot] = size[slot] = previous_size[slot] = 1.0f;
    event[slot] = kNoEvent;
    left[slot] = previous_left[slot] = 0.0f;
    lit_at[slot] = out_at[slot] = kNeverInSteps;
    by_hand[slot] = 0;
    for (std::size_t i = 0; i < moved(); ++i) offset_of(slot, i) = 0.0f;
  }
  show_block(block);
}

// Restarts the dynamics at the operating point. The random stream goes on, so that the first flicker is not repeated.
void Bank::State::relight(int slot) {
  if (burns(slot)) return;
  const int block = slot / kLanes, lane = slot % kLanes;
  std::visit([&](auto& dynamics) { dynamics.start(block, lane, moment(block, nullptr)); }, stepper);
  harm[slot] = 0.0f;
  lit[slot] = 1.0f;
  lit_at[slot] = steps;
  by_hand[slot] = handled = true;
  begin_event(slot, extinction.catching, steps);
  left[slot] = previous_left[slot] = size[slot] > 0.0f ? 1.0f : 0.0f;
  for (std::size_t i = 0; i < moved(); ++i) {
    float& beside = offset_of(slot, i);
    beside = extinction.shapes.empty() ? 0.0f : beside - recorded_component(static_cast<std::size_t>(event[slot]), i);
  }
  show_block(block);
}

void Bank::State::extinguish(int slot) {
  if (!burns(slot)) return;
  harm[slot] = 1.0f;
  by_hand[slot] = handled = true;
  const int block = slot / kLanes;
  go_out(slot, std::visit([&](const auto& dynamics) { return dynamics.newest(block); }, stepper), steps);
  show_block(block);
}

LitState Bank::State::lit_state(int slot) const {
  const std::int64_t shown_late = between ? step_time - passed : 0;
  const auto since = [&](std::uint64_t then) {
    constexpr auto kLongest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (steps - then > kLongest / static_cast<std::uint64_t>(step_time)) return kNever;  // also holds for kNeverInSteps
    const auto ago = static_cast<std::int64_t>(steps - then) * step_time - shown_late;
    return std::chrono::nanoseconds(std::max<std::int64_t>(ago, 0));
  };
  const auto just = [&](std::uint64_t then) {
    return steps - then < steps - called || (by_hand[slot] != 0 && then == steps);
  };
  LitState state{lit[slot] != 0.0f,   size[slot],         since(lit_at[slot]),
                 since(out_at[slot]), just(lit_at[slot]), just(out_at[slot])};
  if (between) {
    const float share = static_cast<float>(passed) / static_cast<float>(step_time);
    state.size = previous_size[slot] + share * (size[slot] - previous_size[slot]);
  }
  return state;
}

void Bank::State::set_lane_inputs(int slot, const float* values) {
  float lanes[kLanes];
  float* out = regressors_of(slot / kLanes) + slot % kLanes;
  const auto lanes_of = [&](int input) { return all<Reals<LiveNumbers>>(values ? values[input] : 0.0f); };
  Regressing<LiveNumbers, decltype(lanes_of)> regressing(lanes_of);
  for (const RegressorChannel& channel : channels.regressors) {
    store(regressing(channel), lanes);
    *out = lanes[0];
    out += kLanes;
  }
  if (!extinction.present) return;
  store(blowing<LiveNumbers>(extinction, lanes_of), lanes);
  wind[slot] = lanes[0];
}

void Bank::State::set_noise(float scale) {
  noise = scale;
  std::visit([&](auto& dynamics) { dynamics.set_noise(scale); }, stepper);
}

void Bank::State::set_ground(float height) {
  ground = height;
  if (auto* stepped = chain_stepper()) stepped->set_ground(height);
}

// Divides work into whole groups of blocks, so that no two threads write to one cache line.
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

// Makes steps of all instances. The displayed outputs depend on `passed` and `between`, which the caller sets before.
void Bank::State::step_all(const Steps& made) {
  const auto turn = [this](int samples) { std::visit([&](auto& dynamics) { dynamics.turn(samples); }, stepper); };
  turn(1);
  clamped.clamped += share([&](int first, int last) { return path->step(this, first, last, &made); });
  if (kAhead) turn(made.count - 1);
  steps += static_cast<std::uint64_t>(made.count);
  clamped.steps += static_cast<std::uint64_t>(made.count) * static_cast<std::uint64_t>(living);
}

void Bank::State::show() {
  share([this](int first, int last) {
    path->show(this, first, last);
    return std::uint64_t{0};
  });
}

namespace {

constexpr std::array<char, 8> kSaveMagic = {'\x89', 'W', 'I', 'S', 'P', 'B', 'N', 'K'};
constexpr std::uint32_t kVersion = 4, kChainVersion = 5;  // versions of the saved form; kChainVersion: banks of chains
constexpr std::size_t kSaveHeaderSize = 32;
constexpr std::size_t kFieldsSize = 11 * 8;
constexpr std::uint64_t kMaxAge = std::uint64_t{1} << 48;

std::uint32_t version_of(const Bank::State& s) { return s.chain_stepper() ? kChainVersion : kVersion; }

std::size_t record_size(const Bank::State& s) {
  const std::size_t values = std::visit([](const auto& dynamics) { return dynamics.lane_values(); }, s.stepper);
  const std::size_t life = s.extinction.present ? 8 * 4 + 2 * 8 + 4 * s.moved() : 0;
  return 3 * 8 + 4 * (s.channels.regressors.size() + values) + life;
}

bool within(float value, float low, float high) { return value >= low && value <= high; }

// Returns whether `value` is `low` plus whole steps, or `step` is 0. A bank's counters and indices are exact as floats.
bool on_grid(float value, float low, float step) { return !(step > 0) || std::fmod(value - low, step) == 0; }

// Writes or reads a slot's record. On reading, a first pass checks that save() could have written it, a second one
// stores it in the bank.
struct SlotRecord {
  ByteWriter* out = nullptr;  // null: the record is read
  ByteReader* in = nullptr;
  std::uint64_t now = 0;  // current step of the bank
  bool restores = false;
  bool sound = true;

  void whole(std::uint32_t& value, std::uint32_t most) {
    if (out) return out->put(value);
    const std::uint32_t read = in->get32();
    sound &= read <= most;
    if (restores) value = read;
  }
  void whole(std::uint64_t& value) {
    if (out) return out->put(value);
    const std::uint64_t read = in->get64();
    if (restores) value = read;
  }
  void number(float& value, float low, float high, float step) {
    if (out) return out->put(value);
    const float read = in->get_float();
    sound &= within(read, low, high) && on_grid(read, low, step);
    if (restores) value = read;
  }
  void moment(std::uint64_t& then, bool may_be_never) {
    if (out) return out->put(then == kNeverInSteps ? then : now - then);
    const std::uint64_t age = in->get64();
    sound &= age < kMaxAge || (may_be_never && age == kNeverInSteps);
    if (restores) then = age == kNeverInSteps ? age : now - age;
  }
};

// Visits the saved state of a slot, in the order of its record.
void visit_slot(Bank::State& s, int slot, SlotRecord& record) {
  const int block = slot / s.kLanes, lane = slot % s.kLanes;
  std::uint32_t alive = s.alive[slot];
  record.whole(s.generation[slot], ~std::uint32_t{0});
  record.whole(alive, 1);
  s.alive[slot] = static_cast<std::uint8_t>(alive);
  record.whole(s.stream[slot]);
  record.moment(s.born[slot], false);
  const auto number = [&](float& value, float low, float high, float step = 0) {
    record.number(value, low, high, step);
  };
  float* regressor = s.regressors_of(block) + lane;
  for (const RegressorChannel& channel : s.channels.regressors) {
    number(*regressor, channel.least, channel.most);
    regressor += s.kLanes;
  }
  std::visit([&](auto& dynamics) { dynamics.visit_lane(block, lane, number); }, s.stepper);
  if (!s.extinction.present) return;
  number(s.wind[slot], 0, s.extinction.most);
  number(s.harm[slot], 0, 1);
  number(s.lit[slot], 0, 1, 1);
  number(s.size[slot], 0, 1);
  number(s.previous_size[slot], 0, 1);
  number(s.event[slot], kNoEvent, static_cast<float>(s.extinction.sizes.size()) - 1, 1);
  for (auto* left : {&s.left, &s.previous_left}) number((*left)[slot], 0, 1);
  for (auto* moments : {&s.lit_at, &s.out_at}) record.moment((*moments)[slot], true);
  for (std::size_t i = 0; i < s.moved(); ++i) {
    const OutputChannel& channel = s.channels.outputs[i];
    const float width = channel.highest - channel.lowest;
    number(s.offset_of(slot, i), std::min(channel.lowest, -width), std::max(channel.highest, width));
  }
}

struct Fields {
  std::uint64_t model, capacity, seed, spawned, passed, between, noise, clamped, steps, reserved, ground;
};

std::uint64_t bits_of(float number) { return std::bit_cast<std::uint32_t>(number); }
float float_of(std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits)); }

Fields read_fields(ByteReader& in) {
  return {in.get64(), in.get64(), in.get64(), in.get64(), in.get64(), in.get64(),
          in.get64(), in.get64(), in.get64(), in.get64(), in.get64()};
}

bool fields_are_sound(const Bank::State& s, const Fields& fields) {
  const float noise = float_of(fields.noise), ground = float_of(fields.ground);
  return fields.noise >> 32 == 0 && (noise == 0 || within(noise, kMinNoise, kMaxNoise)) && fields.ground >> 32 == 0 &&
         (ground == kNoGround || within(ground, -kFarthest, kFarthest)) && fields.between <= 1 &&
         fields.passed < static_cast<std::uint64_t>(s.step_time) && fields.reserved == 0;
}

Error damaged(const std::string& what) { return {"a saved bank is damaged: " + what + "; save it again"}; }

Result<void> check_header(const Bank::State& s, std::span<const std::byte> bytes) {
  if (bytes.size() < kSaveHeaderSize || std::memcmp(bytes.data(), kSaveMagic.data(), kSaveMagic.size()) != 0) {
    return Error{"these " + std::to_string(bytes.size()) + " bytes are not a saved bank: they have not its signature"};
  }
  ByteReader in(bytes.data() + kSaveMagic.size());
  const std::uint32_t version = in.get32();
  if (version != version_of(s)) {
    return Error{"a saved bank has version " + std::to_string(version) + ", this build reads " +
                 std::to_string(version_of(s)) + ": save and restore it with the same version of Wisp"};
  }
  const std::uint32_t reserved = in.get32();
  const std::uint64_t size = in.get64(), hash = in.get64();
  const auto payload = bytes.subspan(kSaveHeaderSize);
  if (reserved != 0) return damaged("reserved bytes of its header are not zero");
  if (size != payload.size()) {
    return damaged("it holds " + std::to_string(payload.size()) + " bytes after its header, which promises " +
                   std::to_string(size));
  }
  if (hash != hash_bytes(payload)) return damaged("its contents have not the hash that its header says");
  if (payload.size() < kFieldsSize) return damaged("it is too short to hold a bank");
  ByteReader fields(payload.data());
  if (fields.get64() != s.model_hash) {
    return Error{"a saved bank is of another model: make the bank that is restored from the model that was saved"};
  }
  if (const std::uint64_t capacity = fields.get64(); capacity != static_cast<std::uint64_t>(s.capacity)) {
    return Error{"a saved bank has capacity " + std::to_string(capacity) + ", the bank to restore has " +
                 std::to_string(s.capacity) + ": make it with the same"};
  }
  const std::size_t expected = kSaveHeaderSize + kFieldsSize + static_cast<std::size_t>(s.capacity) * record_size(s);
  if (bytes.size() != expected) {
    return damaged("it has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(expected));
  }
  return {};
}

}  // namespace

std::size_t Bank::save_bytes() const {
  return kSaveHeaderSize + kFieldsSize + static_cast<std::size_t>(state_->capacity) * record_size(*state_);
}

void Bank::save(std::span<std::byte> bytes) const {
  State& s = *state_;
  if (!check_size("Bank::save()", bytes.size(), save_bytes())) return;
  const auto payload = bytes.subspan(kSaveHeaderSize);
  ByteWriter out(payload.data());
  for (std::uint64_t field : {s.model_hash, static_cast<std::uint64_t>(s.capacity), s.seed, s.spawned,
                              static_cast<std::uint64_t>(s.passed), std::uint64_t{s.between}, bits_of(s.noise),
                              s.clamped.clamped, s.clamped.steps, std::uint64_t{0}, bits_of(s.ground)}) {
    out.put(field);
  }
  SlotRecord record{.out = &out, .now = s.steps};
  for (int slot = 0; slot < s.capacity; ++slot) visit_slot(s, slot, record);
  std::memcpy(bytes.data(), kSaveMagic.data(), kSaveMagic.size());
  ByteWriter header(bytes.data() + kSaveMagic.size());
  header.put(version_of(s));
  header.put(std::uint32_t{0});
  header.put(std::uint64_t{payload.size()});
  header.put(hash_bytes(payload));
}

Result<void> Bank::restore(std::span<const std::byte> bytes) {
  State& s = *state_;
  if (auto ok = check_header(s, bytes); !ok) return ok;
  const std::byte *first = bytes.data() + kSaveHeaderSize, *records = first + kFieldsSize;
  ByteReader fields_in(first), sound_in(records), in(records);
  const Fields fields = read_fields(fields_in);
  if (!fields_are_sound(s, fields)) return damaged("its time or noise is out of range");
  for (int slot = 0; slot < s.capacity; ++slot) {
    SlotRecord record{.in = &sound_in};
    visit_slot(s, slot, record);
    if (!record.sound) return damaged("slot " + std::to_string(slot) + " holds what no bank can");
  }
  s.seed = fields.seed;
  s.keys = random_keys(fields.seed);
  s.spawned = fields.spawned;
  s.passed = static_cast<std::int64_t>(fields.passed);
  s.between = fields.between != 0;
  s.set_noise(float_of(fields.noise));
  s.set_ground(float_of(fields.ground));
  s.clamped = {fields.clamped, fields.steps};
  s.begin_call();
  s.living = s.rows = s.lowest_free = 0;
  SlotRecord record{.in = &in, .now = s.steps, .restores = true};
  for (int slot = 0; slot < s.capacity; ++slot) {
    visit_slot(s, slot, record);
    if (!s.alive[slot]) continue;
    ++s.living;
    s.rows = slot + 1;
  }
  s.show();
  return {};
}

}  // namespace wisp
