// The bytes of a factor: magic, version, payload size and 64-bit FNV-1a hash of the payload, then the payload's numbers
// in little-endian order.

#include "learn/arx/fit/triangular_factor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "base/hash.hpp"
#include "learn/arx/fit/arx_check.hpp"

namespace wisp {
namespace {

constexpr std::uint64_t kMagic = 0x3152544350534957;  // "WISPCTR1"
constexpr std::uint64_t kVersion = 3;
constexpr std::size_t kHeader = 4 * 8;
constexpr std::uint64_t kMaxChannels = 4096;
constexpr std::uint64_t kMaxName = 65536;
constexpr std::uint64_t kMaxSeen = 1 << 20;

// One walk over a state both writes it and reads it. Reads past the end give zeros and are remembered.
class Archive {
 public:
  Archive() = default;
  explicit Archive(std::span<const std::byte> bytes) : left_(bytes), reading_(true) {}

  bool reading() const { return reading_; }
  bool fine() const { return fine_; }
  std::size_t left() const { return left_.size(); }
  std::vector<std::byte> take() { return std::move(bytes_); }
  void refuse() { fine_ = false; }

  void byte(std::byte& value) {
    if (!reading_) {
      bytes_.push_back(value);
    } else if (left_.empty()) {
      fine_ = false, value = std::byte{0};
    } else {
      value = left_.front(), left_ = left_.subspan(1);
    }
  }

  /// A whole number that must not be above `most`.
  template <class Whole>
  void number(Whole& value, std::uint64_t most = UINT64_MAX) {
    auto whole = static_cast<std::uint64_t>(value);
    for (int k = 0; k < 8; ++k) {
      auto part = static_cast<std::byte>(whole >> (8 * k) & 0xff);
      byte(part);
      whole = (whole & ~(std::uint64_t{0xff} << (8 * k))) | std::to_integer<std::uint64_t>(part) << (8 * k);
    }
    fine_ = fine_ && whole <= most;
    if (reading_) value = static_cast<Whole>(fine_ ? whole : 0);
  }
  void real(double& value) {
    auto bits = std::bit_cast<std::uint64_t>(value);
    number(bits);
    value = std::bit_cast<double>(bits);
  }
  void text(std::string& value) {
    std::uint64_t size = value.size();
    number(size, kMaxName);
    value.resize(size);
    for (char& c : value) {
      auto letter = static_cast<std::byte>(c);
      byte(letter);
      c = static_cast<char>(letter);
    }
  }
  void matrix(OrderMatrix& matrix, std::size_t rows, std::size_t columns) {
    if (reading_ && rows * columns * 8 > left()) refuse();
    if (!fine_) return;  // before memory is allocated
    if (reading_) matrix = OrderMatrix(static_cast<int>(rows), static_cast<int>(columns));
    for (int r = 0; r < matrix.rows(); ++r) {
      for (int c = 0; c < matrix.columns(); ++c) number(matrix(r, c), kMaxChannels);
    }
  }
  void names(std::vector<std::string>& all) {
    std::uint64_t count = all.size();
    number(count, kMaxChannels);
    for (std::uint64_t k = 0; k < count && fine_; ++k) {
      if (reading_) all.emplace_back();
      text(all[k]);
    }
  }

 private:
  std::vector<std::byte> bytes_;
  std::span<const std::byte> left_;
  bool reading_ = false, fine_ = true;
};

void walk(Archive& archive, FactorOptions& options) {
  archive.names(options.channels.outputs);
  archive.names(options.channels.inputs);
  if (!archive.fine()) return;
  const std::size_t ny = options.channels.outputs.size(), nu = options.channels.inputs.size();
  archive.matrix(options.orders.na, ny, ny);
  archive.matrix(options.orders.nb, ny, nu);
  archive.matrix(options.orders.nk, ny, nu);
}

// All but the options.
void walk(Archive& archive, FactorState& state) {
  archive.real(state.rate_hz);
  for (std::uint64_t* count : {&state.rows, &state.episodes_used, &state.episodes_skipped, &state.rows_left_out}) {
    archive.number(*count);
  }
  for (std::size_t c = 0; c < state.reference.size(); ++c) {
    for (double* value : {&state.reference[c], &state.sum[c], &state.square[c]}) archive.real(*value);
    archive.number(state.samples[c]);
    archive.text(state.spans[c].unit);
    archive.real(state.spans[c].lowest);
    archive.real(state.spans[c].highest);
  }
  for (Eigen::Index q = 0; q < state.triangle.cols(); ++q) {
    for (Eigen::Index p = 0; p <= q; ++p) archive.real(state.triangle(p, q));
  }
  std::uint64_t count = state.notes.seen.size();
  archive.number(state.notes.jobs);
  archive.number(count, kMaxSeen);
  for (std::uint64_t k = 0; k < count && archive.fine(); ++k) {
    if (archive.reading()) state.notes.seen.emplace_back();
    SeenRows& seen = state.notes.seen[k];
    archive.text(seen.source);
    for (auto* number : {&seen.hash, &seen.first, &seen.last, &seen.begin, &seen.end, &seen.copy}) {
      archive.number(*number);
    }
  }
}

bool meaningful(const FactorNotes& notes) {
  return notes.jobs > 0 && std::all_of(notes.seen.begin(), notes.seen.end(), [](const SeenRows& seen) {
           return seen.first <= seen.begin && seen.begin <= seen.end && seen.end <= seen.last;
         });
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
  return check_options(fit, options.channels);
}

Result<void> check_same_model(const FactorState& state, const FactorState& other) {
  const auto differ = [](const char* what) {
    return Error{std::string("the parts are of different models: their ") + what + " differ"};
  };
  if (state.options.channels.outputs != other.options.channels.outputs) return differ("outputs");
  if (state.options.channels.inputs != other.options.channels.inputs) return differ("inputs");
  if (!(state.options.orders == other.options.orders)) return differ("orders");
  const bool both = state.rate_hz != 0 && other.rate_hz != 0;
  if (both && std::abs(state.rate_hz - other.rate_hz) > 1e-6 * state.rate_hz) return differ("rates");
  return {};
}

std::vector<std::byte> TriangularFactor::bytes() const {
  FactorState own = state_;
  Archive payload, whole;
  walk(payload, own.options);
  walk(payload, own);
  const std::vector<std::byte> body = payload.take();
  for (std::uint64_t number : {kMagic, kVersion, std::uint64_t{body.size()}, hash_bytes(body)}) whole.number(number);
  std::vector<std::byte> bytes = whole.take();
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

Result<TriangularFactor> TriangularFactor::from_bytes(std::span<const std::byte> bytes) {
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
  FactorOptions options;
  walk(archive, options);
  if (!archive.fine() || !check_factor_options(options)) return damaged;
  const auto columns = static_cast<std::uint64_t>(make_design(options.orders, ArxOffset::kMean).layout.size());
  if (columns * (columns + 1) / 2 * 8 > archive.left()) return damaged;  // before memory is allocated
  FactorState state(options);
  walk(archive, state);
  if (!archive.fine() || archive.left() != 0 || !meaningful(state) || !meaningful(state.notes)) return damaged;
  return TriangularFactor(std::move(state));
}

}  // namespace wisp
