#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

#include "model/chain_rows.hpp"
#include "model/payload.hpp"

namespace wisp {
namespace {

constexpr int kEscape = 24;         // Rice quotient from which on a folded difference is written in full, after 24 ones
constexpr int kWholeBits = 20;      // bits of a folded difference written in full
constexpr std::size_t kOrders = 4;  // orders of prediction, 0 to 3

// Returns the number of kinds of numbers. A kind is a channel of the rows with an order of prediction, or an axis of
// the rates. Numbers of one kind share the parameter of their Rice code.
std::size_t kinds_of(const ChainModel& chain) {
  return static_cast<std::size_t>(channel_count(chain.motion)) * kOrders +
         static_cast<std::size_t>(rate_count(chain.motion));
}

std::uint32_t folded(std::int32_t x) {
  return x < 0 ? static_cast<std::uint32_t>(-2 * x - 1) : static_cast<std::uint32_t>(2 * x);
}
std::int32_t unfolded(std::uint32_t x) {
  return x % 2 ? -static_cast<std::int32_t>(x / 2) - 1 : static_cast<std::int32_t>(x / 2);
}

class BitWriter {
 public:
  void put(std::uint32_t bits, int count) {
    for (int k = count - 1; k >= 0; --k) {
      if (used_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | ((bits >> k & 1U) << (7 - used_ % 8)));
      ++used_;
    }
  }
  void code(std::uint32_t number, int low) {
    const std::uint32_t high = number >> low;
    if (high >= kEscape) {
      put((1U << kEscape) - 1, kEscape);
      return put(number, kWholeBits);
    }
    put((1U << high) - 1, static_cast<int>(high));
    put(0, 1);
    put(number & ((1U << low) - 1), low);
  }
  std::vector<std::uint8_t> bytes() && { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t used_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint32_t take(int count) {
    std::uint32_t bits = 0;
    for (int k = 0; k < count; ++k) bits = bits << 1 | bit();
    return bits;
  }
  std::uint32_t decode(int low) {
    std::uint32_t high = 0;
    while (high < kEscape && bit()) ++high;
    if (high == kEscape) return take(kWholeBits);
    return high << low | take(low);
  }
  /// Returns whether no bit was read beyond the end, and fewer than eight bits are left.
  bool is_done() const { return sound_ && bytes_.size() == (used_ + 7) / 8; }

 private:
  std::uint32_t bit() {
    if (used_ / 8 >= bytes_.size()) {
      sound_ = false;
      return 0;
    }
    const std::uint32_t one = bytes_[used_ / 8] >> (7 - used_ % 8) & 1U;
    ++used_;
    return one;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t used_ = 0;
  bool sound_ = true;
};

// Predicts a number from the numbers of its channel in the `order` rows before; rows are `stride` numbers apart.
std::int32_t predicted_row(const std::int16_t* at, std::size_t order, std::size_t stride) {
  const auto before = [&](std::size_t k) { return std::int32_t{*(at - k * stride)}; };
  switch (order) {
    case 0:
      return 0;
    case 1:
      return before(1);
    case 2:
      return 2 * before(1) - before(2);
    default:
      return 3 * before(1) - 3 * before(2) + before(3);
  }
}

// Factors from told_rate() to the predicted rate, in units of 2^−kShifts: for velocities and angular velocities.
using RateFactors = std::array<std::int32_t, 2>;

struct SegmentOf {
  const std::int16_t* rows;
  std::size_t steps;
  std::size_t channels;

  // Returns twice the change of a channel per step at the segment's start or end.
  std::int64_t change(bool end, std::size_t channel) const {
    if (steps < 2) return 2 * (std::int64_t{rows[steps * channels + channel]} - rows[channel]);
    const auto row = [&](std::size_t k) -> std::int64_t { return rows[(end ? steps - k : k) * channels + channel]; };
    return (end ? -1 : 1) * (4 * row(1) - 3 * row(0) - row(2));
  }
};

// Predicts a rate from rows, up to a constant factor; an angular velocity is predicted by the vector part of q̇ q*.
std::int64_t told_rate(const SegmentOf& segment, bool end, std::size_t axis) {
  if (axis < 3) return segment.change(end, axis);
  const std::int16_t* q = segment.rows + (end ? segment.steps * segment.channels : 0) + 3;
  const std::size_t i = axis - 2, j = i % 3 + 1, k = j % 3 + 1;
  const auto d = [&](std::size_t channel) { return segment.change(end, 3 + channel); };
  return d(i) * q[0] - d(0) * q[i] - d(j) * q[k] + d(k) * q[j];
}

constexpr std::array<int, 2> kShifts = {10, 26};  // log2 of the integer that stands for a factor of 1
constexpr std::int32_t kMaxFactor = 10'000'000;   // times a told_rate() clamped to ±2^38 it fits in 64 bits

std::int32_t predicted_rate(const SegmentOf& segment, bool end, std::size_t axis, const RateFactors& factors) {
  const std::int64_t limit = std::int64_t{1} << 38;
  const std::int64_t product = std::clamp(told_rate(segment, end, axis), -limit, limit) * factors[axis / 3];
  const int shift = kShifts[axis / 3];
  const std::int64_t rounded = (product + (std::int64_t{1} << (shift - 1))) >> shift;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(rounded, -32768, 32767));
}

// Calls use(number, prediction, kind) for each number of rows and rates, before the numbers that are predicted from it.
template <class Use>
void visit_numbers(const ChainModel& chain, const RateFactors& factors, std::int16_t* rows, std::int16_t* rates,
                   Use use) {
  const auto channels = static_cast<std::size_t>(channel_count(chain.motion));
  const auto axes = static_cast<std::size_t>(rate_count(chain.motion));
  for (std::uint16_t steps : chain.segments.steps) {
    for (std::size_t row = 0; row <= steps; ++row) {
      const std::size_t order = std::min(row, kOrders - 1);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        std::int16_t* at = rows + row * channels + channel;
        use(*at, predicted_row(at, order, channels), channel * kOrders + order);
      }
    }
    for (bool end : {false, true}) {
      for (std::size_t axis = 0; axis < axes; ++axis) {
        const std::int32_t prediction = predicted_rate({rows, steps, channels}, end, axis, factors);
        use(*rates++, prediction, channels * kOrders + axis);
      }
    }
    rows += (steps + std::size_t{1}) * channels;
  }
}

// Returns the least-squares factors from told_rate() to the rates of a chain.
RateFactors factors_of(const ChainModel& chain) {
  std::array<double, 2> product{}, square{};
  const auto channels = static_cast<std::size_t>(channel_count(chain.motion));
  const std::int16_t *rows = chain.segments.rows.data(), *rate = chain.segments.rates.data();
  for (std::size_t steps : chain.segments.steps) {
    for (bool end : {false, true}) {
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(rate_count(chain.motion)); ++axis, ++rate) {
        const auto told = static_cast<double>(told_rate({rows, steps, channels}, end, axis));
        product[axis / 3] += told * *rate;
        square[axis / 3] += told * told;
      }
    }
    rows += (steps + 1) * channels;
  }
  RateFactors factors{};
  for (std::size_t part = 0; part < 2; ++part) {
    const double factor = square[part] > 0 ? product[part] / square[part] : 0;
    const double unit = static_cast<double>(std::int64_t{1} << kShifts[part]);
    factors[part] = static_cast<std::int32_t>(std::clamp<double>(unit * factor, -kMaxFactor, kMaxFactor));
  }
  return factors;
}

// Returns the index of each mode's first segment, and one past the last segment.
std::vector<std::size_t> first_of_modes(const ChainModel& chain) {
  std::vector<std::size_t> first(static_cast<std::size_t>(chain.modes) + 1);
  for (std::uint16_t mode : chain.segments.mode) {
    if (mode < chain.modes) ++first[mode + std::size_t{1}];
  }
  for (std::size_t mode = 1; mode < first.size(); ++mode) first[mode] += first[mode - 1];
  return first;
}

int bits_for(std::size_t count) { return std::max(1, static_cast<int>(std::bit_width(count > 0 ? count - 1 : 0))); }

}  // namespace

