#pragma once
// What some rows have to say about an ARX model: a small triangle that can be stored, sent and merged.
//
// Source: the merging of triangular factors by orthogonal rotations is that of tall-skinny QR (J. Demmel et al., SIAM
// J. Sci. Comput. 34, 2012); see also Å. Björck, Numerical Methods for Least Squares Problems, section 6.2. However the
// rows are cut into parts and in whatever order these are merged, the fit is the same but for rounding, and has the
// accuracy of QR. Memory does not grow with the rows.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/plain_model.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "wisp/base/result.hpp"

namespace wisp::arx {

/// Rows [begin, end) of a recording whose rows [first, last) are to be taken in, by this part and its siblings;
/// 0-based.
struct SeenRows {
  std::string source;
  std::uint64_t hash = 0;  ///< of the recording's contents, whatever it is called
  std::uint64_t first = 0, last = 0;
  std::uint64_t begin = 0, end = 0;
};

/// Sums over the samples of a channel, about a reference near their mean, so that little is lost when it is taken off.
struct PartChannel {
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< NaN: there was no sample yet
  double sum = 0, square = 0;                                   ///< of sample − reference
  std::uint64_t samples = 0;
  ChannelSpan span;

  void add(double sample);
};

struct PartState {
  ChannelChoice names;
  ArxOrders orders;
  double rate_hz = 0;                 ///< 0: nothing was taken in
  std::vector<PartChannel> channels;  ///< outputs, then inputs
  Eigen::MatrixXd triangle;           ///< of all columns of the design's layout
  std::uint64_t rows = 0, episodes_used = 0, episodes_skipped = 0, rows_left_out = 0;
  std::uint64_t jobs = 1;  ///< that made it
  std::vector<SeenRows> seen;

  /// Nothing taken in yet. Precondition: check_orders() of both.
  PartState(ChannelChoice channel_names, ArxOrders model_orders);

  /// Takes in all that another part knows, but for its number of jobs.
  /// Errors: a part of another model, rows that are in both; then nothing is taken in.
  Result<void> merge(const PartState& more);

  /// As bytes, the same on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// From bytes. Errors: not a part, cut short, changed, of another version, or not meaningful.
  static Result<PartState> from_bytes(std::span<const std::byte> bytes);
};

/// (x − from)·1 becomes (x − to)·scale with shift = from − to: columns change by a multiple of the constant's.
void shift_columns(const ArxOrders& orders, const std::vector<double>& shift, const std::vector<double>& scale,
                   Eigen::MatrixXd& triangle);

/// The rows that are taken in, one entry a recording. Errors: rows between the first and the last one of a recording
/// that are in no part.
Result<std::vector<SeenRows>> covered(std::vector<SeenRows> seen);

/// "1:500", counted from 1.
std::string rows_text(std::uint64_t begin, std::uint64_t end);

}  // namespace wisp::arx
