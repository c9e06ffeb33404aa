// A bank's state as bytes. Little-endian: 8 bytes magic, 4 version, 4 zero, 8 size of what follows the header, 8 its
// hash; then the bank's own fields, then one record of the same size for every slot.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "base/hash.hpp"
#include "run/bank/bank_state.hpp"
#include "run/state/little_endian.hpp"

namespace wisp {
namespace {

constexpr std::array<char, 8> kSaveMagic = {'\x89', 'W', 'I', 'S', 'P', 'B', 'N', 'K'};
constexpr std::uint32_t kVersion = 3, kChainVersion = 5;  // of chains' banks
constexpr std::size_t kSaveHeaderSize = 32;
constexpr std::size_t kFieldsSize = 11 * 8;
constexpr std::uint64_t kMaxAge = std::uint64_t{1} << 48;

bool is_chain(const Bank::State& s) { return std::holds_alternative<ChainStepper<LiveNumbers>>(s.stepper); }
std::uint32_t version_of(const Bank::State& s) { return is_chain(s) ? kChainVersion : kVersion; }

std::size_t record_size(const Bank::State& s) {
  const std::size_t values = std::visit([](const auto& dynamics) { return dynamics.lane_values(); }, s.stepper);
  const std::size_t life = s.extinction.present ? 7 * 4 + 2 * 8 + 4 * s.visible : 0;
  return 3 * 8 + 4 * (s.channels.regressors.size() + values) + life;
}

std::uint64_t age_of(std::uint64_t then, std::uint64_t now) {
  return then == kNeverInSteps ? kNeverInSteps : now - then;
}
std::uint64_t moment_of(std::uint64_t age, std::uint64_t now) {
  return age == kNeverInSteps ? kNeverInSteps : now - age;
}

// What is saved of an instance of a model that goes out: the wind, its harm, whether it is lit, its sizes, its
// event, for how long, and its last shape.
void save_life(Bank::State& s, int slot, ByteWriter& out) {
  for (const auto* values : {&s.wind, &s.harm, &s.lit, &s.size, &s.previous_size, &s.event, &s.carried})
    out.put((*values)[slot]);
  for (const auto* moments : {&s.lit_at, &s.out_at}) out.put(age_of((*moments)[slot], s.steps));
  const float* shape = s.last_shape_of(slot / s.kLanes) + slot % s.kLanes;
  for (std::size_t i = 0; i < s.visible; ++i) out.put(shape[i * s.kLanes]);
}

void restore_life(Bank::State& s, int slot, ByteReader& in) {
  for (auto* values : {&s.wind, &s.harm, &s.lit, &s.size, &s.previous_size, &s.event, &s.carried})
    (*values)[slot] = in.get_float();
  for (auto* moments : {&s.lit_at, &s.out_at}) (*moments)[slot] = moment_of(in.get64(), s.steps);
  float* shape = s.last_shape_of(slot / s.kLanes) + slot % s.kLanes;
  for (std::size_t i = 0; i < s.visible; ++i) shape[i * s.kLanes] = in.get_float();
}

void save_slot(Bank::State& s, int slot, ByteWriter& out) {
  out.put(s.generation[slot]);
  out.put(static_cast<std::uint32_t>(s.alive[slot]));
  out.put(s.stream[slot]);
  out.put(s.steps - s.born[slot]);
  const int block = slot / s.kLanes, lane = slot % s.kLanes;
  for (std::size_t k = 0; k < s.channels.regressors.size(); ++k) out.put(s.regressors_of(block)[k * s.kLanes + lane]);
  const auto put = [&](float& z, float, float, float = 0) { out.put(z); };
  std::visit([&](auto& dynamics) { dynamics.visit_lane(block, lane, put); }, s.stepper);
  if (s.extinction.present) save_life(s, slot, out);
}

bool within(float value, float low, float high) { return value >= low && value <= high; }

// Whether `value` is a whole number of steps above `low`. Where step is 0, any number is. Counters and indices in a
// bank are small enough to be exact in single precision.
bool on_grid(float value, float low, float step) { return !(step > 0) || std::fmod(value - low, step) == 0; }

bool life_is_sound(const Bank::State& s, ByteReader& in) {
  bool sound = within(in.get_float(), 0, s.extinction.most);
  sound &= within(in.get_float(), 0, 1);
  const float lit = in.get_float();
  sound &= lit == 0 || lit == 1;
  for (int k = 0; k < 2; ++k) sound &= within(in.get_float(), 0, 1);
  const float event = in.get_float();
  sound &= within(event, kNoEvent, static_cast<float>(s.extinction.sizes.size()) - 1) && on_grid(event, kNoEvent, 1);
  sound &= within(in.get_float(), -1, 1);
  for (int k = 0; k < 2; ++k) {
    const std::uint64_t age = in.get64();
    sound &= age == kNeverInSteps || age < kMaxAge;
  }
  // A point of a shape is the sum or the difference of two coordinates.
  float reach = 0;
  for (const float bound : s.shape.lowest) reach = std::max(reach, 2.01f * std::abs(bound));
  for (const float bound : s.shape.highest) reach = std::max(reach, 2.01f * std::abs(bound));
  for (std::size_t i = 0; i < s.visible; ++i) {
    const float value = in.get_float();
    sound &= s.shape.empty() ? within(value, std::min(s.channels.outputs[i].lowest, 0.0f),
                                      std::max(s.channels.outputs[i].highest, 0.0f))
                             : within(value, -reach, reach);
  }
  return sound;
}

// Whether a slot's record could have been written by save().
bool slot_is_sound(Bank::State& s, ByteReader& in) {
  in.get32();
  bool sound = in.get32() <= 1;
  in.get64();
  sound &= in.get64() < kMaxAge;
  for (const RegressorChannel& channel : s.channels.regressors) {
    sound &= within(in.get_float(), channel.least, channel.most);
  }
  const auto check = [&](float&, float low, float high, float step = 0) {
    const float value = in.get_float();
    sound &= within(value, low, high) && on_grid(value, low, step);
  };
  std::visit([&](auto& dynamics) { dynamics.visit_lane(0, 0, check); }, s.stepper);
  if (s.extinction.present) sound &= life_is_sound(s, in);
  return sound;
}

void restore_slot(Bank::State& s, int slot, ByteReader& in) {
  s.generation[slot] = in.get32();
  s.alive[slot] = static_cast<std::uint8_t>(in.get32());
  s.stream[slot] = in.get64();
  s.born[slot] = s.steps - in.get64();
  const int block = slot / s.kLanes, lane = slot % s.kLanes;
  for (std::size_t k = 0; k < s.channels.regressors.size(); ++k) {
    s.regressors_of(block)[k * s.kLanes + lane] = in.get_float();
  }
  const auto take = [&](float& z, float, float, float = 0) { z = in.get_float(); };
  std::visit([&](auto& dynamics) { dynamics.visit_lane(block, lane, take); }, s.stepper);
  if (s.extinction.present) restore_life(s, slot, in);
  if (!s.alive[slot]) return;
  ++s.living;
  s.rows = slot + 1;
}

struct Fields {
  std::uint64_t model, capacity, seed, spawned, passed, between, noise, clamped, steps, reserved;
  std::uint64_t ground;
};

std::uint64_t bits_of(float number) { return std::bit_cast<std::uint32_t>(number); }
float float_of(std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits)); }

