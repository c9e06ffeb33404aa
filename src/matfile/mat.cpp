#include "wisp/record/mat.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/path_text.hpp"
#include "matfile/level5.hpp"
#include "record/csv_cells.hpp"
#include "record/number_text.hpp"
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

using matfile::Found;
using matfile::Miss;
using matfile::Name;
using matfile::Path;
using matfile::Table;

// Bounds on the unpacked size. zlib packs zeros 1000 to 1, recordings rarely more than 10 to 1.
constexpr std::size_t kMaxUnpacked = std::size_t{1} << 30, kMinUnpacked = std::size_t{1} << 26;
constexpr std::size_t kExpansion = 64;

class File {
 public:
  static Result<File> open(const std::filesystem::path& path, std::size_t max_bytes = 0) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return Error{path_text(path) + ": there is no such file"};
    auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    if (is_level73(*bytes)) {
      return Error{path_text(path) +
                   ": this is a MATLAB file of level 7.3, which is HDF5; save it with -v7, or as CSV"};
    }
    if (!matfile::is_level5(*bytes)) {
      return Error{path_text(path) + ": this is not a MATLAB file of level 5; save it with -v7"};
    }
    if (!matfile::is_whole_level5(*bytes)) {
      return Error{path_text(path) + ": the file is cut short or damaged: its parts do not end where it ends"};
    }
    const std::size_t usual = std::clamp(kExpansion * bytes->size(), kMinUnpacked, kMaxUnpacked);
    return File(path, std::move(*bytes), max_bytes > 0 ? max_bytes : usual);
  }

  std::vector<Name> names() const { return matfile::names_in_level5(bytes_); }

  Found read(const Path& at) const {
    return matfile::read_level5(bytes_, at, (max_bytes_ - unpacked_) / sizeof(double));
  }

  // Counts numbers that are kept against the file's budget of unpacked bytes.
  void keep(std::size_t numbers) { unpacked_ += numbers * sizeof(double); }

  const std::filesystem::path& path() const { return path_; }

  std::string budget() const {
    return "more than " + std::to_string(max_bytes_ >> 20) + " MB of numbers would be unpacked from a file of " +
           std::to_string(std::max<std::size_t>(bytes_.size() >> 10, 1)) +
           " kB; if it is what it should be, raise the limit with --unpacked GB";
  }

 private:
  File(std::filesystem::path path, std::vector<std::byte> bytes, std::size_t max_bytes)
      : path_(std::move(path)), bytes_(std::move(bytes)), max_bytes_(max_bytes) {}

  static bool is_level73(std::span<const std::byte> file) {
    const std::string_view mark("\0\2IM", 4);
    return file.size() >= 128 && std::memcmp(&file[124], mark.data(), mark.size()) == 0;
  }

  std::filesystem::path path_;
  std::vector<std::byte> bytes_;
  std::size_t max_bytes_;
  std::size_t unpacked_ = 0;
};

std::vector<std::string> list_variables(const File& file) {
  std::vector<std::string> names;
  for (const Name& found : file.names()) {
    names.push_back(found.name + " (" + std::to_string(found.rows) + " × " + std::to_string(found.columns) + ")");
  }
  return names;
}

// A parsed reference such as `data.u(:,2)`.
struct Reference {
  std::vector<std::string> path;  // variable, then fields
  std::optional<std::size_t> column;
};

std::optional<Reference> parse(std::string text) {
  Reference reference;
  if (text.ends_with(")")) {
    const std::size_t open = text.find("(:,");
    if (open == std::string::npos) return std::nullopt;
    const std::string digits = text.substr(open + 3, text.size() - open - 4);
    if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos) {
      return std::nullopt;
    }
    reference.column = std::stoul(digits);
    text.resize(open);
  }
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('.', begin), text.size());
    if (end == begin) return std::nullopt;
    reference.path.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return reference;
}

// Lists the first names to choose from.
std::string listed(const File& file) {
  constexpr std::size_t kMax = 40;
  std::string list;
  const std::vector<std::string> names = list_variables(file);
  for (std::size_t k = 0; k < std::min(names.size(), kMax); ++k) list += (k == 0 ? "" : ", ") + names[k];
  if (names.size() > kMax) list += " and " + std::to_string(names.size() - kMax) + " more";
  return list.empty() ? "nothing numeric" : list;
}

class Reader {
 public:
  explicit Reader(File& file) : file_(file) {}

  Result<Table> table(std::string name) const {
    auto reference = parse(name);
    if (!reference) return at(name, "expected a variable such as u, data.u or u(:,2)");
    Found found = file_.read(reference->path);
    // u2 may also be the name that add_channels() gives to the second column of a matrix u.
    for (std::size_t end = name.size(); end-- > 1 && is_digit(name[end]) && is_absent(found);) {
      const std::string text = name.substr(0, end) + "(:," + name.substr(end) + ")";
      auto column = name[end] == '0' ? std::nullopt : parse(text);
      Found matrix = column ? file_.read(column->path) : found;
      if (!std::holds_alternative<Table>(matrix)) continue;
      found = std::move(matrix);
      reference = std::move(column);
      name = text;
    }
    if (const auto* miss = std::get_if<Miss>(&found)) return at(name, words_of(*miss));
    auto& table = std::get<Table>(found);
    if (table.rows == 1) std::swap(table.rows, table.columns);
    file_.keep(reference->column ? table.rows : table.numbers.size());
    if (!reference->column) return std::move(table);
    if (*reference->column < 1 || *reference->column > table.columns) {
      return at(name, "the variable has " + std::to_string(table.columns) + " columns");
    }
    const auto first = table.numbers.begin() + static_cast<std::ptrdiff_t>((*reference->column - 1) * table.rows);
    return Table{table.rows, 1, {first, first + static_cast<std::ptrdiff_t>(table.rows)}};
  }

