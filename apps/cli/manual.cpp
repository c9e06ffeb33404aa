// The program's manual, generated from the table of commands: help, docs/reference/cli.md, man page, completion.

#include <algorithm>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include "command.hpp"

namespace wisp::cli {
namespace {

constexpr std::size_t kLineWidth = 100;  // width of a line of help, characters
constexpr std::size_t kColumn = 26;      // column at which explanations begin

std::string usage(const Command& command) {
  std::string line = "wisp " + command.name;
  for (const Positional& positional : command.positionals) {
    const std::string name = positional.name + (positional.many ? "…" : "");
    line += positional.optional ? " [" + name + "]" : " " + name;
  }
  return line + " [flags]";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string dashes(const Flag& flag) { return flag.name == "output" ? "-o, --output" : "--" + flag.name; }

std::string flag_row(const Flag& flag) {
  const std::string value = flag.value.empty() ? "" : " " + flag.value;
  return "| `" + dashes(flag) + replaced(value, "|", "\\|") + "` | " +
         (flag.fallback.empty() ? "" : "`" + flag.fallback + "`") + " | " + replaced(help_of(flag), "|", "\\|") +
         " |\n";
}

std::string section(const Command& command) {
  std::string text = "## wisp " + command.name + "\n\n" + command.summary + "\n\n    " + usage(command) + "\n\n";
  for (const Positional& positional : command.positionals)
    text += "- `" + positional.name + "`: " + positional.help + "\n";
  if (!command.positionals.empty()) text += "\n";
  if (!command.flags.empty()) {
    text += "| flag | default | meaning |\n| --- | --- | --- |\n";
    for (const Flag& flag : command.flags) text += flag_row(flag);
    text += "\n";
  }
  for (const Example& example : command.examples) text += example.what + ":\n\n    " + example.line + "\n\n";
  return text;
}

// Returns the number of characters of UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// Formats an entry with a word or flag on the left and its meaning on the right, in lines of kLineWidth.
std::string entry(const std::string& left, const std::string& right) {
  std::string line = "  " + left, text;
  if (width_of(line) + 2 > kColumn) {
    text = line + "\n";
    line.clear();
  }
  line += std::string(kColumn - width_of(line), ' ');
  std::istringstream words(right);
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && width_of(line) + 1 + width_of(word) > kLineWidth) {
      text += line + "\n";
      line = std::string(kColumn, ' ');
      first = true;
    }
    line += (first ? "" : " ") + word;
  }
  return text + line + "\n";
}

std::string flag_entry(const Flag& flag) {
  std::string help = help_of(flag);
  if (!flag.fallback.empty()) help += " [" + flag.fallback + "]";
  if (flag.required) help += flag.unless.empty() ? " (required)" : " (required unless --" + flag.unless.front() + ")";
  return entry(dashes(flag) + (flag.value.empty() ? "" : " " + flag.value), help);
}

std::string help_of(const Command& command) {
  std::string text = entry("", command.summary).substr(kColumn);
  text = replaced(text, "\n" + std::string(kColumn, ' '), "\n") + "\nUsage: " + usage(command) + "\n";
  for (const Positional& positional : command.positionals) text += entry(positional.name, positional.help);
  text += "\nFlags:\n";
  for (const Flag& flag : flags_of({command.flags, common_flags()})) text += flag_entry(flag);
  text += entry("-h, --help", "print this");
  if (!command.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : command.examples) text += "  " + example.line + "\n      " + example.what + "\n";
  return text;
}

bool begins_with(const Command& command, const std::string& words) {
  return command.name == words || command.name.starts_with(words + " ");
}

// Escapes text for troff.
std::string troff(const std::string& text) {
  const std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  return safe.starts_with('.') || safe.starts_with('\'') ? "\\&" + safe : safe;
}

std::string man_page() {
  std::string text =
      ".TH WISP 1\n.SH NAME\nwisp \\- learns how a thing behaves from recordings, and plays it live\n"
      ".SH SYNOPSIS\n.B wisp\nCOMMAND [flags]\n.SH COMMANDS\n";
  for (const Command& command : commands()) {
    text += ".SS " + troff(usage(command)) + "\n" + troff(command.summary) + "\n";
    for (const Flag& flag : command.flags) {
      text += ".TP\n.B " + troff(dashes(flag) + " " + flag.value) + "\n" + troff(help_of(flag)) + "\n";
    }
    for (const Example& example : command.examples)
      text += ".PP\n" + troff(example.what) + ":\n.RS\n" + troff(example.line) + "\n.RE\n";
  }
  text += ".SH EXIT STATUS\n0 done, 1 the data or a file was bad, 2 wrong usage.\n";
  return text;
}

// Returns the first words of all commands; if `first` is not empty, the second words of commands that begin with it.
std::vector<std::string> next_words(const std::string& first) {
  std::vector<std::string> words;
  for (const Command& command : commands()) {
    const std::size_t space = command.name.find(' ');
    if (first.empty()) {
      words.push_back(command.name.substr(0, space));
    } else if (command.name.substr(0, space) == first && space != std::string::npos) {
      words.push_back(command.name.substr(space + 1));
    }
  }
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

std::string bash_completion() {
  std::string text =
      "_wisp() {\n  local now=${COMP_WORDS[COMP_CWORD]} line=\"${COMP_WORDS[*]:1} \" words=\n"
      "  case $line in\n";
  std::string groups;
  for (const std::string& word : next_words("")) {
    const std::vector<std::string> second = next_words(word);
    if (!second.empty()) groups += "    " + word + ") words='" + joined(second, " ") + " ' ;;\n";
  }
  for (const Command& command : commands()) {
    text += "    '" + command.name + " '*) words='";
    for (const Flag& flag : flags_of({command.flags, common_flags()})) text += "--" + flag.name + " ";
    text += "--help' ;;\n";
  }
  text += "  esac\n  if [ \"$COMP_CWORD\" = 1 ]; then words='";
  text += "help " + joined(next_words(""), " ") +
          " --help --version'; fi\n  if [ \"$COMP_CWORD\" = 2 ]; then case ${COMP_WORDS[1]} in\n" + groups +
          "  esac; fi\n"
          "  COMPREPLY=($(compgen -W \"$words\" -- \"$now\"))\n"
          "  case $now in -*) ;; *) [ -n \"${COMPREPLY[*]}\" ] && [ \"$COMP_CWORD\" -lt 3 ] ||\n"
          "    COMPREPLY=($(compgen -f -- \"$now\")) ;; esac\n}\n"
          "complete -o filenames -F _wisp wisp\n";
  return text;
}

std::string fish_completion() {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
  };
  std::string text;
  for (const Command& command : commands()) {
    const std::size_t space = command.name.find(' ');
    const std::string first = command.name.substr(0, space);
    std::string seen = "__fish_seen_subcommand_from " + first;
    if (space == std::string::npos) {
      text += "complete -c wisp -n __fish_use_subcommand -a " + first + " -d " + quoted(command.summary) + "\n";
    } else {
      const std::string second = command.name.substr(space + 1);
      text += "complete -c wisp -n __fish_use_subcommand -a " + first + "\ncomplete -c wisp -n " + quoted(seen) +
              " -a " + second + " -d " + quoted(command.summary) + "\n";
      seen += "; and __fish_seen_subcommand_from " + second;
    }
    for (const Flag& flag : flags_of({command.flags, common_flags()})) {
      text += "complete -c wisp -n " + quoted(seen) + " -l " + flag.name + (flag.kind == Kind::kSwitch ? "" : " -r") +
              " -d " + quoted(flag.help) + "\n";
    }
  }
  return text;
}

std::string markdown() {
  std::string text =
      "# The command line\n\n"
      "This page is printed by `wisp manual`; the program's help and parser are made from the same table. `wisp manual "
      "man` prints a man page; `wisp manual bash`, `zsh` and `fish` print what completes commands and flags in a "
      "shell, to be read at its start: `source <(wisp manual bash)`, `source <(wisp manual zsh)`, `wisp manual fish | "
      "source`.\n\n"
      "Exit status: 0 done, 1 the data or a file was bad (one line on standard error says which, where, what was "
      "found, what was expected and what to do), 2 wrong usage. Output files appear whole or not at all. Sample and "
      "frame ranges are 1-based and inclusive; indices in JSON are 0-based.\n\n"
      "Every command also takes:\n\n| flag | default | meaning |\n| --- | --- | --- |\n";
  for (const Flag& flag : common_flags()) text += flag_row(flag);
  text += "| `--help` |  | print this command's help |\n\n";
  for (const Command& command : commands()) text += section(command);
  text.pop_back();
  return text;
}

}  // namespace