std::vector<std::uint8_t> packed_segments(const ChainModel& chain) {
  auto rows = chain.segments.rows;
  auto rates = chain.segments.rates;
  const RateFactors factors = factors_of(chain);
  constexpr int kLengths = 16;
  std::vector<std::array<std::uint64_t, kLengths>> bits(kinds_of(chain));
  visit_numbers(
      chain, factors, rows.data(), rates.data(), [&](std::int16_t number, std::int32_t told, std::size_t kind) {
        const std::uint32_t rest = folded(number - told);
        for (int low = 0; low < kLengths; ++low) {
          const std::uint32_t high = rest >> low;
          bits[kind][static_cast<std::size_t>(low)] += high < kEscape ? high + 1 + static_cast<std::uint32_t>(low) : 44;
        }
      });
  BitWriter out;
  for (std::int32_t factor : factors) out.put(static_cast<std::uint32_t>(factor), 32);
  std::vector<int> low;
  for (const auto& of_kind : bits) {
    low.push_back(static_cast<int>(std::min_element(of_kind.begin(), of_kind.end()) - of_kind.begin()));
    out.put(static_cast<std::uint32_t>(low.back()), 4);
  }
  visit_numbers(
      chain, factors, rows.data(), rates.data(),
      [&](std::int16_t number, std::int32_t told, std::size_t kind) { out.code(folded(number - told), low[kind]); });
  return std::move(out).bytes();
}

