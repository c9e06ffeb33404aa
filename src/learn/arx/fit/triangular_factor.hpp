#pragma once
// A part of a fit: what some rows have to say about an ARX model, as a small triangle that can be stored, sent and
// merged.
//
// Source: the merging of triangular factors by orthogonal rotations is that of tall-skinny QR (J. Demmel et al., SIAM
// J. Sci. Comput. 34, 2012); see also Å. Björck, Numerical Methods for Least Squares Problems, section 6.2. However the
// rows are cut into parts and in whatever order these are merged, the fit is the same but for rounding, and has the
// accuracy of QR. Memory does not grow with the rows.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_orders.hpp"
#include "learn/arx/rows/seen_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Which model the parts are of: the same for all that are to be merged.
struct FactorOptions {
  ChannelChoice channels;
  ArxOrders orders;
};

/// Rows [begin, end) of a recording that a part takes in. Rows before them are history and belong to other parts.
struct PartRows {
  std::size_t begin = 0;
  std::size_t end = std::numeric_limits<std::size_t>::max();  ///< beyond the last row: to the last row
};

/// The rows of part `index` (0-based) of `count` when `rows` rows are shared out evenly.
///
/// Precondition: index < count.
PartRows part_rows(std::size_t rows, std::size_t index, std::size_t count);

/// What a channel did over the samples of a part.
struct ChannelSpan {
  std::string unit;
  double lowest = 0;  ///< 0 where it has no sample, as the next
  double highest = 0;
};

/// What a part says of itself; merge() leaves it to whoever merges.
struct FactorNotes {
  std::uint64_t jobs = 1;  ///< that made it
  std::vector<SeenRows> seen;
};

/// What a factor knows.
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

  int first_sample() const { return options.orders.history(); }
};

class TriangularFactor {
 public:
  /// An empty part. Errors: orders that do not fit the channels or are out of range.
  static Result<TriangularFactor> create(const FactorOptions& options);

  /// Takes in rows of a recording, with what came before them in their episode as history.
  /// Errors: a channel that the recording has not, another rate than before, infinite samples.
  Result<void> add(const Recording& recording, const PartRows& rows = {});

  /// Takes in rows of a table as they are read, a stretch at a time. Rows are counted from where the reader stands; the
  /// table is taken to end after `table_rows` of them, if not before.
  /// Errors: as add and CsvReader.
  Result<void> add(CsvReader& reader, const PartRows& rows = {},
                   std::size_t table_rows = std::numeric_limits<std::size_t>::max());

  /// Takes in all that another part knows. Errors: a part of another model.
  Result<void> merge(const TriangularFactor& other);

  /// Rows in the regression so far.
  std::size_t rows() const { return state_.rows; }

  const FactorOptions& options() const { return state_.options; }

  /// Samples a second; 0 before anything was taken in.
  double rate_hz() const { return state_.rate_hz; }

  /// Unit and range of every channel: outputs, then inputs.
  std::vector<ChannelSpan> spans() const { return state_.spans; }

  const FactorNotes& notes() const { return state_.notes; }
  void set_notes(FactorNotes notes) { state_.notes = std::move(notes); }

  /// As bytes, the same on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// From bytes. Errors: not a factor, cut short, changed, of another version, or not meaningful.
  static Result<TriangularFactor> from_bytes(std::span<const std::byte> bytes);

  /// The fit of all that was taken in, as fit_arx makes it; channels and orders of `options` are the factor's. Free
  /// simulation is not judged: there is no data to simulate. Errors: too few rows.
  Result<ArxFit> finish(const ArxOptions& options) const;

 private:
  explicit TriangularFactor(FactorState state) : state_(std::move(state)) {}
  FactorState state_;
};

Result<void> check_factor_options(const FactorOptions& options);

/// Errors: the parts are of different models; which of channels, orders or rate differs.
Result<void> check_same_model(const FactorState& state, const FactorState& other);

}  // namespace wisp
