#include "flags/recordings.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "flags/motion_flags.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/mat.hpp"

namespace wisp::cli {

std::vector<Flag> table_flags() {
  return {
      {"columns", Kind::kNames, "A,B,…", "",
       "names of all columns of a plain table, in their order: of one without a header, or in place of it"},
      {"rate", Kind::kNumber, "HZ", "",
       "samples a second of a table, or frames a second of a folder of images, that does not say so itself"},
      {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
  };
}

std::vector<Flag> recording_flags() {
  std::vector<Flag> flags = table_flags();
  flags.push_back(
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"});
  return flags;
}

Flag prepare_flag() {
  return {"prepare", Kind::kNames, "WORDS", "",
          "what is done to recordings first, remembered by the model: detrend takes a straight line off every channel, "
          "highpass:HZ and lowpass:HZ filter all alike, resample:HZ changes the rate; such as detrend,resample:10"};
}

Result<Preparation> preparation_of(const Arguments& arguments) {
  auto preparation = parse_preparation(arguments.names("prepare"));
  return preparation ? std::move(preparation) : Error{"--prepare: " + preparation.error().message};
}

namespace {

// Accepted sampling rates, Hz: from one sample in 11.6 days to those of radio receivers.
constexpr double kMinRate = 1e-6, kMaxRate = 1e7;

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Reads a MATLAB file. A rate given only by `otherwise` is a default, which yields to the file's own rate.
Result<Recording> read_matlab(const std::filesystem::path& path, const CsvOptions& options, const Arguments& arguments,
                              const CsvOptions& otherwise) {
  if (!options.columns.empty()) {
    return Error{"--columns names columns of a table; of " + path.string() + " name variables, such as u or u(:,2)"};
  }
  const double rate_hz = options.rate_hz > 0 ? options.rate_hz : options.usual_rate_hz;
  const auto most = static_cast<std::size_t>(arguments.has("unpacked") ? arguments.number("unpacked") * 1e9 : 0);
  const MatOptions named{.rate_hz = rate_hz, .max_bytes = most, .inputs = options.inputs, .outputs = options.outputs};
  if (arguments.has("dt") || arguments.has("rate") || otherwise.rate_hz == 0) return read_mat(path, named);
  auto stated = read_mat(path, {.max_bytes = most, .inputs = options.inputs, .outputs = options.outputs});
  return stated ? std::move(stated) : read_mat(path, named);
}

}  // namespace

bool is_table(const std::filesystem::path& path) {
  static constexpr std::array<std::string_view, 6> kTables = {".csv", ".tsv", ".txt", ".dat", ".asc", ".mat"};
  return std::find(kTables.begin(), kTables.end(), extension_of(path)) != kTables.end();
}

bool is_matlab(const std::filesystem::path& path) { return extension_of(path) == ".mat"; }

Result<CsvOptions> csv_options(const Arguments& arguments, CsvOptions options) {
  options.usual_rate_hz = std::exchange(options.rate_hz, 0);  // a table's time takes precedence
  if (arguments.has("inputs")) options.inputs = arguments.names("inputs");
  if (arguments.has("outputs")) options.outputs = arguments.names("outputs");
  const auto motion = motion_columns(arguments);
  if (!motion) return motion.error();
  options.outputs.insert(options.outputs.end(), motion->begin(), motion->end());
  options.columns = arguments.names("columns");
  if (arguments.has("dt")) {
    if (arguments.has("rate")) return Error{"--rate and --dt both say how fast samples are taken: leave one out"};
    const double seconds = arguments.number("dt");
    if (!(seconds > 0)) return Error{"--dt is " + arguments.text("dt") + ", expected seconds above 0"};
    options.rate_hz = 1 / seconds;
  }
  if (arguments.has("rate")) options.rate_hz = arguments.number("rate");
  if ((options.rate_hz != 0 || arguments.has("rate")) &&
      !(options.rate_hz >= kMinRate && options.rate_hz <= kMaxRate)) {
    return Error{std::string(arguments.has("rate") ? "--rate" : "--dt") + ": " + shown(options.rate_hz) +
                 " samples a second, expected 1e-6 to 1e7"};
  }
  return options;
}

Result<Recording> read_table(const std::filesystem::path& path, const Arguments& arguments,
                             const CsvOptions& otherwise) {
  const auto options = csv_options(arguments, otherwise);
  if (!options) return options.error();
  auto recording = is_matlab(path) ? read_matlab(path, *options, arguments, otherwise) : read_csv(path, *options);
  if (!recording) return recording;
  return as_motion(std::move(*recording), arguments);
}

bool leave_out(const std::string& path, const Error& error, const Arguments& arguments, Terminal& terminal) {
  if (!arguments.on("skip-bad")) return false;
  terminal.warn("left out: " + error.message);
  terminal.add(ReportTable{"skipped", "", {{"file", ""}, {"reason", ""}}, {{path, error.message}}});
  return true;
}

Result<std::vector<Recording>> read_all(const std::vector<std::string>& paths, const Arguments& arguments,
                                        Terminal& terminal,
                                        const std::function<Result<Recording>(const std::string&)>& read) {
  std::vector<Recording> recordings;
  for (const std::string& path : paths) {
    auto recording = read(path);
    if (recording) {
      recordings.push_back(std::move(recording).value());
    } else if (!leave_out(path, recording.error(), arguments, terminal)) {
      return recording.error();
    }
  }
  if (recordings.empty()) return Error{paths.front() + ": none of the recordings can be used"};
  return recordings;
}

Result<std::vector<Recording>> read_tables(const std::vector<std::string>& paths, const Arguments& arguments,
                                           Terminal& terminal, const CsvOptions& otherwise) {
  return read_all(paths, arguments, terminal,
                  [&](const std::string& path) { return read_table(path, arguments, otherwise); });
}

Result<Recording> in_range(Recording recording, const Arguments& arguments, std::string_view flag) {
  if (!arguments.has(flag)) return recording;
  const SampleRange range = arguments.samples(flag);
  if (range.last > recording.rows()) {
    return Error{recording.source + ": --" + std::string(flag) + " " + arguments.text(flag) + " reaches beyond its " +
                 std::to_string(recording.rows()) + " rows"};
  }
  return slice(recording, range.first - 1, range.last);
}

Result<std::vector<Recording>> in_range(std::vector<Recording> recordings, const Arguments& arguments,
                                        Terminal& terminal) {
  std::vector<Recording> parts;
  for (Recording& recording : recordings) {
    const std::string source = recording.source;
    auto part = in_range(std::move(recording), arguments, "range");
    if (part) {
      parts.push_back(*std::move(part));
    } else if (!leave_out(source, part.error(), arguments, terminal)) {
      return part.error();
    }
  }
  if (parts.empty()) return Error{"none of the recordings can be used"};
  return parts;
}

}  // namespace wisp::cli
