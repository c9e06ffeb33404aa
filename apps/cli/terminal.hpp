#pragma once
// What the user sees: progress on standard error, the result on standard output.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"

namespace wisp::cli {

using Json = nlohmann::ordered_json;

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

  /// The verdict of something that was made on the way to the result, for people.
  void verdict(const std::string& of, const Report& report);

  /// Something the user should know though the command goes on; one line on standard error.
  void warn(std::string_view text);

  /// One line of the result for people; silent with --json.
  void say(std::string_view text);

  /// The result for programs; printed at the end, once, with --json only.
  Json& result() { return result_; }

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
  Json result_ = Json::object();
};

/// A number as JSON: null where it is not finite, so that the document stays valid.
Json number(double value);

/// A number for people, with `digits` significant digits.
std::string shown(double value, int digits = 3);

}  // namespace wisp::cli