Result<void> unpack_segments(std::span<const std::uint8_t> bytes, ChainModel& chain) {
  const Error damaged{"is damaged: the rows and rates of its chain's segments are cut off or too long"};
  const auto channels = static_cast<std::size_t>(channel_count(chain.motion));
  ChainSegments& segments = chain.segments;
  // With at most kMaxSegments segments, the number of rows fits in 32 bits.
  if (segments.steps.size() != segments.size() || segments.size() > kMaxSegments) return damaged;
  const std::size_t rows = segment_rows(segments).back();
  const std::size_t rates = segments.size() * 2 * static_cast<std::size_t>(rate_count(chain.motion));
  // Each number takes at least one bit, so a size that the bytes cannot hold allocates nothing. The quotient comes
  // first: rows · channels may exceed 32 bits.
  if (rows > 8 * bytes.size() / channels || rows * channels + rates > 8 * bytes.size()) return damaged;
  segments.rates.assign(rates, 0);
  segments.rows.assign(rows * channels, 0);
  BitReader in(bytes);
  RateFactors factors{};
  for (std::int32_t& factor : factors) {
    factor = static_cast<std::int32_t>(in.take(32));
    if (factor > kMaxFactor || factor < -kMaxFactor) return damaged;
  }
  std::vector<int> low(kinds_of(chain));
  for (int& one : low) one = static_cast<int>(in.take(4));
  bool fits = true;
  visit_numbers(chain, factors, segments.rows.data(), segments.rates.data(),
                [&](std::int16_t& number, std::int32_t told, std::size_t kind) {
                  const std::int32_t value = told + unfolded(in.decode(low[kind]));
                  fits &= value >= std::numeric_limits<std::int16_t>::min() &&
                          value <= std::numeric_limits<std::int16_t>::max();
                  number = static_cast<std::int16_t>(value);
                });
  if (!fits || !in.is_done()) return damaged;
  return {};
}

namespace {

namespace fb = wisp_flatbuffers;

// Serialises the lists of successors; a successor is written as its index among the segments of its mode.
std::vector<std::uint8_t> packed_successors(const ChainModel& chain) {
  const auto first = first_of_modes(chain);
  const auto breadth = static_cast<std::size_t>(chain.segments.breadth), modes = static_cast<std::size_t>(chain.modes);
  BitWriter out;
  for (std::size_t k = 0; k < chain.segments.follow.size(); ++k) {
    const std::size_t mode = k / breadth % modes;
    out.put(static_cast<std::uint32_t>(chain.segments.follow[k] - first[mode]),
            bits_for(first[mode + 1] - first[mode]));
  }
  return std::move(out).bytes();
}

// Reads the lists of successors into a chain whose modes and segments' modes are set.
// Errors: too few or too many bytes; an index that its mode does not have.
Result<void> unpack_successors(std::span<const std::uint8_t> bytes, ChainModel& chain) {
  const Error damaged{"is damaged: the successors of its chain's segments are cut off or too long"};
  const auto first = first_of_modes(chain);
  ChainSegments& segments = chain.segments;
  const auto breadth = static_cast<std::size_t>(std::max(0, segments.breadth));
  const std::size_t count = segments.size() * static_cast<std::size_t>(chain.modes) * breadth;
  if (count > 8 * bytes.size()) return damaged;
  segments.follow.assign(count, 0);
  BitReader in(bytes);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t mode = k / breadth % static_cast<std::size_t>(chain.modes);
    const std::size_t members = first[mode + 1] - first[mode], which = in.take(bits_for(members));
    if (which >= members) return damaged;
    segments.follow[k] = static_cast<std::uint16_t>(first[mode] + which);
  }
  if (!in.is_done()) return damaged;
  return {};
}

fb::Offset<file::GustResponse> write_gust(fb::FlatBufferBuilder& builder, const GustResponse& gust) {
  const auto stored = [](const GustResponse::Axis& axis) { return file::GustAxis(axis.change, axis.wind, axis.press); };
  const file::GustAxis ground = stored(gust.ground), vertical = stored(gust.vertical);
  return file::CreateGustResponse(builder, &ground, &vertical);
}

