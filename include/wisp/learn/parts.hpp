#pragma once
// ARX estimation in parts, merged in any order, for tables larger than memory or spread over processes and machines.
//
// A part holds the triangular factor of its rows' regression, whose size does not depend on the number of rows. The fit
// of merged parts equals that of all rows in memory except for rounding. Models of other kinds have no parts: they are
// learned in one place, from recordings that may be captured in many.
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

/// Selects share `index` of a table's rows [first, first + rows), which are divided into `count` equal shares.
struct TableShare {
  std::size_t first = 0;
  std::size_t rows = std::numeric_limits<std::size_t>::max();  ///< number of rows; the default: all
  std::size_t index = 0;                                       ///< counted from 0
  std::size_t count = 1;                                       ///< > index
};

/// A part of an ARX fit.
class ArxPart {
 public:
  /// Creates an empty part of the model that a recipe describes by its channels, orders and coupling.
  /// Errors: no outputs, orders that do not fit the channels; unspecified delays or a search, since these need all
  /// recordings in memory.
  static Result<ArxPart> create(const ArxRecipe& recipe);

  ArxPart(ArxPart&&) noexcept;
  ArxPart& operator=(ArxPart&&) noexcept;
  ~ArxPart();

  /// Adds a share of a recording; after an error the part is unchanged. Errors: a missing channel, a rate that differs
  /// from the previous one, infinite samples, rows beyond the recording's end, rows that were added before.
  Result<void> add(const Recording& recording, const TableShare& share = {});

  /// Adds a share of a CSV file, read in blocks, in memory that does not grow with its length.
  /// Errors: as for a recording, and those of CsvReader.
  Result<void> add(const std::filesystem::path& table, const CsvOptions& options = {}, const TableShare& share = {});

  /// Merges another part into this one. Errors: a part of another model or in other units, rows that are in both.
  Result<void> merge(const ArxPart& other);

  /// Returns the number of rows in the regression so far.
  std::size_t rows() const;

  /// Returns the number of parts merged, this one included, and the names of the recordings whose rows they hold.
  std::size_t jobs() const;
  std::vector<std::string> sources() const;

  /// Serialises the part to bytes, equal on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// Deserialises a part. Errors: not a part, truncated, modified, of another version, or inconsistent.
  static Result<ArxPart> from_bytes(std::span<const std::byte> bytes);

  /// Fits the rows of all parts as learn() does. Of the recipe only name, offset, kernel, radius, keep_unstable and
  /// responses are used. Free simulation is evaluated where all rows come from whole CSV files, which are read again
  /// for it; residuals are not tested. Errors: too few rows, rows of a recording's shares that are in no part, a file
  /// that cannot be read again, kStopped.
  Result<Fit> finish(const ArxRecipe& recipe, const Progress& progress = {}) const;

 private:
  struct State;
  explicit ArxPart(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace wisp
