// The program `wisp`: parses the command line and runs one command of the table. Exit status: 0 success, 1 bad data or
// a bad file, 2 wrong usage.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/recipe_fields.hpp"

namespace wisp::cli {
namespace {

constexpr int kDone = 0, kBadData = 1, kWrongUsage = 2;

bool is_whole(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

bool is_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::abs(value) <= 1e30;  // single precision holds it
}

bool is_word(const Flag& flag, const std::string& text) {
  return std::find(flag.words.begin(), flag.words.end(), text) != flag.words.end();
}

// Describes what is wrong with the type of a flag's value; empty if nothing.
std::string complaint_of_kind(const Flag& flag, const std::string& text) {
  const std::string found = "found \"" + text + "\", expected ";
  switch (flag.kind) {
    case Kind::kSwitch:
      return {};
    case Kind::kText:
    case Kind::kPath:
    case Kind::kOutput:
    case Kind::kNames:
      return text.empty() ? "is empty" : std::string();
    case Kind::kInteger:
      return is_whole(text) ? std::string() : found + "a whole number from 0 to 999999999";
    case Kind::kNumber:
      return is_number(text) ? std::string() : found + "a number within 1e30";
    case Kind::kChoice:
      return is_word(flag, text) ? std::string() : found + "one of " + joined(flag.words, ", ");
    case Kind::kIntegerOrWord:
      return is_whole(text) || is_word(flag, text)
                 ? std::string()
                 : found + "a whole number from 0 to 999999999, or " + joined(flag.words, ", ");
    case Kind::kSamples:
      return is_sample_range(text) ? std::string() : found + "a range A:B of samples with 1 <= A <= B, such as 1:300";
  }
  return {};
}

// Describes what is wrong with a flag's value; empty if nothing.
std::string complaint(const Flag& flag, const std::string& text) {
  const bool numeric = flag.kind == Kind::kInteger || flag.kind == Kind::kNumber || flag.kind == Kind::kIntegerOrWord;
  std::string wrong = complaint_of_kind(flag, text);
  if (!wrong.empty() || !numeric || is_word(flag, text)) return wrong;
  const double value = std::strtod(text.c_str(), nullptr);
  if (value >= flag.lowest && value <= flag.highest) return {};
  return "found \"" + text + "\", expected " + range_text(flag.lowest, flag.highest);
}

bool is_command(const std::string& words) {
  return std::any_of(commands().begin(), commands().end(), [&](const Command& one) { return one.name == words; });
}

bool is_group(const std::string& word) {
  return std::ranges::any_of(commands(), [&](const Command& one) { return one.name.starts_with(word + " "); });
}

// A command registered with CLI11, and the storage for its values.
struct Wired {
  const Command* command = nullptr;
  CLI::App* app = nullptr;
  std::map<std::string, std::string> values;
  std::map<std::string, bool> switches;
  std::vector<std::string> positionals;
  std::vector<std::string> single;
};

void add_flag(Wired& wired, const Flag& flag) {
  if (flag.kind == Kind::kSwitch) {
    wired.app->add_flag("--" + flag.name, wired.switches[flag.name]);
    return;
  }
  const std::string short_name = flag.name == "output" ? "-o," : "";
  auto* option = wired.app->add_option(short_name + "--" + flag.name, wired.values[flag.name]);
  option->check(CLI::Validator([flag](std::string& text) { return complaint(flag, text); }, ""));
  if (flag.required && flag.unless.empty()) option->required();
}

// Checks flags that are required unless another one is given (Flag::unless), and flags that need another (Flag::with).
void check_required(const Wired& wired) {
  // Looks values up here: CLI11's own search is noexcept and allocates, so where memory is short it ends the program.
  const auto given = [&](const std::string& other) {
    const auto value = wired.values.find(other);
    return value != wired.values.end() ? !value->second.empty() : wired.switches.at(other);
  };
  for (const Flag& flag : wired.command->flags) {
    if (given(flag.name) && !flag.with.empty() && !given(flag.with)) {
      throw CLI::RequiresError("--" + flag.name, "--" + flag.with);
    }
    if (!flag.required || flag.unless.empty() || given(flag.name)) continue;
    if (std::none_of(flag.unless.begin(), flag.unless.end(), given)) throw CLI::RequiredError("--" + flag.name);
  }
}

void add_positionals(Wired& wired) {
  wired.single.resize(wired.command->positionals.size());
  for (std::size_t k = 0; k < wired.command->positionals.size(); ++k) {
    const Positional& positional = wired.command->positionals[k];
    CLI::Option* option = positional.many ? wired.app->add_option(positional.name, wired.positionals)
                                          : wired.app->add_option(positional.name, wired.single[k]);
    option->check([](const std::string& text) { return text.empty() ? "is empty" : std::string(); });
    if (!positional.optional) option->required();
  }
}

CLI::App* subcommand(CLI::App& root, const std::string& name) {
  const std::size_t space = name.find(' ');
  if (space == std::string::npos) return root.add_subcommand(name);
  const std::string group = name.substr(0, space);
  const auto groups = root.get_subcommands([&](const CLI::App* app) { return app->get_name() == group; });
  CLI::App* parent = groups.empty() ? root.add_subcommand(group)->require_subcommand(1) : groups.front();
  return parent->add_subcommand(name.substr(space + 1));
}

void wire(CLI::App& root, Wired& wired) {
  wired.app = subcommand(root, wired.command->name);
  add_positionals(wired);
  for (const Flag& flag : wired.command->flags) add_flag(wired, flag);
  for (const Flag& flag : common_flags()) add_flag(wired, flag);
  wired.app->callback([&wired] { check_required(wired); });
}

Arguments arguments_of(const Wired& wired) {
  Arguments arguments;
  for (const Flag& flag : flags_of({wired.command->flags, common_flags()})) {
    if (flag.kind == Kind::kSwitch) {
      if (wired.switches.at(flag.name)) arguments.set(flag.name, "on");
    } else if (const std::string& given = wired.values.at(flag.name); !given.empty()) {
      arguments.set(flag.name, given);
    } else if (!flag.fallback.empty()) {
      arguments.set_default(flag.name, flag.fallback);
    }
  }
  std::vector<std::string> positionals;
  for (const std::string& value : wired.single) {
    if (!value.empty()) positionals.push_back(value);
  }
  positionals.insert(positionals.end(), wired.positionals.begin(), wired.positionals.end());
  arguments.set_positionals(std::move(positionals));
  return arguments;
}

int flush_output() {
  std::cout.flush();  // stream that CLI11 writes to
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return kDone;
  std::fputs("wisp: standard output cannot be written; the result is lost\n", stderr);
  return kBadData;
}

int run_command(const Wired& wired) {
  Terminal terminal({wired.switches.at("json"), wired.switches.at("quiet")});
  const Arguments arguments = arguments_of(wired);
  auto outcome = check_outputs(*wired.command, arguments);
  if (outcome) outcome = wired.command->run(arguments, terminal);
  if (!outcome) {
    const std::string& message = outcome.error().message;
    terminal.fail(message);
    // An error that begins with a flag's name is about the flag's value, which passed the parser's check.
    return message.starts_with("--") ? kWrongUsage : kBadData;
  }
  terminal.finish();
  return flush_output();
}

// Returns the words before the first flag, joined.
std::string leading(const std::vector<std::string>& words) {
  const auto flag = std::find_if(words.begin(), words.end(), [](const auto& word) { return word.starts_with('-'); });
  return joined({words.begin(), flag}, " ");
}

// Returns the command or group of commands named by the first words.
std::string command_in(const std::vector<std::string>& words) {
  std::string name = leading(words);
  while (!name.empty() && !is_command(name) && !is_group(name)) name.erase(name.rfind(' ') + 1 ? name.rfind(' ') : 0);
  return name;
}

// Answers `wisp` without arguments and `wisp help WORDS`. Returns the exit status; empty for other arguments.
std::optional<int> answer_help(std::vector<std::string> words) {
  if (words.empty()) {
    std::fputs(first_steps().c_str(), stderr);
    return kWrongUsage;
  }
  if (words.front() != "help") return {};
  words.erase(words.begin());
  const std::string about = leading(words);
  if (const std::string wrong = about.empty() || is_group(about) ? "" : wrong_words(words); !wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return kWrongUsage;
  }
  std::fputs(help(about).c_str(), stdout);
  return flush_output();
}

int run_program(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (const auto answered = answer_help(words)) return *answered;
  CLI::App root("", "wisp");
  root.set_version_flag("-V,--version", "wisp " WISP_VERSION);
  root.require_subcommand(1);
  std::vector<std::unique_ptr<Wired>> all;
  for (const Command& command : commands()) {
    all.push_back(std::make_unique<Wired>());
    all.back()->command = &command;
    wire(root, *all.back());
  }
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(help(command_in(words)).c_str(), stdout);
    return flush_output();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return root.exit(error), flush_output();  // prints the version
    std::string wrong = wrong_words(words);
    if (wrong.empty()) wrong = std::string("wisp: ") + error.what() + "; more: wisp " + command_in(words) + " --help";
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return kWrongUsage;
  }
  for (const auto& wired : all) {
    if (wired->app->parsed()) return run_command(*wired);
  }
  return kWrongUsage;
}

}  // namespace
}  // namespace wisp::cli

int main(int argc, char** argv) {
  wisp::remove_pending_files_when_interrupted();
  try {
    return wisp::cli::run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("wisp: out of memory; give a smaller recording, or cut it with --range or --frames\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wisp: %s\n", error.what());
  }
  return wisp::cli::kBadData;
}
