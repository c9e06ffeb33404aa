#include "wrong_words.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "command.hpp"

namespace wisp::cli {
namespace {

// Edit distance of two words (V. I. Levenshtein, 1966).
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

// Ends the sentence, with a suggestion where a word is near enough for a typing error.
std::string nearest(const std::string& word, const std::vector<std::string>& known, const std::string& before) {
  const auto nearer = [&](const std::string& a, const std::string& b) { return distance(word, a) < distance(word, b); };
  const auto best = std::min_element(known.begin(), known.end(), nearer);
  if (best == known.end() || distance(word, *best) > std::max<std::size_t>(1, word.size() / 3)) return ".";
  return "; did you mean " + before + *best + "?";
}

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

// Words allowed first, or second in commands of two words.
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

std::string wrong_command(std::span<const std::string> words) {
  const std::vector<std::string> second = next_words(words[0]);
  if (second.empty()) {
    const std::vector<std::string> first = next_words("");
    return "wisp: there is no command " + words[0] + nearest(words[0], first, "") + " There are: " + listed(first);
  }
  const std::string given = "wisp " + words[0];
  if (words.size() < 2 || words[1].starts_with('-')) return given + ": expected one of " + listed(second) + " after it";
  return given + ": there is no " + words[1] + nearest(words[1], second, words[0] + " ") +
         " There are: " + listed(second);
}

std::string wrong_flag(const Command& command, std::span<const std::string> words) {
  std::vector<std::string> known{"help", "version"};
  for (const Flag& flag : command.flags) known.push_back(flag.name);
  for (const Flag& flag : common_flags()) known.push_back(flag.name);
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
  if (words.empty() || words[0].starts_with('-')) return {};
  for (const Command& command : commands()) {
    const bool one = command.name == words[0];
    if (one || (words.size() > 1 && command.name == words[0] + " " + words[1])) {
      return wrong_flag(command, words.subspan(one ? 1 : 2));
    }
  }
  return wrong_command(words);
}

}  // namespace wisp::cli
