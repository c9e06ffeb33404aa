#include "learn/arx/part_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/hash.hpp"
#include "learn/fit/arx_fit.hpp"

namespace wisp::arx {
namespace {

constexpr std::uint64_t kMagic = 0x3152544350534957;  // "WISPCTR1"
constexpr std::uint64_t kVersion = 4;
constexpr std::size_t kHeader = 4 * 8;

// Reads or writes a state by the same walk over its fields: 8 bytes per number or letter, little-endian. Reads past the
// end return zeros and set an error flag.
class Archive {
 public:
  Archive() = default;
  explicit Archive(std::span<const std::byte> bytes) : left_(bytes), reading_(true) {}

  bool fine() const { return fine_; }
  bool at_end() const { return fine_ && left_.empty(); }
  std::vector<std::byte> take() { return std::move(bytes_); }

  /// Whether `count` more numbers can be read; if not, sets the error flag. Called before memory is allocated.
  bool has_room(std::size_t count) { return fine_ = fine_ && (!reading_ || count <= left_.size() / 8); }

  void number(std::uint64_t& value) {
    if (!has_room(1)) return void(value = 0);
    const std::uint64_t known = std::exchange(value, reading_ ? 0 : value);
    for (int shift = 0; shift < 64; shift += 8) {
      if (!reading_) bytes_.push_back(static_cast<std::byte>(known >> shift & 0xff));
      if (reading_) value |= std::to_integer<std::uint64_t>(left_[static_cast<std::size_t>(shift / 8)]) << shift;
    }
    if (reading_) left_ = left_.subspan(8);
  }
  void real(double& value) {
    auto bits = std::bit_cast<std::uint64_t>(value);
    number(bits);
    value = std::bit_cast<double>(bits);
  }
  /// Reads or writes the list's size; on reading, resizes the list.
  template <class List>
  void size(List& list) {
    std::uint64_t count = list.size();
    number(count);
    if (reading_) list.resize(has_room(count) ? count : 0);
  }
  void text(std::string& value) {
    size(value);
    for (char& c : value) {
      std::uint64_t letter = static_cast<unsigned char>(c);
      number(letter);
      c = static_cast<char>(letter);
    }
  }
  void matrix(OrderMatrix& matrix, std::size_t rows, std::size_t columns) {
    if (!has_room(rows * columns)) return;
    if (reading_) matrix = OrderMatrix(static_cast<int>(rows), static_cast<int>(columns));
    for (int k = 0; k < matrix.rows() * matrix.columns(); ++k) {
      int& order = matrix(k / matrix.columns(), k % matrix.columns());
      auto whole = static_cast<std::uint64_t>(order);
      number(whole);
      order = static_cast<int>(std::min<std::uint64_t>(whole, 1 << 30));
    }
  }