Fields read_fields(ByteReader& in) {
  return {in.get64(), in.get64(), in.get64(), in.get64(), in.get64(), in.get64(),
          in.get64(), in.get64(), in.get64(), in.get64(), in.get64()};
}

ChainSettings chain_settings(const Fields& fields) { return {float_of(fields.ground)}; }

bool chain_is_sound(const Fields& fields) {
  const float ground = float_of(fields.ground);
  return fields.ground >> 32 == 0 && (ground == kNoGround || within(ground, -kFarthest, kFarthest));
}

bool fields_are_sound(const Bank::State& s, const Fields& fields) {
  const float noise = float_of(fields.noise);
  return chain_is_sound(fields) && fields.noise >> 32 == 0 && (noise == 0 || within(noise, kMinNoise, kMaxNoise)) &&
         fields.between <= 1 && fields.passed < static_cast<std::uint64_t>(s.step_time) && fields.reserved == 0;
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
                              s.clamped.clamped, s.clamped.steps, std::uint64_t{0}, bits_of(s.chain.ground)}) {
    out.put(field);
  }
  for (int slot = 0; slot < s.capacity; ++slot) save_slot(s, slot, out);
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
    if (!slot_is_sound(s, sound_in)) return damaged("slot " + std::to_string(slot) + " holds what no bank can");
  }
  s.seed = fields.seed;
  s.keys = random_keys(fields.seed);
  s.spawned = fields.spawned;
  s.passed = static_cast<std::int64_t>(fields.passed);
  s.between = fields.between != 0;
  s.set_noise(float_of(fields.noise));
  s.set_chain(chain_settings(fields));
  s.clamped = {fields.clamped, fields.steps};
  s.living = s.rows = s.lowest_free = 0;
  for (int slot = 0; slot < s.capacity; ++slot) restore_slot(s, slot, in);
  s.show();
  return {};
}

}  // namespace wisp
