// Learns an ARX model of a hair dryer from a table. The command that does the same:
//
//   wisp learn arx TABLE -o MODEL --inputs u1 --outputs y1 --dt 0.08 --na 2 --nb 2 --nk 3
#include <filesystem>
#include <iostream>
#include <wisp/learn.hpp>

static int fail(const wisp::Error& error) {
  std::cerr << error.message << '\n';
  return 1;
}

int main(int count, char** words) {
  if (count != 3) return fail({"usage: 02_learn_arx TABLE.csv MODEL.wisp"});
  const auto table = wisp::read_csv(words[1], {.rate_hz = 1 / 0.08, .inputs = {"u1"}, .outputs = {"y1"}});
  if (!table) return fail(table.error());
  const auto name = std::filesystem::path(words[2]).stem().string();
  const wisp::ArxRecipe recipe{.name = name, .inputs = {"u1"}, .outputs = {"y1"}, .na = 2, .nb = 2, .nk = 3};
  const auto fit = wisp::learn(*table, recipe);
  if (!fit) return fail(fit.error());
  std::cout << fit->report;  // the verdict first, then coefficients, figures and tables
  const auto written = wisp::write_model(words[2], fit->model);
  return written ? 0 : fail(written.error());
}