 private:
  std::vector<std::byte> bytes_;
  std::span<const std::byte> left_;
  bool reading_ = false, fine_ = true;
};

void walk(Archive& archive, ChannelChoice& names, ArxOrders& orders) {
  for (auto* list : {&names.outputs, &names.inputs}) {
    archive.size(*list);
    for (std::string& name : *list) archive.text(name);
  }
  const std::size_t ny = names.outputs.size(), nu = names.inputs.size();
  archive.matrix(orders.na, ny, ny);
  archive.matrix(orders.nb, ny, nu);
  archive.matrix(orders.nk, ny, nu);
}

// Walks over all fields except names and orders.
void walk(Archive& archive, PartState& state) {
  archive.real(state.rate_hz);
  for (auto* count : {&state.rows, &state.episodes_used, &state.episodes_skipped, &state.rows_left_out, &state.jobs}) {
    archive.number(*count);
  }
  for (PartChannel& channel : state.channels) {
    for (double* value :
         {&channel.reference, &channel.sum, &channel.square, &channel.span.lowest, &channel.span.highest}) {
      archive.real(*value);
    }
    archive.number(channel.samples);
    archive.text(channel.span.unit);
  }
  for (Eigen::Index q = 0; q < state.triangle.cols(); ++q) {
    for (Eigen::Index p = 0; p <= q; ++p) archive.real(state.triangle(p, q));
  }
  archive.size(state.seen);
  for (SeenRows& seen : state.seen) {
    archive.text(seen.source);
    for (auto* number : {&seen.hash, &seen.first, &seen.last, &seen.begin, &seen.end}) archive.number(*number);
  }
}

bool is_meaningful(const PartChannel& channel) {
  const auto& [reference, sum, square, samples, span] = channel;
  if (std::isinf(reference) || (std::isnan(reference) && samples > 0)) return false;
  return std::isfinite(sum) && square >= 0 && std::isfinite(square) && std::isfinite(span.lowest) &&
         std::isfinite(span.highest) && span.lowest <= span.highest;
}

bool is_meaningful(const PartState& state) {
  const auto in_order = [](const SeenRows& seen) {
    return seen.first <= seen.begin && seen.begin <= seen.end && seen.end <= seen.last;
  };
  return state.jobs > 0 && state.triangle.allFinite() && std::isfinite(state.rate_hz) && state.rate_hz >= 0 &&
         std::all_of(state.seen.begin(), state.seen.end(), in_order) &&
         std::all_of(state.channels.begin(), state.channels.end(),
                     [](const PartChannel& channel) { return is_meaningful(channel); });
}

Result<void> check_same_model(const PartState& state, const PartState& other) {
  const auto differ = [](const std::string& what) {
    return Error{"the parts are of different models: their " + what + " differ"};
  };
  if (state.names.outputs != other.names.outputs) return differ("outputs");
  if (state.names.inputs != other.names.inputs) return differ("inputs");
  if (!(state.orders == other.orders)) return differ("orders");
  const bool both = state.rate_hz != 0 && other.rate_hz != 0;
  if (both && std::abs(state.rate_hz - other.rate_hz) > 1e-3 * state.rate_hz) return differ("rates");
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const std::string &unit = state.channels[c].span.unit, &its = other.channels[c].span.unit;
    if (!unit.empty() && !its.empty() && unit != its) return differ("units (" + unit + ", " + its + ")");
  }
  return {};
}

Result<void> check_apart(const std::vector<SeenRows>& seen, const std::vector<SeenRows>& more) {
  for (const SeenRows& one : more) {
    for (const SeenRows& other : seen) {
      const std::uint64_t begin = std::max(one.begin, other.begin), end = std::min(one.end, other.end);
      if (one.hash != other.hash || begin >= end) continue;
      return Error{"rows " + rows_text(begin, end) + " of " + one.source +
                   " are in both: a recording or a part is named twice, or parts are of different shares"};
    }
  }
  return {};
}

}  // namespace

void PartChannel::add(double sample) {
  if (std::isnan(sample)) return;
  span.lowest = samples == 0 ? sample : std::min(span.lowest, sample);
  span.highest = samples == 0 ? sample : std::max(span.highest, sample);
  sum += sample - reference;
  square += (sample - reference) * (sample - reference);
  ++samples;
}

PartState::PartState(ChannelChoice channel_names, ArxOrders model_orders)
    : names(std::move(channel_names)), orders(std::move(model_orders)) {
  const LagLayout layout = layout_of(orders);
  channels.resize(static_cast<std::size_t>(layout.channels()));
  triangle = Eigen::MatrixXd::Zero(layout.size(), layout.size());
}

Result<void> PartState::merge(const PartState& more) {
  if (auto ok = check_same_model(*this, more); !ok) return ok;
  if (auto ok = check_apart(seen, more.seen); !ok) return ok;
  std::vector<double> shift;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    PartChannel& own = channels[c];
    const PartChannel& its = more.channels[c];
    if (std::isnan(own.reference)) own.reference = its.reference;
    const double apart = std::isnan(its.reference) ? 0.0 : its.reference - own.reference;
    const auto count = static_cast<double>(its.samples);
    shift.push_back(apart);
    if (its.samples > 0) {
      own.span.lowest = own.samples == 0 ? its.span.lowest : std::min(own.span.lowest, its.span.lowest);
      own.span.highest = own.samples == 0 ? its.span.highest : std::max(own.span.highest, its.span.highest);
    }
    if (own.span.unit.empty()) own.span.unit = its.span.unit;
    own.square += its.square + 2 * apart * its.sum + apart * apart * count;
    own.sum += its.sum + apart * count;
    own.samples += its.samples;
  }
  Eigen::MatrixXd other = more.triangle;
  shift_columns(orders, shift, std::vector<double>(shift.size(), 1.0), other);
  reduce_rows(triangle, other);
  if (rate_hz == 0) rate_hz = more.rate_hz;
  rows += more.rows;
  episodes_used += more.episodes_used;
  episodes_skipped += more.episodes_skipped;
  rows_left_out += more.rows_left_out;
  seen.insert(seen.end(), more.seen.begin(), more.seen.end());
  return {};
}