GustResponse read_gust(const file::GustResponse& stored) {
  const auto axis = [](const file::GustAxis& of) { return GustResponse::Axis{of.change(), of.wind(), of.press()}; };
  return {axis(*stored.ground()), axis(*stored.vertical())};
}

fb::Offset<file::ChainDrift> write_drift(fb::FlatBufferBuilder& builder, const ChainDrift& drift) {
  const std::vector<double> velocity(drift.drift.begin(), drift.drift.end());
  return file::CreateChainDriftDirect(builder, &drift.lead, drift.lead_scale, &velocity, drift.spread_ground,
                                      drift.spread_height, drift.memory_seconds);
}

Result<ChainDrift> read_drift(const file::ChainDrift& stored) {
  const auto velocity = copied(stored.drift());
  if (velocity.size() != 3) return Error{"is damaged: its chain's drift has not three axes"};
  return ChainDrift{copied(stored.lead()),  stored.lead_scale(),    {velocity[0], velocity[1], velocity[2]},
                    stored.spread_ground(), stored.spread_height(), stored.memory_seconds()};
}

}  // namespace

fb::Offset<file::Chain> write_chain(fb::FlatBufferBuilder& builder, const ChainModel& chain) {
  const ChainSegments& segments = chain.segments;
  const auto mode = builder.CreateVector(segments.mode);
  const auto steps = builder.CreateVector(segments.steps);
  const auto packed = builder.CreateVector(packed_segments(chain));
  const auto row_scale = builder.CreateVector(segments.row_scale);
  const auto rate_scale = builder.CreateVector(segments.rate_scale);
  const auto follow = builder.CreateVector(packed_successors(chain));
  const bool bounded = !segments.height.empty();
  const auto height = bounded ? builder.CreateVector(segments.height) : 0;
  const auto initial = builder.CreateVector(chain.initial);
  const auto probabilities = builder.CreateVector(chain.probabilities);
  const auto gust = chain.gust ? write_gust(builder, *chain.gust) : fb::Offset<file::GustResponse>();
  const auto drift = chain.drift ? write_drift(builder, *chain.drift) : fb::Offset<file::ChainDrift>();
  file::ChainBuilder table(builder);
  table.add_motion(chain.motion == ChainMotion::kPose ? file::ChainMotion::Pose : file::ChainMotion::Position);
  table.add_heading_free(chain.heading_free);
  table.add_modes(static_cast<std::uint16_t>(chain.modes));
  table.add_segment_mode(mode);
  table.add_segment_steps(steps);
  table.add_packed(packed);
  table.add_row_scale(row_scale);
  table.add_rate_scale(rate_scale);
  table.add_follow(follow);
  table.add_breadth(static_cast<std::uint16_t>(segments.breadth));
  table.add_initial(initial);
  table.add_history(static_cast<std::uint8_t>(chain.history));
  table.add_probabilities(probabilities);
  table.add_blend_steps(static_cast<std::uint16_t>(chain.blend_steps));
  if (chain.gust) table.add_gust(gust);
  if (chain.drift) table.add_drift(drift);
  if (bounded) {
    table.add_height(height);
    table.add_height_scale(segments.height_scale);
  }
  return table.Finish();
}

Result<ChainModel> read_chain(const file::Chain& stored) {
  ChainModel chain;
  if (stored.motion() != file::ChainMotion::Position && stored.motion() != file::ChainMotion::Pose) {
    return Error{"has a chain of a kind of motion that this program does not know; update Wisp"};
  }
  chain.motion = stored.motion() == file::ChainMotion::Pose ? ChainMotion::kPose : ChainMotion::kPosition;
  chain.heading_free = stored.heading_free();
  chain.modes = stored.modes();
  chain.segments = {copied(stored.segment_mode()),
                    copied(stored.segment_steps()),
                    {},
                    copied(stored.row_scale()),
                    {},
                    copied(stored.rate_scale()),
                    {},
                    stored.breadth(),
                    copied(stored.height()),
                    stored.height_scale()};
  chain.initial = copied(stored.initial());
  chain.history = stored.history();
  chain.probabilities = copied(stored.probabilities());
  chain.blend_steps = stored.blend_steps();
  if (stored.gust()) chain.gust = read_gust(*stored.gust());
  if (auto ok = unpack_successors(copied(stored.follow()), chain); !ok) return ok.error();
  if (auto ok = unpack_segments({stored.packed()->data(), stored.packed()->size()}, chain); !ok) return ok.error();
  if (stored.drift()) {
    auto drift = read_drift(*stored.drift());
    if (!drift) return drift.error();
    chain.drift = std::move(*drift);
  }
  return chain;
}

}  // namespace wisp
