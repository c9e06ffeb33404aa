#include "flags/order_flags.hpp"

#include <charconv>

#include "wisp/learn/arx_orders.hpp"

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
  constexpr int kMost = 4096;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  int value = -1;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < 0 || value > kMost) {
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
      {"coupling",
       Kind::kChoice,
       "C",
       "full",
       "which outputs appear in an output's equation: full, diagonal, band",
       {"full", "diagonal", "band"}},
  };
}

Result<OrderMatrix> parse_orders(const std::string& text, int rows, int columns, const std::string& flag) {
  const auto row_texts = split(text, ';');
  if (row_texts.size() == 1 && text.find(',') == std::string::npos) {
    const auto order = parse_order(text, flag);
    if (!order) return order.error();
    return OrderMatrix(rows, columns, *order);
  }
  const auto shape = std::to_string(rows) + " × " + std::to_string(columns);
  if (row_texts.size() != static_cast<std::size_t>(rows)) {
    return Error{"--" + flag + " has " + std::to_string(row_texts.size()) + " rows, expected " + shape +
                 " for these outputs and inputs"};
  }
  OrderMatrix matrix(rows, columns);
  for (int i = 0; i < rows; ++i) {
    const auto cells = split(row_texts[i], ',');
    if (cells.size() != static_cast<std::size_t>(columns)) {
      return Error{"--" + flag + ", row " + std::to_string(i + 1) + ", has " + std::to_string(cells.size()) +
                   " entries, expected " + shape};
    }
    for (int j = 0; j < columns; ++j) {
      const auto order = parse_order(cells[j], flag);
      if (!order) return order.error();
      matrix(i, j) = *order;
    }
  }
  return matrix;
}

Result<ArxOrders> orders_from(const Arguments& arguments, int outputs, int inputs) {
  auto na = parse_orders(arguments.text("na"), outputs, outputs, "na");
  if (!na) return na.error();
  auto nb = parse_orders(arguments.text("nb"), outputs, inputs, "nb");
  if (!nb) return nb.error();
  // Delays to be found in the data are 0 until then.
  const std::string& delay = arguments.text("nk");
  auto nk = parse_orders(delay == "auto" ? "0" : delay, outputs, inputs, "nk");
  if (!nk) return nk.error();
  const std::string& word = arguments.text("coupling");
  const Coupling coupling = word == "diagonal" ? Coupling::kDiagonal
                            : word == "band"   ? Coupling::kBand
                                               : Coupling::kFull;
  const ArxOrders mask =
      make_orders({.outputs = outputs, .inputs = inputs, .na = 1, .nb = 1, .nk = 0, .coupling = coupling});
  for (int i = 0; i < outputs; ++i) {
    for (int j = 0; j < outputs; ++j) {
      if (mask.na(i, j) == 0) (*na)(i, j) = 0;
    }
  }
  return ArxOrders{std::move(*na), std::move(*nb), std::move(*nk)};
}

}  // namespace wisp::cli
