// A flame that is blown out and lit again: a rule of extinction and recorded events of its size, learned from each of
// some clips and judged on the others. A clip has some eight deaths, so that one rule alone says little.
//
//   wisp_verify_blow_out CLIP.csv CLIP.csv…
//
// The files are captures of clips such as `wisp simulate candle --puffs 5` makes. Prints the deaths and gusts that each
// rule gets right on the other clips, and how far the mean sizes of events are apart; exit status 1 where a bound is
// missed.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "learn/flame/extinction.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "studies/verify_bounds.hpp"
#include "wisp/record/csv.hpp"

namespace {

using namespace wisp;

struct Clip {
  Recording recording;
  std::vector<BlowOut> blow_outs;
  double scale = 1;  // of its own microphone: a wind of 1 is the 95th percentile of the wind in which the flame burned
};

Clip clip_of(const std::string& path) {
  auto recording = read_csv(path);
  if (!recording) {
    std::fprintf(stderr, "%s\n", recording.error().message.c_str());
    std::exit(1);
  }
  Clip clip{*std::move(recording), {}, 1};
  clip.blow_outs = *find_blow_outs(clip.recording, "wind");
  const Recording burning = without_blow_outs(clip.recording, clip.blow_outs);
  clip.scale = scaled_input(std::span(&burning, 1), "wind")->scale;
  return clip;
}

std::vector<ExtinctionEvidence> evidence_of(const std::vector<Clip>& clips, double vanishing) {
  std::vector<ExtinctionEvidence> out;
  for (const Clip& clip : clips) out.push_back({&clip.recording, "wind", clip.scale, clip.blow_outs, vanishing});
  return out;
}

// The mean size of a step of events that last as long; past an event's end it is `after`.
double mean_size(const FlameEvents& events, std::size_t step, double after) {
  double sum = 0;
  std::size_t begin = 0;
  for (const std::uint32_t end : events.ends) {
    sum += begin + step < end ? events.sizes[begin + step] / 255.0 : after;
    begin = end;
  }
  return sum / static_cast<double>(events.ends.size());
}

// The largest difference of mean sizes in a second.
double means_apart(const FlameEvents& a, const FlameEvents& b, double rate_hz, double after) {
  double most = 0;
  for (std::size_t step = 0; static_cast<double>(step) < rate_hz; ++step) {
    most = std::max(most, std::abs(mean_size(a, step, after) - mean_size(b, step, after)));
  }
  return most;
}

// Sums over the rules.
struct Totals {
  std::size_t deaths = 0, died = 0, gusts = 0, spared = 0;
  double off = 0, catching = 0;  // the largest of any rule
};

bool judge(const std::string& name, const Clip& seen, const std::vector<Clip>& unseen, Totals& totals) {
  const std::vector learned{seen};
  const auto events = recorded_events(evidence_of(learned, 0)), others = recorded_events(evidence_of(unseen, 0));
  if (!events || !others || events->catching.empty() || others->catching.empty()) {
    std::fprintf(stderr, "%s, or the others, have no death that is lit again\n", name.c_str());
    return false;
  }
  const auto fit = learn_extinction(evidence_of(learned, events->vanishing_seconds));
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return false;
  }
  const Extinction& rule = fit->rule;
  const double rate_hz = seen.recording.rate_hz;
  const double dying = means_apart(events->dying, others->dying, rate_hz, 0);
  const double catching = means_apart(events->catching, others->catching, rate_hz, 1);
  const Extinction borrowed;
  const auto judged = agreement(rule, evidence_of(unseen, events->vanishing_seconds));
  std::printf(
      "%s: learned from %zu deaths: level %.2f, %.3f s, haste %.1f, recovery %.2f s; still seen for %.3f s\n"
      "  unseen: %zu of %zu deaths, %zu of %zu gusts, %.0f ms off; mean sizes apart at most: dying %.3f, catching %.3f "
      "(borrowed events %.3f, %.3f)\n",
      name.c_str(), fit->agreement.deaths, rule.level, rule.seconds, rule.haste, rule.recovery,
      events->vanishing_seconds, judged.died, judged.deaths, judged.spared, judged.gusts, 1000 * judged.median_off(),
      dying, catching, means_apart(dying_of(borrowed, rate_hz), others->dying, rate_hz, 0),
      means_apart(catching_of(borrowed, rate_hz), others->catching, rate_hz, 1));
  totals.deaths += judged.deaths, totals.died += judged.died;
  totals.gusts += judged.gusts, totals.spared += judged.spared;
  totals.off = std::max(totals.off, judged.median_off());
  totals.catching = std::max(totals.catching, catching);
  return true;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "usage: wisp_verify_blow_out CLIP.csv CLIP.csv...\n");
    return 2;
  }
  std::vector<Clip> clips;
  for (int k = 1; k < count; ++k) clips.push_back(clip_of(words[k]));
  Totals totals;
  for (std::size_t k = 0; k < clips.size(); ++k) {
    std::vector<Clip> others = clips;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    if (!judge(words[k + 1], clips[k], others, totals)) return 1;
  }
  std::printf("all: %zu of %zu deaths, %zu of %zu gusts\n\n", totals.died, totals.deaths, totals.spared, totals.gusts);
  verify::Bounds bounds;
  const auto share = [](std::size_t right, std::size_t of) {
    return static_cast<double>(right) / static_cast<double>(of);
  };
  bounds.at_least("share of unseen deaths that the rules get right", share(totals.died, totals.deaths), 0.9);
  bounds.at_least("share of unseen gusts that they let the flame come through", share(totals.spared, totals.gusts),
                  0.95);
  bounds.at_most("how far off in time a rule's deaths are, median, s", totals.off, 0.05);
  bounds.at_most("how far the mean size of catching is off", totals.catching, 0.1);
  return bounds.missed() == 0 ? 0 : 1;
}
