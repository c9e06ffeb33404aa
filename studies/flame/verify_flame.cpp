// The learned flame on simulated clips that learning has not seen, over several seeds: what follows the wind, what does
// not, and which of the choices that there are is better. Prints tables; exit status 1 where a bound is missed.
//
//   wisp_verify_flame                the tables
//   wisp_verify_flame DIR [ASKED…]   what each piece of a model is worth, on other clips, kept in DIR
//                                    (flame_corpus.hpp); studies/fidelity/fidelity.py DIR/pieces makes the table
//   wisp_verify_flame DIR REC…       the same for the flicker of captured flames, in DIR/flicker
//
// ASKED: --gusts, without calm and blow-outs; --only NAME, of pieces; --clips NAME, one of fresh (the default),
// other-fresh, tuning, second-tuning, third-tuning, each in a folder of its own.

#include "studies/flame/verify_flame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "learn/fidelity/fidelity_distance.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "learn/outline/outline_units.hpp"
#include "studies/flame/verify_flame_pieces.hpp"
#include "studies/value_or_abort.hpp"
#include "studies/verify_bounds.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::verify {
namespace {

constexpr double kLearnSeconds = 40;
constexpr double kValidateSeconds = 20;
constexpr std::uint64_t kLearnSeeds[] = {1, 5, 7};
constexpr std::uint64_t kValidateSeeds[] = {2, 3, 6};

struct Clips {
  std::vector<FlameClip> learn;
  std::vector<FlameClip> validate;
};

/// What is compared: an input and how it is learned from.
struct Way {
  const char* name;
  bool truth = false;
  WindMeasure measure = WindMeasure::kSpeed;
  OutlineRecipe options{};
  bool fidelity = false;
};

/// A way's figures on one pair of clips.
struct Score {
  double tip = 0;
  double overlap = 0;
  double j1 = 0;
  double j_free = 0;
  double energy = 0;
  double floor = 0;
  double ceiling = 0;
  std::int64_t multiply_adds = 0;
};

Recording driven(const FlameClip& clip, const Way& way) {
  return way.truth ? driven_by_truth(clip) : driven_by_sound(clip, way.measure);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double spread(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0;
  for (double value : values) sum += (value - middle) * (value - middle);
  return values.size() < 2 ? 0 : std::sqrt(sum / static_cast<double>(values.size() - 1));
}

Score score_of(const OutlineFit& fit, const Recording& unseen, bool fidelity) {
  const auto found = value_or_abort(judge_outline(fit.model, unseen, {.fidelity = fidelity}));
  const OutlineFigures& figures = found.figures;
  Score score;
  score.tip = figures.tip_fit_percent.back();
  score.overlap = figures.overlap.back();
  score.j1 = figures.j.front();
  score.j_free = figures.j.back();
  score.multiply_adds = value_or_abort(count_operations(fit.model)).multiply_adds_per_frame;
  if (found.fidelity) {
    score.energy = found.fidelity->energy_distance.value;
    score.floor = found.fidelity->energy_distance.floor;
    score.ceiling = found.fidelity->energy_distance.ceiling;
  }
  return score;
}

std::vector<double> all(const std::vector<Score>& scores, double Score::*figure) {
  std::vector<double> values;
  for (const Score& score : scores) values.push_back(score.*figure);
  return values;
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Every model on every clip that it has not seen.
std::vector<Score> try_way(const Way& way, const Clips& clips) {
  std::vector<Score> scores;
  for (const FlameClip& seen : clips.learn) {
    const auto fit = value_or_abort(fit_outline(std::vector{driven(seen, way)}, way.options));
    for (const FlameClip& unseen : clips.validate) {
      scores.push_back(score_of(fit, driven(unseen, way), way.fidelity));
    }
  }
  const auto tips = all(scores, &Score::tip);
  std::printf("  %-30s %5.1f ± %3.1f  %5.1f   %.3f   %.4f  %.4f   %lld\n", way.name, mean(tips), spread(tips),
              least(tips), mean(all(scores, &Score::overlap)), mean(all(scores, &Score::j1)),
              mean(all(scores, &Score::j_free)), static_cast<long long>(scores.front().multiply_adds));
  return scores;
}

void header() {
  std::printf(
      "  mean over %zu models × %zu unseen clips   tip's fit, %% (least)  overlap  J_1     J_inf    "
      "multiply-adds\n",
      std::size(kLearnSeeds), std::size(kValidateSeeds));
}

/// Of a figure, the mean difference pair by pair and its spread.
void differ(const char* what, const std::vector<Score>& a, const std::vector<Score>& b) {
  std::vector<double> tips;
  std::vector<double> j;
  for (std::size_t k = 0; k < a.size(); ++k) {
    tips.push_back(a[k].tip - b[k].tip);
    j.push_back(100 * (a[k].j_free / b[k].j_free - 1));
  }
  std::printf("  %-46s tip's fit %+5.1f points (%+.1f to %+.1f), J_inf %+5.1f %% (%+.1f to %+.1f)\n", what, mean(tips),
              least(tips), most(tips), mean(j), least(j), most(j));
}

void bound(const std::vector<Score>& sound, const std::vector<Score>& truth, Bounds& bounds) {
  std::printf("\n");
  bounds.at_least("tip's fit from sound, %, mean", mean(all(sound, &Score::tip)), 60);
  bounds.at_least("tip's fit from sound, %, least", least(all(sound, &Score::tip)), 60);
  bounds.at_least("tip's fit from the true wind, %, mean", mean(all(truth, &Score::tip)), 70);
  bounds.at_least("overlap, least", least(all(sound, &Score::overlap)), 0.75);
  bounds.at_most("normalised energy distance, most", most(all(sound, &Score::energy)), 0.05);
  std::printf("          energy distance %.4f, floor %.4f, ceiling %.4f (means)\n", mean(all(sound, &Score::energy)),
              mean(all(sound, &Score::floor)), mean(all(sound, &Score::ceiling)));
}

Clips simulate_all() {
  Clips clips;
  double simulated = 0;
  double taken = 0;
  std::vector<double> knots;
  const auto add = [&](std::vector<FlameClip>& to, double seconds, std::uint64_t seed) {
    to.push_back(make_flame_clip(seconds, seed, knots));
    // All clips in the first one's knots, as `wisp learn` captures them.
    if (knots.empty()) knots = value_or_abort(outline_layout(to.front().outline)).knots;
    simulated += seconds;
    taken += to.back().processor_seconds;
  };
  for (std::uint64_t seed : kLearnSeeds) add(clips.learn, kLearnSeconds, seed);
  for (std::uint64_t seed : kValidateSeeds) add(clips.validate, kValidateSeconds, seed);
  std::printf("== The learned flame on simulated candles (%.0f s of film in %.0f s of one processor)\n", simulated,
              taken);
  return clips;
}

FlameSeeds seeds_called(const std::string& name) {
  if (name == "fresh") return FlameSeeds::kFresh;
  if (name == "other-fresh") return FlameSeeds::kOtherFresh;
  if (name == "tuning") return FlameSeeds::kTuning;
  if (name == "second-tuning") return FlameSeeds::kSecondTuning;
  if (name == "third-tuning") return FlameSeeds::kThirdTuning;
  std::fprintf(stderr, "there are no clips called %s\n", name.c_str());
  std::exit(2);
}

/// Takes what is asked out of the arguments; recordings stay.
PieceQuestion taken_question(std::vector<char*>& arguments) {
  PieceQuestion question;
  std::vector<char*> rest;
  for (auto at = arguments.begin(); at != arguments.end(); ++at) {
    const std::string word = *at;
    if (word == "--gusts") {
      question.gusts_alone = true;
    } else if (word == "--only" && at + 1 != arguments.end()) {
      question.names.emplace_back(*++at);
    } else if (word == "--clips" && at + 1 != arguments.end()) {
      question.seeds = seeds_called(*++at);
    } else {
      rest.push_back(*at);
    }
  }
  arguments = rest;
  return question;
}

void judge_pieces(std::vector<char*> arguments) {
  const std::filesystem::path folder = arguments.front();
  arguments.erase(arguments.begin());
  const PieceQuestion question = taken_question(arguments);
  if (arguments.empty()) judge_flame_pieces(folder, question);
  judge_flicker_pieces(folder, arguments);
}

}  // namespace
}  // namespace wisp::verify

int main(int count, char** arguments) {
  using namespace wisp;
  using namespace wisp::verify;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table's row appears when it is known
  if (count > 1) {
    judge_pieces({arguments + 1, arguments + count});
    return 0;
  }
  const Clips clips = simulate_all();
  header();
  const auto sound = try_way({.name = "as it is: speed", .fidelity = true}, clips);
  const auto truth = try_way({.name = "true wind", .truth = true}, clips);
  const auto heard = try_way({.name = "speed, other sounds too", .measure = WindMeasure::kHeard}, clips);
  const auto rms = try_way({.name = "plain RMS", .measure = WindMeasure::kRms}, clips);
  const auto paper = try_way({.name = "the paper's points", .options = {.paper = 4}}, clips);
  try_way({.name = "the paper's points, plain RMS", .measure = WindMeasure::kRms, .options = {.paper = 4}}, clips);

  std::printf("\nPair by pair (least to most)\n");
  differ("components over points", sound, paper);
  differ("speed over plain RMS", sound, rms);
  differ("speed over speed with other sounds", sound, heard);
  differ("the true wind over sound", truth, sound);
  Bounds bounds;
  bound(sound, truth, bounds);
  std::printf("\n%s\n", bounds.missed() == 0 ? "all bounds held" : "bounds were missed");
  return bounds.missed() == 0 ? 0 : 1;
}