  std::optional<double> scalar(const char* name) const {
    const Found found = file_.read({name});
    const auto* table = std::get_if<Table>(&found);
    const double number = table && table->numbers.size() == 1 ? table->numbers.front() : 0;
    return std::isfinite(number) && number > 0 ? std::optional(number) : std::nullopt;
  }

  Error at(const std::string& name, const std::string& what) const {
    return Error{path_text(file_.path()) + ", variable " + name + ": " + what};
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_absent(const Found& found) {
    const auto* miss = std::get_if<Miss>(&found);
    return miss && (*miss == Miss::kNoVariable || *miss == Miss::kNoField);
  }

  std::string words_of(Miss miss) const {
    if (miss == Miss::kTooLarge) return file_.budget();
    if (miss == Miss::kDamaged) return "its data is damaged or cut short";
    const char* const found = miss == Miss::kNoVariable ? "there is no such variable"
                              : miss == Miss::kNoField
                                  ? "there is no such field"
                                  : "expected a real, full, numeric vector or matrix of two dimensions";
    return found + std::string("; the file has: ") + listed(file_);
  }

  File& file_;
};

// Returns the samples per second that a variable t or time, in seconds, implies; 0 if there is none or it counts rows.
Result<double> rate_by_time(const Reader& reader) {
  for (const char* name : {"t", "time"}) {
    const auto table = reader.table(name);
    if (!table || table->numbers.size() != table->rows || table->rows < 2) continue;
    const std::vector<double>& times = table->numbers;
    // Times in single precision are even within its rounding errors.
    const bool single = std::all_of(times.begin(), times.end(), [](double t) {
      return std::abs(t) < 1e30 && static_cast<double>(static_cast<float>(t)) == t;
    });
    const auto step = csv::step_of(times, single ? 1.2e-7 * std::abs(times.back()) : 0, 1);
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      if (step && std::abs(times[k + 1] - times[k] - step->step) <= step->tolerance) continue;
      return reader.at(name, "time does not go on evenly: " + number_text(times[k + 1], 12) + " after " +
                                 number_text(times[k], 12) +
                                 "; resample to one rate, or give the rate (--rate HZ, --dt S)");
    }
    return step->step == 1 ? 0.0 : 1 / step->step;  // 1, 2, 3 may count rows
  }
  return 0.0;
}

Result<void> add_channels(const Reader& reader, const std::string& name, Role role, Recording& recording) {
  auto table = reader.table(name);
  if (!table) return table.error();
  if (!recording.channels.empty() && table->rows != recording.rows()) {
    return reader.at(name, "it has " + std::to_string(table->rows) + " samples, " + recording.channels.front().name +
                               " has " + std::to_string(recording.rows()));
  }
  for (std::size_t c = 0; c < table->columns; ++c) {
    Channel channel{table->columns == 1 ? name : name + std::to_string(c + 1), "", role, {}};
    const auto first = table->numbers.begin() + static_cast<std::ptrdiff_t>(c * table->rows);
    if (table->columns == 1) std::swap(channel.samples, table->numbers);
    if (table->columns > 1) channel.samples.assign(first, first + static_cast<std::ptrdiff_t>(table->rows));
    for (std::size_t t = 0; t < channel.samples.size(); ++t) {
      if (std::isinf(channel.samples[t])) return reader.at(name, "sample " + std::to_string(t + 1) + " is infinite");
    }
    recording.channels.push_back(std::move(channel));
  }
  return {};
}

}  // namespace

Result<Recording> read_mat(const std::filesystem::path& path, const MatOptions& options) {
  auto file = File::open(path, options.max_bytes);
  if (!file) return file.error();
  if (options.inputs.empty() && options.outputs.empty()) {
    return Error{path_text(path) + ": name the variables that are inputs and outputs; the file has: " + listed(*file)};
  }
  const Reader reader(*file);
  Recording recording;
  recording.source = path_text(path);
  recording.rate_hz = options.rate_hz;
  if (recording.rate_hz == 0) {
    if (const auto seconds = reader.scalar("Ts")) recording.rate_hz = 1 / *seconds;
    if (const auto rate = reader.scalar("fs")) recording.rate_hz = *rate;
  }
  if (recording.rate_hz == 0) {
    const auto rate = rate_by_time(reader);
    if (!rate) return rate.error();
    recording.rate_hz = *rate;
  }
  if (!(recording.rate_hz > 0) || !std::isfinite(recording.rate_hz)) {
    return Error{
        path_text(path) +
        ": no rate; give it, or store a scalar Ts (seconds) or fs (samples a second), or a vector t of seconds"};
  }
  for (const auto& [names, role] : {std::pair{&options.inputs, Role::kInput}, {&options.outputs, Role::kOutput}}) {
    for (const std::string& name : *names) {
      if (auto ok = add_channels(reader, name, role, recording); !ok) return ok.error();
    }
  }
  if (auto ok = check(recording); !ok) return Error{path_text(path) + ": " + ok.error().message};
  return recording;
}

Result<std::vector<std::string>> list_mat(const std::filesystem::path& path) {
  const auto file = File::open(path);
  if (!file) return file.error();
  return list_variables(*file);
}

}  // namespace wisp
