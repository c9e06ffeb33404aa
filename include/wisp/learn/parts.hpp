#pragma once
// An ARX fit in parts: of tables larger than memory, or spread over processes and machines. Parts are merged in any
// order.
//
// A part holds the triangle of its rows' regression, which is small however many rows there are. The fit of merged
// parts is that of all rows in memory but for rounding. Other models are learned from recordings in one place: jobs
// capture clips, and one of them learns from the folder of recordings.
//
// Source: J. Demmel et al., SIAM J. Sci. Comput. 34 (2012), tall-skinny QR.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Which rows of a table are taken in: of its rows [first, first + rows) the share `index` (0-based) of `count`.
struct TableShare {
  std::size_t first = 0;
  std::size_t rows = std::numeric_limits<std::size_t>::max();  ///< the largest: all there are
  std::size_t index = 0;
  std::size_t count = 1;  ///< > index
};

/// A part of an ARX fit.
class ArxPart {
 public:
  /// An empty part of the model that a recipe describes by its channels, orders and coupling.
  /// Errors: no outputs, orders that do not fit the channels; delays that are open, a search: these need all
  /// recordings in memory.
  static Result<ArxPart> create(const ArxRecipe& recipe);

  ArxPart(ArxPart&&) noexcept;
  ArxPart& operator=(ArxPart&&) noexcept;
  ~ArxPart();

  /// Adds a share of a recording; where that fails nothing of it is added.
  /// Errors: a channel that it has not, another rate than before, infinite samples, rows beyond its end, rows that were
  /// added before.
  Result<void> add(const Recording& recording, const TableShare& share = {});

  /// The same of a CSV file, read a stretch at a time, in the same memory however long it is.
  /// Errors: also those of CsvReader.
  Result<void> add(const std::filesystem::path& table, const CsvOptions& options = {}, const TableShare& share = {});

  /// Takes in all that another part knows. Errors: a part of another model, rows that are in both.
  Result<void> merge(const ArxPart& other);

  /// Rows in the regression so far.
  std::size_t rows() const;

  /// Parts that were merged, itself counted; and what the recordings are called whose rows they hold.
  std::size_t jobs() const;
  std::vector<std::string> sources() const;

  /// As bytes, the same on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// From bytes. Errors: not a part, cut short, changed, of another version, or not meaningful.
  static Result<ArxPart> from_bytes(std::span<const std::byte> bytes);

  /// The fit of all that was taken in, as learn() makes it. Of the recipe only name, offset, kernel, radius,
  /// keep_unstable and responses count here. Free simulation is judged where all that was taken in are CSV files, which
  /// are read once more for it; residuals are not tested.
  /// Errors: too few rows, rows of a recording's shares that are in no part, a file that cannot be read again,
  /// kStopped.
  Result<Fit> finish(const ArxRecipe& recipe, const Progress& progress = {}) const;

 private:
  struct State;
  explicit ArxPart(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace wisp
