#pragma once
// A command of the program: an entry of the table from which parser, help and docs/reference/cli.md are generated.

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp::cli {

class Terminal;

/// Type of a flag's value; the parser rejects wrong values before any work.
enum class Kind {
  kSwitch,         ///< no value
  kText,           ///< any text
  kPath,           ///< a file or folder name
  kOutput,         ///< a file or folder to write; must differ from every input
  kInteger,        ///< a whole number, not negative
  kNumber,         ///< a finite number
  kChoice,         ///< one of the words in `words`
  kIntegerOrWord,  ///< a whole number, or one of the words
  kNames,          ///< names separated by commas; commas inside quotes or round brackets belong to a name
  kSamples,        ///< a range A:B of samples, 1-based, inclusive
};

struct Flag {
  std::string name;  ///< name without the dashes
  Kind kind = Kind::kSwitch;
  std::string value;     ///< placeholder of the value in the help
  std::string fallback;  ///< default as text; empty: none
  std::string help;
  std::vector<std::string> words{};
  bool required = false;
  std::vector<std::string> unless{};  ///< flags that make this one optional
  /// Names of additional files of an output: extensions that replace its own or, for a folder, names in it.
  std::vector<std::string> brings{};
  std::string with{};  ///< another flag, without which this one is an error
  /// Range of the number, both ends included.
  double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
};

/// Adds a numeric range to a flag and to its help.
Flag ranged(Flag flag, double lowest, double highest);

/// Returns all flags of the lists.
std::vector<Flag> flags_of(std::initializer_list<std::vector<Flag>> lists);

std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// Returns the flag's help; for a choice with the accepted words, unless the placeholder of its value lists them.
std::string help_of(const Flag& flag);

struct Positional {
  std::string name;
  std::string help;
  bool many = false;
  bool optional = false;
};

struct Example {
  std::string line;
  std::string what;
};

/// A range of samples, 1-based and inclusive, as in identification literature.
struct SampleRange {
  std::size_t first = 1;
  std::size_t last = 0;
};

/// Returns whether a text is a sample range A:B with 1 <= A <= B.
bool is_sample_range(const std::string& text);

/// Values of a command's arguments, each given() by the user or a default. The parser has checked each value's Kind.
class Arguments {
 public:
  bool has(std::string_view flag) const { return values_.count(std::string(flag)) > 0; }
  bool on(std::string_view flag) const { return has(flag); }
  bool given(std::string_view flag) const { return has(flag) && !defaults_.contains(flag); }
  const std::string& text(std::string_view flag) const { return values_.at(std::string(flag)); }
  int integer(std::string_view flag) const;
  double number(std::string_view flag) const;
  std::vector<std::string> names(std::string_view flag) const;
  SampleRange samples(std::string_view flag) const;
  const std::string& positional() const { return positionals_.front(); }
  const std::vector<std::string>& positionals() const { return positionals_; }

  void set(const std::string& flag, std::string value) { values_[flag] = std::move(value); }
  void set_default(const std::string& flag, std::string value) {
    defaults_.insert(flag);
    set(flag, std::move(value));
  }
  void set_positionals(std::vector<std::string> values) { positionals_ = std::move(values); }

 private:
  std::map<std::string, std::string> values_;
  std::set<std::string, std::less<>> defaults_;  // flags in values_ that have their default
  std::vector<std::string> positionals_;
};

/// Returns an error if the user gave one of the flags; the message is the flag and `why`.
Result<void> refuse(const Arguments& arguments, std::initializer_list<const char*> flags, const std::string& why);

/// A command: its words (`learn arx`), arguments, flags and function. An error of `run` ends the program with exit
/// status 1, or with 2 if the message begins with a flag (`--`).
struct Command {
  std::string name;
  std::string summary;
  std::vector<Positional> positionals;
  std::vector<Flag> flags;
  std::vector<Example> examples;
  std::function<Result<void>(const Arguments&, Terminal&)> run;
};

/// Returns all commands, in the order of the help and the manual.
const std::vector<Command>& commands();

const std::vector<Flag>& common_flags();

/// Returns the program's manual, generated from the table, in the form `markdown` (docs/reference/cli.md), `man`,
/// `bash`, `zsh` or `fish`; empty for another word.
std::optional<std::string> manual(const std::string& form);

/// Returns a short text with the first commands to try.
std::string first_steps();

/// Returns the help for the command or group of commands with these words, else for the program.
std::string help(const std::string& words);

/// Returns one line about the first unknown or misplaced word, with the nearest known one. Empty if there is none.
std::string wrong_words(std::span<const std::string> words);

/// Returns whether writing a file would overwrite an input or a numbered image of an input folder, also through a link.
bool would_destroy(const std::filesystem::path& written, const std::string& input);

/// Checks file names before long work. Errors: an output or one of its additional files would overwrite an input; an
/// output's extension belongs to another kind of file; an output cannot be written; a file name contains a line break.
Result<void> check_outputs(const Command& command, const Arguments& arguments);

}  // namespace wisp::cli
