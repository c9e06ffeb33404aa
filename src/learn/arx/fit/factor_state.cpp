// The bytes of a factor: magic, version, payload size and 64-bit FNV-1a hash of the payload, then the payload's numbers
// in little-endian order.

#include "learn/arx/fit/factor_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "learn/arx/fit/arx_check.hpp"

namespace wisp {
namespace {

constexpr std::uint64_t kMagic = 0x3152544350534957;  // "WISPCTR1"
constexpr std::uint64_t kVersion = 2;
constexpr std::size_t kHeader = 4 * 8;
constexpr std::uint64_t kMaxChannels = 4096;
constexpr std::uint64_t kMaxName = 65536;
constexpr std::uint64_t kMaxSeen = 1 << 20;

std::uint64_t hash(std::span<const std::byte> bytes) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (std::byte byte : bytes) value = (value ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
  return value;
}

class Writer {
 public:
  void number(std::uint64_t value) {
    for (int k = 0; k < 8; ++k) bytes_.push_back(static_cast<std::byte>(value >> (8 * k) & 0xff));
  }
  void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void text(const std::string& value) {
    number(value.size());
    for (char c : value) bytes_.push_back(static_cast<std::byte>(c));
  }
  void matrix(const OrderMatrix& matrix) {
    for (int value : matrix.values()) number(static_cast<std::uint64_t>(value));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

// Reads past the end give zeros and are remembered.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool fine() const { return fine_; }
  std::size_t left() const { return bytes_.size(); }

  std::uint64_t number() {
    std::uint64_t value = 0;
    for (int k = 0; k < 8; ++k) value |= std::to_integer<std::uint64_t>(byte()) << (8 * k);
    return value;
  }
  double real() { return std::bit_cast<double>(number()); }

  /// A number that must not be above `most`.
  std::uint64_t bounded(std::uint64_t most) {
    const std::uint64_t value = number();
    fine_ = fine_ && value <= most;
    return fine_ ? value : 0;
  }
  std::string text() {
    std::string value(bounded(kMaxName), '\0');
    for (char& c : value) c = static_cast<char>(byte());
    return value;
  }
  OrderMatrix matrix(int rows, int columns) {
    if (static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) * 8 > left()) fine_ = false;
    if (!fine_) return {};  // before memory is allocated
    OrderMatrix matrix(rows, columns);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) matrix(r, c) = static_cast<int>(bounded(kMaxChannels));
    }
    return matrix;
  }

 private:
  std::byte byte() {
    if (bytes_.empty()) {
      fine_ = false;
      return std::byte{0};
    }
    const std::byte value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }

  std::span<const std::byte> bytes_;
  bool fine_ = true;
};

FactorOptions read_options(Reader& reader) {
  FactorOptions options;
  const auto outputs = reader.bounded(kMaxChannels);
  const auto inputs = reader.bounded(kMaxChannels);
  for (std::uint64_t i = 0; i < outputs && reader.fine(); ++i) options.channels.outputs.push_back(reader.text());
  for (std::uint64_t k = 0; k < inputs && reader.fine(); ++k) options.channels.inputs.push_back(reader.text());
  if (!reader.fine()) return options;
  const auto ny = static_cast<int>(outputs);
  const auto nu = static_cast<int>(inputs);
  options.orders.na = reader.matrix(ny, ny);
  options.orders.nb = reader.matrix(ny, nu);
  options.orders.nk = reader.matrix(ny, nu);
  if (reader.bounded(1) == 1) options.first_sample = static_cast<int>(reader.bounded(1 << 30));
  return options;
}

void write_notes(const FactorNotes& notes, Writer& payload) {
  payload.number(notes.jobs);
  payload.number(notes.seen.size());
  for (const SeenRows& seen : notes.seen) {
    payload.text(seen.source);
    for (std::uint64_t number : {seen.hash, seen.first, seen.last, seen.begin, seen.end, seen.copy})
      payload.number(number);
  }
}

void read_notes(Reader& reader, FactorNotes& notes) {
  notes.jobs = reader.number();
  const std::uint64_t count = reader.bounded(kMaxSeen);
  for (std::uint64_t k = 0; k < count && reader.fine(); ++k) {
    SeenRows seen{.source = reader.text()};
    for (auto* number : {&seen.hash, &seen.first, &seen.last, &seen.begin, &seen.end, &seen.copy})
      *number = reader.number();
    notes.seen.push_back(std::move(seen));
  }
}

bool meaningful(const FactorNotes& notes) {
  return notes.jobs > 0 && std::all_of(notes.seen.begin(), notes.seen.end(), [](const SeenRows& seen) {
           return seen.first <= seen.begin && seen.begin <= seen.end && seen.end <= seen.last;
         });
}

void read_channels(Reader& reader, FactorState& state) {
  for (std::size_t c = 0; c < state.reference.size(); ++c) {
    state.reference[c] = reader.real();
    state.sum[c] = reader.real();
    state.square[c] = reader.real();
    state.samples[c] = reader.number();
    state.spans[c].unit = reader.text();
    state.spans[c].lowest = reader.real();
    state.spans[c].highest = reader.real();
  }
}

