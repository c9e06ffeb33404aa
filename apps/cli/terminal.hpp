#pragma once
// Output for the user: progress on standard error, the result on standard output.

#include <chrono>
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

  /// Draws a progress bar on standard error: `done` in [0, 1], or negative for an unknown length. Only on a terminal.
  void progress(std::string_view what, double done);

  /// Returns the progress bar as the library's callback.
  Progress progress();

  /// Shows a report as the command's result: as text immediately, or as part of the JSON document at the end. Its
  /// warnings go to standard error and into the JSON document, not into the text.
  void show(const Report& report);

  /// Adds a figure to the JSON result only.
  void add(std::string id, ReportValue value);

  /// Adds a table to the JSON result only. Rows are appended to a table of the same id, if there is one.
  void add(ReportTable table);

  /// Prints one line with the verdict of an intermediate result, whose name is `of`; silent with --json.
  void verdict(const std::string& of, const Report& report);

  /// Prints a warning, one line on standard error, and adds it to the result; the command continues.
  void warn(std::string_view text);

  /// Prints one line of the result for people; silent with --json.
  void say(std::string_view text);

  /// Returns the result so far, which finish() prints as one JSON document with --json. `wisp demo` takes out the
  /// result of each step and puts it back as a part of the whole.
  Report& result() { return result_; }

  /// Ends the progress bar, and prints the JSON document with --json.
  void finish();

  /// Prints the error line and, with --json, the document with the result so far and `error`.
  void fail(std::string_view message);

  bool json() const { return options_.json; }

  /// Starts the clock of seconds(), as the constructor does.
  void begin() { started_ = std::chrono::steady_clock::now(); }

  /// Returns the time since begin(), seconds.
  double seconds() const;

 private:
  void clear_bar();

  Options options_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  bool terminal_ = false;
  bool bar_shown_ = false;
  int last_percent_ = -1;
  std::chrono::steady_clock::time_point begun_{};  // start of the operation in the progress bar
  std::string last_what_;
  Report result_;
};

/// Formats a number with `digits` significant digits.
std::string shown(double value, int digits = 3);

}  // namespace wisp::cli
