#pragma once
// What the user sees: progress on standard error, the result on standard output.

#include <string>
#include <string_view>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"

namespace wisp::cli {

class Terminal {
 public:
  struct Options {
    bool json = false;
    bool quiet = false;
  };
  explicit Terminal(Options options);

  /// A bar on standard error while something long runs: `done` in [0, 1], or negative where the length is not known.
  /// Only drawn on a terminal.
  void progress(std::string_view what, double done);

  /// The same, as the library takes it.
  Progress progress();

  /// A report as the command's result: as text at once, or as part of the JSON document at the end. Its warnings go to
  /// standard error too.
  void show(const Report& report);

  /// A figure of the result for programs only.
  void add(std::string id, ReportValue value);

  /// Rows for programs only; they follow those of the same id.
  void add(ReportTable table);

  /// The verdict of something that was made on the way to the result, for people.
  void verdict(const std::string& of, const Report& report);

  /// Something the user should know though the command goes on; one line on standard error.
  void warn(std::string_view text);

  /// One line of the result for people; silent with --json.
  void say(std::string_view text);

  /// The result so far, which finish() prints as one JSON document with --json. A command of several steps takes each
  /// step's result out and puts the whole in.
  Report& result() { return result_; }

  /// Ends the progress bar, and prints the JSON document where asked for.
  void finish();

  /// The one line for a failure.
  void fail(std::string_view message);

  bool json() const { return options_.json; }

 private:
  void clear_bar();

  Options options_;
  bool terminal_ = false;
  bool bar_shown_ = false;
  int last_percent_ = -1;
  std::string last_what_;
  Report result_;
};

/// A number for people, with `digits` significant digits.
std::string shown(double value, int digits = 3);

}  // namespace wisp::cli
