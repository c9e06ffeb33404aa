#pragma once
// What a triangular factor knows, and its bytes.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/arx/fit/triangular_factor.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

struct FactorState {
  FactorOptions options;
  ArxDesign design;
  double rate_hz = 0;             ///< 0: nothing was taken in
  std::vector<double> reference;  ///< per channel: what was taken off its samples; NaN: it had none yet
  std::vector<double> sum;        ///< per channel, over the samples owned, of sample − reference
  std::vector<double> square;     ///< likewise of its square
  std::vector<std::uint64_t> samples;
  std::vector<ChannelSpan> spans;  ///< per channel
  Eigen::MatrixXd triangle;        ///< of all columns of the design's layout
  std::uint64_t rows = 0;
  std::uint64_t episodes_used = 0;
  std::uint64_t episodes_skipped = 0;
  std::uint64_t rows_left_out = 0;
  FactorNotes notes;

  explicit FactorState(const FactorOptions& given);

  int first_sample() const { return options.first_sample.value_or(options.orders.history()); }
};

Result<void> check_factor_options(const FactorOptions& options);

/// Errors: the parts are of different models; which of channels, orders, first sample or rate differs.
Result<void> check_same_model(const FactorState& state, const FactorState& other);

std::vector<std::byte> factor_bytes(const FactorState& state);

/// Errors: as TriangularFactor::from_bytes.
Result<FactorState> factor_from_bytes(std::span<const std::byte> bytes);

}  // namespace wisp