bool meaningful(const FactorState& state) {
  for (std::size_t c = 0; c < state.reference.size(); ++c) {
    if (std::isinf(state.reference[c]) || !std::isfinite(state.sum[c]) || !(state.square[c] >= 0)) return false;
    if (std::isnan(state.reference[c]) && state.samples[c] > 0) return false;
    if (!(std::isfinite(state.spans[c].lowest) && state.spans[c].lowest <= state.spans[c].highest)) return false;
    if (!std::isfinite(state.spans[c].highest)) return false;
  }
  return state.triangle.allFinite() && std::isfinite(state.rate_hz) && state.rate_hz >= 0;
}

}  // namespace

FactorState::FactorState(const FactorOptions& given)
    : options(given),
      design(make_design(given.orders, ArxOffset::kMean)),
      reference(static_cast<std::size_t>(design.layout.channels()), std::numeric_limits<double>::quiet_NaN()),
      sum(reference.size()),
      square(reference.size()),
      samples(reference.size()),
      spans(reference.size()),
      triangle(Eigen::MatrixXd::Zero(design.layout.size(), design.layout.size())) {}

Result<void> check_factor_options(const FactorOptions& options) {
  if (options.channels.outputs.empty()) return Error{"no output channel was named"};
  ArxOptions fit;
  fit.orders = options.orders;
  fit.first_sample = options.first_sample;
  return check_options(fit, options.channels);
}

Result<void> check_same_model(const FactorState& state, const FactorState& other) {
  const auto differ = [](const char* what) {
    return Error{std::string("the parts are of different models: their ") + what + " differ"};
  };
  if (state.options.channels.outputs != other.options.channels.outputs) return differ("outputs");
  if (state.options.channels.inputs != other.options.channels.inputs) return differ("inputs");
  if (!(state.options.orders == other.options.orders)) return differ("orders");
  if (state.first_sample() != other.first_sample()) return differ("first samples");
  const bool both = state.rate_hz != 0 && other.rate_hz != 0;
  if (both && std::abs(state.rate_hz - other.rate_hz) > 1e-6 * state.rate_hz) return differ("rates");
  return {};
}

std::vector<std::byte> factor_bytes(const FactorState& state) {
  Writer payload;
  payload.number(state.options.channels.outputs.size());
  payload.number(state.options.channels.inputs.size());
  for (const std::string& name : state.options.channels.outputs) payload.text(name);
  for (const std::string& name : state.options.channels.inputs) payload.text(name);
  payload.matrix(state.options.orders.na);
  payload.matrix(state.options.orders.nb);
  payload.matrix(state.options.orders.nk);
  payload.number(state.options.first_sample.has_value());
  if (state.options.first_sample) payload.number(static_cast<std::uint64_t>(*state.options.first_sample));
  payload.real(state.rate_hz);
  for (std::uint64_t count : {state.rows, state.episodes_used, state.episodes_skipped, state.rows_left_out}) {
    payload.number(count);
  }
  for (std::size_t c = 0; c < state.reference.size(); ++c) {
    payload.real(state.reference[c]);
    payload.real(state.sum[c]);
    payload.real(state.square[c]);
    payload.number(state.samples[c]);
    payload.text(state.spans[c].unit);
    payload.real(state.spans[c].lowest);
    payload.real(state.spans[c].highest);
  }
  for (Eigen::Index q = 0; q < state.triangle.cols(); ++q) {
    for (Eigen::Index p = 0; p <= q; ++p) payload.real(state.triangle(p, q));
  }
  write_notes(state.notes, payload);
  const std::vector<std::byte> body = payload.take();
  Writer whole;
  whole.number(kMagic);
  whole.number(kVersion);
  whole.number(body.size());
  whole.number(hash(body));
  std::vector<std::byte> bytes = whole.take();
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

Result<FactorState> factor_from_bytes(std::span<const std::byte> bytes) {
  Reader header(bytes.first(std::min(bytes.size(), kHeader)));
  if (header.number() != kMagic || !header.fine()) return Error{"this is not a part of a fit (its first bytes differ)"};
  const std::uint64_t version = header.number();
  if (version != kVersion) {
    return Error{"this part of a fit has format version " + std::to_string(version) + ", expected " +
                 std::to_string(kVersion) + "; make it again with this program"};
  }
  const std::uint64_t size = header.number();
  const std::uint64_t expected = header.number();
  if (!header.fine() || size != bytes.size() - kHeader) return Error{"this part of a fit is cut short; make it again"};
  const auto body = bytes.subspan(kHeader);
  if (hash(body) != expected) return Error{"this part of a fit was changed (its hash differs); make it again"};
  const Error damaged{"this part of a fit holds numbers that mean nothing; make it again"};
  Reader reader(body);
  const FactorOptions options = read_options(reader);
  if (!reader.fine() || !check_factor_options(options)) return damaged;
  const auto columns = static_cast<std::uint64_t>(make_design(options.orders, ArxOffset::kMean).layout.size());
  if (columns * (columns + 1) / 2 * 8 > reader.left()) return damaged;  // before memory is allocated
  FactorState state(options);
  state.rate_hz = reader.real();
  for (std::uint64_t* count : {&state.rows, &state.episodes_used, &state.episodes_skipped, &state.rows_left_out}) {
    *count = reader.number();
  }
  read_channels(reader, state);
  for (Eigen::Index q = 0; q < state.triangle.cols(); ++q) {
    for (Eigen::Index p = 0; p <= q; ++p) state.triangle(p, q) = reader.real();
  }
  read_notes(reader, state.notes);
  if (!reader.fine() || reader.left() != 0 || !meaningful(state) || !meaningful(state.notes)) return damaged;
  return state;
}

}  // namespace wisp
