// docs/reference/cli.md from the table of commands.

#include "command.hpp"

namespace wisp::cli {
namespace {

std::string usage(const Command& command) {
  std::string line = "wisp " + command.name;
  for (const Positional& positional : command.positionals) {
    const std::string name = positional.name + (positional.many ? "…" : "");
    line += positional.optional ? " [" + name + "]" : " " + name;
  }
  return line + " [flags]";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string flag_row(const Flag& flag) {
  const std::string dashes = flag.name == "output" ? "-o, --output" : "--" + flag.name;
  const std::string value = flag.value.empty() ? "" : " " + flag.value;
  return "| `" + dashes + escaped(value) + "` | " + (flag.fallback.empty() ? "" : "`" + flag.fallback + "`") + " | " +
         escaped(help_of(flag)) + " |\n";
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

}  // namespace

std::string manual() {
  std::string text =
      "# The command line\n\n"
      "This page is printed by `wisp manual`; the program's help and parser are made from the same table.\n\n"
      "Exit status: 0 done, 1 the data or a file was bad (one line on standard error says which, where, what was "
      "found, "
      "what was expected and what to do), 2 wrong usage. Output files appear whole or not at all. Sample and frame "
      "ranges "
      "are 1-based and inclusive; indices in JSON are 0-based.\n\n"
      "Every command also takes:\n\n| flag | default | meaning |\n| --- | --- | --- |\n";
  for (const Flag& flag : common_flags()) text += flag_row(flag);
  text += "| `--help` |  | print this command's help |\n\n";
  for (const Command& command : commands()) text += section(command);
  text.pop_back();
  return text;
}

}  // namespace wisp::cli