std::vector<std::byte> PartState::bytes() const {
  PartState own = *this;
  Archive payload, whole;
  walk(payload, own.names, own.orders);
  walk(payload, own);
  const std::vector<std::byte> body = payload.take();
  for (std::uint64_t number : {kMagic, kVersion, std::uint64_t{body.size()}, hash_bytes(body)}) whole.number(number);
  std::vector<std::byte> all = whole.take();
  all.insert(all.end(), body.begin(), body.end());
  return all;
}

Result<PartState> PartState::from_bytes(std::span<const std::byte> bytes) {
  Archive header(bytes.first(std::min(bytes.size(), kHeader)));
  std::uint64_t magic = 0, version = 0, size = 0, expected = 0;
  for (auto* number : {&magic, &version, &size, &expected}) header.number(*number);
  if (magic != kMagic) return Error{"this is not a part of a fit (its first bytes differ)"};
  if (version != kVersion) {
    return Error{"this part of a fit has format version " + std::to_string(version) + ", expected " +
                 std::to_string(kVersion) + "; make it again with this program"};
  }
  if (!header.fine() || size != bytes.size() - kHeader) return Error{"this part of a fit is cut short; make it again"};
  const auto body = bytes.subspan(kHeader);
  if (hash_bytes(body) != expected) return Error{"this part of a fit was changed (its hash differs); make it again"};
  const Error damaged{"this part of a fit holds numbers that mean nothing; make it again"};
  Archive archive(body);
  ChannelChoice names;
  ArxOrders orders;
  walk(archive, names, orders);
  if (!archive.fine() || names.outputs.empty() || !check_orders(orders, names)) return damaged;
  const auto columns = static_cast<std::size_t>(layout_of(orders).size());
  if (!archive.has_room(columns * (columns + 1) / 2)) return damaged;
  PartState state(std::move(names), std::move(orders));
  walk(archive, state);
  if (!archive.at_end() || !is_meaningful(state)) return damaged;
  return state;
}

void shift_columns(const ArxOrders& orders, const std::vector<double>& shift, const std::vector<double>& scale,
                   Eigen::MatrixXd& triangle) {
  const LagLayout layout = layout_of(orders);
  for (int p = 1; p < layout.size(); ++p) {
    const auto channel = static_cast<std::size_t>(layout[p].channel);
    triangle.col(p) = (triangle.col(p) + shift[channel] * triangle.col(0)) * scale[channel];
  }
}

std::string rows_text(std::uint64_t begin, std::uint64_t end) {
  return std::to_string(begin + 1) + ":" + std::to_string(end);
}

Result<std::vector<SeenRows>> covered(std::vector<SeenRows> seen) {
  const auto recording = [](const SeenRows& rows) { return std::tuple(rows.hash, rows.first, rows.last); };
  std::sort(seen.begin(), seen.end(), [&](const SeenRows& a, const SeenRows& b) {
    return std::pair(recording(a), a.begin) < std::pair(recording(b), b.begin);
  });
  std::vector<SeenRows> out;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const bool next = out.empty() || recording(out.back()) != recording(seen[k]);
    if (next) out.push_back(seen[k]), out.back().begin = out.back().end = seen[k].first;
    const bool ends = k + 1 == seen.size() || recording(seen[k + 1]) != recording(seen[k]);
    const std::uint64_t reached = std::exchange(out.back().end, seen[k].end);
    for (const auto& [from, to] : {std::pair(reached, seen[k].begin), {seen[k].end, ends ? seen[k].last : 0}}) {
      if (from >= to) continue;
      return Error{"rows " + rows_text(from, to) + " of " + seen[k].source +
                   " are in no part: merge the part that is missing"};
    }
  }
  return out;
}

}  // namespace wisp::arx
