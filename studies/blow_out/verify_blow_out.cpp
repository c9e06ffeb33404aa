// A flame that is blown out and lit again: a rule of extinction and recorded events of its size, on clips that it
// was not learned from.
//
//   wisp_verify_blow_out LEARNED.csv… -- UNSEEN.csv…
//
// The files are captures of clips such as `wisp simulate candle --puffs 5` makes. Prints a table of deaths and gusts
// that the rule gets right on the unseen clips, and how far the mean sizes of events are apart; exit status 1
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
  const auto events = recorded_events(evidence_of(seen, 0)), others = recorded_events(evidence_of(unseen, 0));
  if (!events || !others || events->catching.empty() || others->catching.empty()) {
    std::fprintf(stderr, "the clips have no death that is lit again\n");
    return 1;
  }
  const auto fit = learn_extinction(evidence_of(seen, events->vanishing_seconds));
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  const Extinction& rule = fit->rule;
  const double rate_hz = unseen.front().recording.rate_hz;
  const double dying = means_apart(events->dying, others->dying, rate_hz, 0);
  const double catching = means_apart(events->catching, others->catching, rate_hz, 1);
  const Extinction borrowed;
  const auto judged = agreement(rule, evidence_of(unseen, events->vanishing_seconds));
  std::printf(
      "learned from %zu deaths: level %.2f, %.3f s, haste %.1f, recovery %.2f s; still seen for %.3f s\n"
      "unseen: %zu of %zu deaths, %zu of %zu gusts, %.0f ms off; mean sizes apart at most: dying %.3f, catching %.3f "
      "(borrowed events %.3f, %.3f)\n\n",
      fit->agreement.deaths, rule.level, rule.seconds, rule.haste, rule.recovery, events->vanishing_seconds,
      judged.died, judged.deaths, judged.spared, judged.gusts, 1000 * judged.median_off(), dying, catching,
      means_apart(dying_of(borrowed, rate_hz), others->dying, rate_hz, 0),
      means_apart(catching_of(borrowed, rate_hz), others->catching, rate_hz, 1));
  verify::Bounds bounds;
  const auto share = [](std::size_t right, std::size_t of) {
    return static_cast<double>(right) / static_cast<double>(of);
  };
  bounds.at_least("share of unseen deaths that the rule gets right", share(judged.died, judged.deaths), 0.9);
  bounds.at_least("share of unseen gusts that it lets the flame come through", share(judged.spared, judged.gusts),
                  0.95);
  bounds.at_most("how far off in time its deaths are, median, s", judged.median_off(), 0.05);
  bounds.at_most("how far the mean size of catching is off", catching, 0.1);
  return bounds.missed() == 0 ? 0 : 1;
}