std::optional<std::string> manual(const std::string& form) {
  if (form == "markdown") return markdown();
  if (form == "man") return man_page();
  if (form == "bash") return bash_completion();
  if (form == "zsh")
    return "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n" + bash_completion();
  if (form == "fish") return fish_completion();
  return {};
}

std::string first_steps() {
  return "Wisp learns how a thing behaves from recordings of it and plays that behaviour live.\n\n"
         "To begin with:\n" +
         entry("wisp demo", "a simulated candle, filmed, learned, judged and played, in out/demo (minutes)") +
         entry("wisp demo candle.mp4", "the same from a film of your own") +
         entry("wisp play", "a flame that is learned already, live in a window") +
         entry("wisp help", "all commands; wisp help learn arx: one of them");
}

std::string help(const std::string& words) {
  std::vector<const Command*> meant;
  for (const Command& command : commands()) {
    if (!words.empty() && begins_with(command, words)) meant.push_back(&command);
  }
  if (meant.size() == 1 && meant.front()->name == words) return help_of(*meant.front());
  std::string text = first_steps() + "\nUsage: wisp COMMAND [flags]\n\n";
  if (meant.empty()) {
    for (const Command& command : commands()) meant.push_back(&command);
  } else {
    text = "Usage: wisp " + words + " …\n\n";
  }
  for (const Command* command : meant) text += entry(command->name, command->summary);
  return text + "\nwisp COMMAND --help explains one; wisp --version says which version this is.\n";
}

