#pragma once
// Sufficient statistics of some rows for an ARX fit: a small triangle that can be stored, sent and merged.
//
// Source: the merging of triangular factors by orthogonal rotations is that of tall-skinny QR (J. Demmel et al., SIAM
// J. Sci. Comput. 34, 2012); see also Å. Björck, Numerical Methods for Least Squares Problems, section 6.2. The fit
// does not depend, but for rounding, on how rows are divided into parts or on the order of merging, and has the
// accuracy of QR. Memory does not grow with the number of rows.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/plain_model.hpp"
#include "wisp/base/result.hpp"

namespace wisp::arx {

/// Rows [begin, end), from 0, of a recording that one part covers. All parts of the recording cover [first, last).
struct SeenRows {
  std::string source;
  std::uint64_t hash = 0;  ///< hash of the recording's contents, independent of its name
  std::uint64_t first = 0, last = 0;
  std::uint64_t begin = 0, end = 0;
};

/// Sums over a channel's samples about a reference near their mean, which limits cancellation.
struct PartChannel {
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< NaN before the first sample
  double sum = 0, square = 0;                                   ///< sums of (sample − reference) and of its square
  std::uint64_t samples = 0;
  ChannelSpan span;

  void add(double sample);
};

struct PartState {
  ChannelChoice names;
  ArxOrders orders;
  double rate_hz = 0;                 ///< sampling rate; 0 before rows were added
  std::vector<PartChannel> channels;  ///< outputs, then inputs
  Eigen::MatrixXd triangle;           ///< QR factor R of all columns of the design's layout
  std::uint64_t rows = 0, episodes_used = 0, episodes_skipped = 0, rows_left_out = 0;
  std::uint64_t jobs = 1;  ///< number of jobs that made the part
  std::vector<SeenRows> seen;

  /// An empty part. Precondition: check_orders() accepts both.
  PartState(ChannelChoice channel_names, ArxOrders model_orders);

  /// Merges another part, except for its number of jobs.
  /// Errors: a part of another model, rows that are in both parts; nothing is merged then.
  Result<void> merge(const PartState& more);

  /// Serialises the part to bytes with a hash; identical on every machine.
  std::vector<std::byte> bytes() const;

  /// Deserialises a part. Errors: not a part, truncated, corrupted, of another version, or with invalid values.
  static Result<PartState> from_bytes(std::span<const std::byte> bytes);
};

/// Turns columns (x − from) into (x − to)·scale, shift = from − to, by adding multiples of the constant's column.
void shift_columns(const ArxOrders& orders, const std::vector<double>& shift, const std::vector<double>& scale,
                   Eigen::MatrixXd& triangle);

/// Joins rows covered by parts to one entry per recording. Errors: rows of [first, last) that no part covers.
Result<std::vector<SeenRows>> covered(std::vector<SeenRows> seen);

/// Text of a row range, such as "1:500", counted from 1.
std::string rows_text(std::uint64_t begin, std::uint64_t end);

}  // namespace wisp::arx
