// A flame that is blown out and lit again: a rule of extinction with decay and re-ignition as ramps, on clips that it
// was not learned from.
//
//   wisp_verify_blow_out LEARNED.csv… -- UNSEEN.csv…
//
// The files are captures of clips such as `wisp simulate candle --puffs 5` makes. Prints a table of deaths and gusts
// that the rule gets right on the unseen clips, and of the errors of its sizes in decay and re-ignition; exit status 1
// where a bound is missed.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "learn/flame/flame_sizes.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "studies/verify_bounds.hpp"
#include "wisp/record/csv.hpp"

namespace {

using namespace wisp;

struct Clip {
  Recording recording;
  std::vector<BlowOut> blow_outs;
  std::vector<double> sizes;
  double scale = 1;  // of its own microphone: a wind of 1 is the 95th percentile of the wind in which the flame burned
};

Clip clip_of(const std::string& path) {
  auto recording = read_csv(path);
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    std::exit(1);
  }
  Clip clip{*std::move(recording), {}, {}, 1};
  clip.blow_outs = *find_blow_outs(clip.recording, "wind");
  clip.sizes = *flame_sizes(clip.recording, clip.blow_outs);
  const Recording burning = without_blow_outs(clip.recording, clip.blow_outs);
  clip.scale = scaled_input(std::span(&burning, 1), "wind")->scale;
  return clip;
}

std::vector<ExtinctionEvidence> evidence_of(const std::vector<Clip>& clips, double decay) {
  std::vector<ExtinctionEvidence> out;
  for (const Clip& clip : clips) out.push_back({&clip.recording, "wind", clip.scale, clip.blow_outs, decay});
  return out;
}

std::vector<SizeCurve> curves_of(const std::vector<Clip>& clips, SizeChange change) {
  std::vector<SizeCurve> out;
  for (const Clip& clip : clips) {
    for (SizeCurve& curve : size_curves(clip.recording, clip.sizes, clip.blow_outs, change)) out.push_back(curve);
  }
  return out;
}

void print_row(const std::string& name, int died, int deaths, int spared, int gusts, double off_ms, double decay,
               double re_ignition) {
  std::printf("%-34s %3d of %-3d %3d of %-3d %6.0f %8.3f %8.3f\n", name.c_str(), died, deaths, spared, gusts, off_ms,
              decay, re_ignition);
}

}  // namespace

int main(int count, char** words) {
  std::vector<Clip> seen, unseen;
  bool after = false;
  for (int k = 1; k < count; ++k) {
    if (std::string(words[k]) == "--") {
      after = true;
      continue;
    }
    (after ? unseen : seen).push_back(clip_of(words[k]));
  }
  if (seen.empty() || unseen.empty()) {
    std::fprintf(stderr, "usage: wisp_verify_blow_out LEARNED.csv... -- UNSEEN.csv...\n");
    return 2;
  }
  const auto decay = learn_ramp(SizeChange::kDecay, curves_of(seen, SizeChange::kDecay));
  const auto re_ignition = learn_ramp(SizeChange::kReIgnition, curves_of(seen, SizeChange::kReIgnition));
  if (!decay || !re_ignition) {
    std::fprintf(stderr, "the clips to learn from have no death that is lit again\n");
    return 1;
  }
  const auto fit = learn_extinction(evidence_of(seen, decay->seconds));
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  const Extinction& rule = fit->rule;
  std::printf(
      "learned from %zu deaths: level %.2f, %.3f s, haste %.1f, recovery %.2f s; decay %.3f s (%.3f to %.3f), "
      "catching %.3f s (%.3f to %.3f)\n\n",
      fit->agreement.deaths, rule.level, rule.seconds, rule.haste, rule.recovery, decay->seconds,
      decay->seconds_ci95[0], decay->seconds_ci95[1], re_ignition->seconds, re_ignition->seconds_ci95[0],
      re_ignition->seconds_ci95[1]);
  std::printf("%-34s %10s %10s %6s %8s %8s\n", "unseen clips", "deaths", "gusts", "off ms", "dying", "catching");
  const auto judged = agreement(rule, evidence_of(unseen, decay->seconds));
  const auto decay_unseen = curves_of(unseen, SizeChange::kDecay),
             re_ignition_unseen = curves_of(unseen, SizeChange::kReIgnition);
  const auto rule_row = [&](const std::string& name, double out, double in) {
    print_row(name, static_cast<int>(judged.died), static_cast<int>(judged.deaths), static_cast<int>(judged.spared),
              static_cast<int>(judged.gusts), 1000 * judged.median_off(),
              ramp_error(SizeChange::kDecay, out, decay_unseen),
              ramp_error(SizeChange::kReIgnition, in, re_ignition_unseen));
  };
  rule_row("rule, ramps of the default", Extinction{}.decay, Extinction{}.re_ignition);
  rule_row("rule, ramps learned", decay->seconds, re_ignition->seconds);
  std::printf("\n");
  verify::Bounds bounds;
  const auto share = [](std::size_t right, std::size_t of) {
    return static_cast<double>(right) / static_cast<double>(of);
  };
  bounds.at_least("share of unseen deaths that the rule gets right", share(judged.died, judged.deaths), 0.9);
  bounds.at_least("share of unseen gusts that it lets the flame come through", share(judged.spared, judged.gusts),
                  0.95);
  bounds.at_most("how far off in time its deaths are, median, s", judged.median_off(), 0.05);
  bounds.at_most("how far a dying flame's size is off", ramp_error(SizeChange::kDecay, decay->seconds, decay_unseen),
                 0.1);
  bounds.at_most("how far a catching flame's size is off",
                 ramp_error(SizeChange::kReIgnition, re_ignition->seconds, re_ignition_unseen), 0.1);
  return bounds.missed() == 0 ? 0 : 1;
}
