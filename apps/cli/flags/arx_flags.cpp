#include "flags/arx_flags.hpp"

#include <charconv>
#include <cstdlib>

namespace wisp::cli {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

Result<int> parse_order(std::string_view text, const std::string& flag) {
  constexpr int kMax = 4096;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  int value = -1;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < 0 || value > kMax) {
    return Error{"--" + flag + ": found \"" + std::string(text) + "\", expected a whole number from 0 to 4096"};
  }
  return value;
}

}  // namespace

std::vector<Flag> order_flags(const OrderHelp& help) {
  const std::string a = "order of A" + std::string(help.of_a);
  return {
      {"na", Kind::kText, "N", help.fallback, a + ": a number, or a matrix row by row such as '4,2;3,4'"},
      {"nb", Kind::kText, "N", help.fallback,
       "order of B: a number, or a matrix with a row an output and a column an input"},
      {"nk", Kind::kText, "N", "1", "delay in samples, likewise" + std::string(help.delay)},
  };
}

Result<OrderChoice> order_choice(const Arguments& arguments, const std::string& flag) {
  const std::string& text = arguments.text(flag);
  const auto row_texts = split(text, ';');
  if (row_texts.size() == 1 && text.find(',') == std::string::npos) {
    const auto order = parse_order(text, flag);
    if (!order) return order.error();
    return OrderChoice(*order);
  }
  const auto count = [&](const char* names) { return arguments.has(names) ? arguments.names(names).size() : 0; };
  const std::size_t rows = count("outputs"), columns = count(flag == "na" ? "outputs" : "inputs");
  const auto shape = std::to_string(rows) + " × " + std::to_string(columns);
  if (row_texts.size() != rows) {
    return Error{"--" + flag + " has " + std::to_string(row_texts.size()) + " rows, expected " + shape +
                 " for these outputs and inputs"};
  }
  OrderMatrix matrix(static_cast<int>(rows), static_cast<int>(columns));
  for (int i = 0; i < matrix.rows(); ++i) {
    const auto cells = split(row_texts[static_cast<std::size_t>(i)], ',');
    if (cells.size() != columns) {
      return Error{"--" + flag + ", row " + std::to_string(i + 1) + ", has " + std::to_string(cells.size()) +
                   " entries, expected " + shape};
    }
    for (int j = 0; j < matrix.columns(); ++j) {
      const auto order = parse_order(cells[static_cast<std::size_t>(j)], flag);
      if (!order) return order.error();
      matrix(i, j) = *order;
    }
  }
  return OrderChoice(std::move(matrix));
}

Result<std::vector<int>> steps_in(const Arguments& arguments) {
  std::vector<int> steps;
  for (const std::string& word : arguments.names("steps")) {
    const bool whole = word.find_first_not_of("0123456789") == std::string::npos;
    steps.push_back(word == "inf" ? kFreeRun : std::atoi(word.c_str()));
    if (word == "inf" || (whole && steps.back() >= 1 && steps.back() <= 100000)) continue;
    return Error{"--steps: found \"" + word + "\", expected numbers from 1 to 100000, or inf, separated by commas"};
  }
  return steps;
}

Flag initial_flag() {
  return {"initial",
          Kind::kChoice,
          "STATE",
          "measured",
          "where free simulation of a plain model starts: from measured samples, from rest (zero), or from what fits "
          "best",
          {"measured", "zero", "estimated"}};
}

}  // namespace wisp::cli
