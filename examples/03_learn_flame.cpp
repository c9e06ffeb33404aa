// Learns a flame from a film of a candle: what `wisp learn flame CLIP -o MODEL` does.
#include <filesystem>
#include <iostream>
#include <wisp/learn.hpp>

static int fail(const wisp::Error& error) {
  std::cerr << error.message << '\n';
  return 1;
}

int main(int count, char** words) {
  if (count != 3) return fail({"usage: 03_learn_flame CLIP MODEL.wisp"});
  const auto clip = wisp::capture(words[1], wisp::FlameCapture{});
  if (!clip) return fail(clip.error());
  std::cout << clip->report;  // how sure the outline is
  wisp::FlameRecipe recipe;
  recipe.name = std::filesystem::path(words[2]).stem().string();
  const auto fit = wisp::learn(clip->recording, recipe);
  if (!fit) return fail(fit.error());
  std::cout << fit->report;
  const auto written = wisp::write_model(words[2], fit->model);
  return written ? 0 : fail(written.error());
}
