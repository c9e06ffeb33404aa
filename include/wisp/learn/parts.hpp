#pragma once
// Fits in parts: of tables larger than memory, or spread over processes and machines. Parts are merged in any order.
//
// What rows have to say about an ARX model is a small triangle, however many they are, and the fit is that of all rows
// in memory but for rounding. An outline's scale, delays, curves and residuals are told from all recordings together,
// at a small share of what capturing them takes: its part holds the recordings themselves, and the fit is the same to
// the bit.
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
  /// Errors: no outputs, orders that do not fit the channels; delays that are open, a search, curves: these need all
  /// recordings in memory.
  static Result<ArxPart> create(const ArxRecipe& recipe);

  ArxPart(ArxPart&&) noexcept;
  ArxPart& operator=(ArxPart&&) noexcept;
  ~ArxPart();

  /// Takes in a share of a recording; of an error nothing.
  /// Errors: a channel that it has not, another rate than before, infinite samples, rows beyond its end.
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

  /// Orders of the model.
  const ArxOrders& orders() const;

  /// As bytes, the same on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// From bytes. Errors: not a part, cut short, changed, of another version, or not meaningful.
  static Result<ArxPart> from_bytes(std::span<const std::byte> bytes);

  /// The fit of all that was taken in, as learn() makes it; `sources` are the names that the model remembers. Of the
  /// recipe only name, offset, ridge, radius, keep_unstable and responses count here. Free simulation is judged where
  /// all that was taken in are CSV files, which are read once more for it; residuals are not tested.
  /// Errors: too few rows, rows of a recording's shares that are in no part, a file that cannot be read again,
  /// kStopped.
  Result<Fit> finish(const ArxRecipe& recipe, const std::vector<std::string>& sources,
                     const Progress& progress = {}) const;

 private:
  struct State;
  explicit ArxPart(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Which of the jobs that share a list of clips or recordings: `index` (0-based) of `count`.
struct ListShare {
  std::vector<std::string> names;  ///< the whole list, the same for all of them
  std::size_t index = 0;
  std::size_t count = 1;  ///< > index, at most as many as there are names

  /// The names that are this job's.
  std::vector<std::string> own() const;
};

/// A part of an outline's or a flame's fit: recordings, and which jobs made it.
class OutlinePart {
 public:
  /// What a job has recorded. Errors: as check() of a recording, the same recording twice.
  static Result<OutlinePart> create(const std::vector<Recording>& recordings, const ListShare& share);

  /// Takes in all that another part holds; of an error nothing.
  /// Errors: a recording or a share that is in both, another share of the same list.
  Result<void> merge(const OutlinePart& other);

  /// Parts that were merged, itself counted.
  std::size_t jobs() const { return shares_.size(); }

  /// What learn() takes, in the order of their names, whatever order they were merged in.
  /// Errors: a share of a list that is missing.
  Result<std::vector<Recording>> recordings() const;

  /// As bytes, the same on every machine, with a hash.
  std::vector<std::byte> bytes() const;

  /// From bytes. Errors: not a part, cut short, changed, of another version.
  static Result<OutlinePart> from_bytes(std::span<const std::byte> bytes);

 private:
  struct Share {
    std::uint64_t list = 0;  // hash of its names
    std::size_t index = 0;
    std::size_t count = 1;
  };

  struct Table {
    std::string source;
    std::string text;  // as CSV
  };

  Result<void> add(const Table& table);
  Result<void> add(const Share& share);

  std::vector<Share> shares_;
  std::vector<Table> tables_;
};

}  // namespace wisp
