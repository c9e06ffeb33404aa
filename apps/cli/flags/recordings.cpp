#include "flags/recordings.hpp"

#include "flags/motion_flags.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/mat.hpp"

namespace wisp::cli {

std::vector<Flag> recording_flags() {
  return {
      {"rate", Kind::kNumber, "HZ", "",
       "samples a second of a table, or frames a second of a folder of images, that does not say so itself"},
      {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"},
  };
}

bool is_table(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".csv" || extension == ".txt" || extension == ".mat" || extension == ".CSV";
}

Result<CsvOptions> csv_options(const Arguments& arguments, CsvOptions options) {
  if (arguments.has("inputs")) options.inputs = arguments.names("inputs");
  if (arguments.has("outputs")) options.outputs = arguments.names("outputs");
  for (const std::string& column : motion_columns(arguments)) options.outputs.push_back(column);
  if (arguments.has("dt")) {
    const double seconds = arguments.number("dt");
    if (!(seconds > 0)) return Error{"--dt is " + arguments.text("dt") + ", expected seconds above 0"};
    options.rate_hz = 1 / seconds;
  }
  if (arguments.has("rate")) options.rate_hz = arguments.number("rate");
  return options;
}

Result<Recording> read_table(const std::filesystem::path& path, const Arguments& arguments,
                             const CsvOptions& otherwise) {
  const auto options = csv_options(arguments, otherwise);
  if (!options) return options.error();
  auto recording =
      path.extension() == ".mat"
          ? read_mat(path, {.rate_hz = options->rate_hz, .inputs = options->inputs, .outputs = options->outputs})
          : read_csv(path, *options);
  if (!recording) return recording;
  return as_motion(std::move(*recording), arguments);
}

bool leave_out(const std::string& path, const Error& error, const Arguments& arguments, Terminal& terminal) {
  if (!arguments.on("skip-bad")) return false;
  terminal.warn("left out: " + error.message);
  terminal.add(ReportTable{"skipped", "", {{"file", ""}, {"reason", ""}}, {{path, error.message}}});
  return true;
}

Result<std::vector<Recording>> read_tables(const std::vector<std::string>& paths, const Arguments& arguments,
                                           Terminal& terminal) {
  std::vector<Recording> recordings;
  for (const std::string& path : paths) {
    auto recording = read_table(path, arguments);
    if (recording) {
      recordings.push_back(std::move(recording).value());
    } else if (!leave_out(path, recording.error(), arguments, terminal)) {
      return recording.error();
    }
  }
  if (recordings.empty()) return Error{"none of the recordings can be used"};
  return recordings;
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

Result<std::vector<Recording>> in_range(std::vector<Recording> recordings, const Arguments& arguments) {
  for (Recording& recording : recordings) {
    auto part = in_range(std::move(recording), arguments, "range");
    if (!part) return part.error();
    recording = std::move(*part);
  }
  return recordings;
}

}  // namespace wisp::cli
