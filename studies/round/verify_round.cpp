// Flames in the round against what is true (docs/studies/round.md):
//   film PREFIX …              film_round.cpp
//   nothing                    drawn bodies of known motion, filmed, captured and joined
//   geometry RINGS.csv TRUTH.csv FIRST   a joined recording against the rig's axis and radii
//   symmetry RINGS.csv         coefficients of their own for x and z against shared ones
//   lean MODEL.wisp RINGS.csv  free run of a model along a recording's wind against the recorded lean
// Exit status 1 where a bound is missed.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "film_round.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"

namespace {

using namespace wisp;
using verify::value_or_abort;

constexpr double kPixelsPerMm = 7.5, kBaseMm = 1.8;  // the captured base lies so much above the rim

const std::vector<double>& samples(const Recording& recording, const std::string& name) {
  const auto channel = find_channel(recording, name);
  if (!channel) std::fprintf(stderr, "%s: has no %s\n", recording.source.c_str(), name.c_str()), std::exit(2);
  return recording.channels[*channel].samples;
}

std::size_t rings_of(const Recording& recording) {
  std::size_t count = 0;
  while (find_channel(recording, "ring" + std::to_string(count) + ".r")) ++count;
  return count;
}

int lean(const char* model_path, const char* rings_path) {
  Model model = value_or_abort(in_the_round(value_or_abort(read_model(model_path))));
  const Recording recording = value_or_abort(read_csv(rings_path));
  const auto &wx = samples(recording, "wind.x"), &wz = samples(recording, "wind.z");
  const double scale = std::atof(model.inputs[0].unit.c_str());
  const double pixels = std::get<OutlineView>(model.view).pixels_per_unit;
  const std::string top = "ring" + std::to_string(rings_of(recording) - 1);
  const auto &x = samples(recording, top + ".x"), &z = samples(recording, top + ".z");
  const auto &x0 = samples(recording, "ring0.x"), &z0 = samples(recording, "ring0.z");

  Bank bank = value_or_abort(Bank::create(model, {.capacity = 1}));
  const InstanceId id = bank.spawn(0);
  bank.set_noise(0);
  std::vector<float> seen(model.outputs.size());
  // The lean of the innermost control points over the base, from a level camera's side.
  const auto leans = [&](float right_x, float right_z) {
    bank.body()->look(right_x, right_z);
    bank.outputs(id, seen);
    const std::size_t n = seen.size() / 2, inner = (n - 1) / 2;
    return static_cast<double>(seen[2 * inner] + seen[2 * (n - 1 - inner)] - seen[0] - seen[2 * (n - 1)]) / 2;
  };
  double left = 0, all = 0;
  std::size_t rows = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const float wind[] = {static_cast<float>(wx[row] / scale), static_cast<float>(wz[row] / scale)};
    bank.set_common_inputs(wind);
    bank.step();
    const double dx = (x[row] - x0[row]) / pixels, dz = (z[row] - z0[row]) / pixels;
    if (std::isnan(dx + dz)) continue;
    left += std::pow(dx - leans(1, 0), 2) + std::pow(dz - leans(0, 1), 2);
    all += dx * dx + dz * dz;
    ++rows;
  }
  std::printf(
      "%s on %s: %zu rows, lean %.1f %% of the height (root mean square), followed by %.1f %% of its power, %.1f %% of "
      "it\n",
      model_path, rings_path, rows, 100 * std::sqrt(all / static_cast<double>(rows)), 100 * (1 - left / all),
      100 * (1 - std::sqrt(left / all)));
  return 0;
}

int geometry(const char* rings_path, const char* truth_path, std::size_t first) {
  const Recording recording = value_or_abort(read_csv(rings_path)), truth = value_or_abort(read_csv(truth_path));
  const auto& tall = samples(truth, "height");
  double axis = 0, radius = 0, height = 0, count = 0, ratio = 0;
  for (std::size_t row = 0; row < recording.rows() && first + row < truth.rows(); ++row) {
    const auto mark = [&](std::size_t k, const char* part) {
      return samples(truth, "p" + std::to_string(k) + part)[first + row];
    };
    for (std::size_t m = 1; m < 5; ++m) {
      const auto cut = cut_at(recording, row, (mark(m, ".y") - kBaseMm) * kPixelsPerMm);
      if (!cut || std::isnan(mark(m, ".x"))) continue;
      axis += std::pow(cut->x / kPixelsPerMm - mark(m, ".x"), 2) + std::pow(cut->z / kPixelsPerMm - mark(m, ".z"), 2);
      radius += std::pow(cut->radius / kPixelsPerMm - mark(m, ".r"), 2);
      ratio += cut->radius / kPixelsPerMm / mark(m, ".r");
      height += tall[first + row];
      count += 1;
    }
  }
  height /= count;
  std::printf("%s: axis off by %.2f %% of the height, radius by %.2f %% (ratio %.2f), root mean square\n", rings_path,
              100 * std::sqrt(axis / count) / height, 100 * std::sqrt(radius / count) / height, ratio / count);
  return std::sqrt(axis / count) <= 0.03 * height ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "film" && count > 2) return film_round(count - 1, words + 1);
  if (what == "geometry" && count > 4)
    return geometry(words[2], words[3], static_cast<std::size_t>(std::atoi(words[4])));
  if (what == "lean" && count > 3) return lean(words[2], words[3]);
  if (what == "symmetry" && count > 2) return symmetry(value_or_abort(read_csv(words[2])));
  if (what.empty()) return drawn_bodies();
  std::fprintf(stderr,
               "expected film PREFIX, geometry RINGS.csv TRUTH.csv FIRST, lean MODEL.wisp RINGS.csv, "
               "symmetry RINGS.csv, or nothing\n");
  return 2;
}