namespace {

// Returns the edit distance of two words (V. I. Levenshtein, 1966).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

// Returns the end of an error message: a suggestion if a known word differs by few letters, else a full stop.
std::string nearest(const std::string& word, const std::vector<std::string>& known, const std::string& before) {
  const auto nearer = [&](const std::string& a, const std::string& b) { return distance(word, a) < distance(word, b); };
  const auto best = std::min_element(known.begin(), known.end(), nearer);
  if (best == known.end() || distance(word, *best) > std::max<std::size_t>(1, word.size() / 3)) return ".";
  return "; did you mean " + before + *best + "?";
}

std::string wrong_command(std::span<const std::string> words) {
  const std::vector<std::string> second = next_words(words[0]);
  if (second.empty()) {
    const std::vector<std::string> first = next_words("");
    return "wisp: there is no command " + words[0] + nearest(words[0], first, "") +
           " There are: " + joined(first, ", ");
  }
  const std::string given = "wisp " + words[0];
  if (words.size() < 2 || words[1].starts_with('-'))
    return given + ": expected one of " + joined(second, ", ") + " after it";
  return given + ": there is no " + words[1] + nearest(words[1], second, words[0] + " ") +
         " There are: " + joined(second, ", ");
}

std::string wrong_flag(const Command& command, std::span<const std::string> words) {
  std::vector<std::string> known{"help", "version"};
  for (const Flag& flag : flags_of({command.flags, common_flags()})) known.push_back(flag.name);
  for (const std::string& word : words) {
    if (word == "--") break;
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(2, word.find('=') - 2);
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return "wisp " + command.name + ": there is no flag --" + name + nearest(name, known, "--") + " Its flags: wisp " +
           command.name + " --help";
  }
  return {};
}

}  // namespace

std::string wrong_words(std::span<const std::string> words) {
  if (words.empty()) return {};
  if (words[0].starts_with('-')) return "wisp: found " + words[0] + ", expected a command before flags: wisp --help";
  for (const Command& command : commands()) {
    const bool one = command.name == words[0];
    if (one || (words.size() > 1 && command.name == words[0] + " " + words[1])) {
      return wrong_flag(command, words.subspan(one ? 1 : 2));
    }
  }
  return wrong_command(words);
}

}  // namespace wisp::cli
