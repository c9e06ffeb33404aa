#include "reports/arx_learning.hpp"

#include <algorithm>
#include <cmath>

#include "flags/order_flags.hpp"
#include "flags/recordings.hpp"
#include "reports/arx_parts.hpp"
#include "reports/arx_search.hpp"
#include "reports/arx_tables.hpp"
#include "reports/coloured_learning.hpp"
#include "reports/curve_learning.hpp"
#include "wisp/learn/order_search.hpp"

namespace wisp::cli {
namespace {

ArxOffset offset_of(const Arguments& arguments) {
  if (arguments.text("offset") == "none") return ArxOffset::kNone;
  return arguments.text("offset") == "estimate" ? ArxOffset::kEstimate : ArxOffset::kMean;
}

// Unit, lowest and highest of a channel over all recordings.
ChannelSpan span_of(const std::string& name, const std::vector<Recording>& recordings) {
  ChannelSpan span;
  bool first = true;
  for (const Recording& recording : recordings) {
    const auto& found = recording.channels[*find_channel(recording, name)];
    span.unit = found.unit;
    for (double sample : found.samples) {
      if (std::isnan(sample)) continue;
      span.lowest = first ? sample : std::min(span.lowest, sample);
      span.highest = first ? sample : std::max(span.highest, sample);
      first = false;
    }
  }
  return span;
}

ArxSources sources_of(const std::vector<Recording>& recordings, const ChannelChoice& channels) {
  ArxSources sources{recordings.front().rate_hz, {}, {}};
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) sources.spans.push_back(span_of(name, recordings));
  }
  for (const Recording& recording : recordings) sources.files.push_back(recording.source);
  return sources;
}

Result<std::vector<Recording>> ranged(const std::vector<Recording>& whole, const Arguments& arguments) {
  std::vector<Recording> parts;
  for (const Recording& recording : whole) {
    auto part = in_range(recording, arguments, "range");
    if (!part) return part.error();
    parts.push_back(std::move(*part));
  }
  return parts;
}

ArxOptions fit_options(const Arguments& arguments) {
  ArxOptions options;
  options.offset = offset_of(arguments);
  options.ridge = arguments.number("ridge");
  options.covariance = arguments.has("figures");  // for the bands
  options.stabilise = !arguments.on("keep-unstable");
  options.stability_margin = 1 - arguments.number("radius");
  return options;
}

// Whether the recordings are to be read a stretch at a time. A search needs them in memory, and so do curves.
bool too_large(const Arguments& arguments) {
  constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;
  const auto most = static_cast<std::uintmax_t>(arguments.integer("memory")) * kMebibyte;
  return !arguments.has("search") && curve_knots_of(arguments) == 0 && bytes_on_disk(arguments.positionals()) > most;
}

Result<LearnedArx> learn_from_large_tables(const Arguments& arguments, Terminal& terminal) {
  auto learned = fit_of_tables(arguments, fit_options(arguments), terminal);
  if (!learned) return learned.error();
  const TriangularFactor& factor = learned->factor;
  return LearnedArx{std::move(learned->fit),
                    factor.options().channels,
                    {factor.rate_hz(), factor.spans(), std::move(learned->paths)}};
}

// From the flags: as they are, with delays found in the data, or the best of a search.
Result<ChosenOrders> orders_of(const std::vector<Recording>& recordings, const std::vector<Recording>& whole,
                               const ChannelChoice& channels, const Arguments& arguments, Terminal& terminal) {
  if (arguments.has("search")) return search_arx_orders(recordings, whole, channels, arguments, terminal);
  auto orders =
      orders_from(arguments, static_cast<int>(channels.outputs.size()), static_cast<int>(channels.inputs.size()));
  if (!orders) return orders.error();
  if (arguments.text("nk") != "auto") return ChosenOrders{std::move(*orders)};
  auto delays = estimate_delays(recordings, channels, {.offset = offset_of(arguments)});
  if (!delays) return delays.error();
  orders->nk = std::move(*delays);
  for (int i = 0; i < orders->outputs(); ++i) {
    for (int k = 0; k < orders->inputs(); ++k) {
      terminal.say("delay of " + channels.inputs[k] + " to " + channels.outputs[i] + ": " +
                   std::to_string(orders->nk(i, k)) + (orders->nk(i, k) == 1 ? " sample" : " samples"));
    }
  }
  return ChosenOrders{std::move(*orders)};
}

Result<LearnedArx> learn_from_recordings(const Arguments& arguments, Terminal& terminal) {
  const auto whole = read_tables(arguments.positionals(), arguments, terminal);
  if (!whole) return whole.error();
  const auto recordings = ranged(*whole, arguments);
  if (!recordings) return recordings.error();
  const ChannelChoice channels{arguments.names("inputs"), arguments.names("outputs")};
  auto chosen = orders_of(*recordings, *whole, channels, arguments, terminal);
  if (!chosen) return chosen.error();
  ArxOptions options = fit_options(arguments);
  options.orders = std::move(chosen->orders);
  options.first_sample = chosen->first_sample;
  const auto noise = parse_noise_model(arguments.text("noise-model"));
  if (!noise) return noise.error();
  auto curves = learn_arx_curves(*recordings, channels, options.orders, arguments, terminal);
  if (!curves) return curves.error();
  const auto bent = bent_recordings(*recordings, channels.inputs, *curves);
  auto fit = noise->colour == NoiseColour::kWhite
                 ? fit_arx(bent, channels, options)
                 : fit_coloured(bent, channels, {.orders = options.orders, .noise = *noise}, terminal);
  if (!fit) return fit.error();
  LearnedArx learned{std::move(*fit), channels, sources_of(*recordings, channels)};
  learned.sources.curves = std::move(*curves);
  const auto tests = test_residuals(learned.fit.model, bent, channels, {.lags = 20, .learned_from_it = true});
  if (tests) learned.tests = *tests;
  return learned;
}

Result<LearnedArx> learn_from_parts(const Arguments& arguments, Terminal& terminal) {
  const auto factor = merged_parts(arguments);
  if (!factor) return factor.error();
  auto fit = factor->finish(fit_options(arguments));
  if (!fit) return fit.error();
  terminal.say("free simulation was not judged: parts hold no rows to simulate; wisp validate does it on a recording");
  const ArxSources sources{factor->rate_hz(), factor->spans(), arguments.positionals()};
  return LearnedArx{std::move(*fit), factor->options().channels, sources};
}

}  // namespace

Result<LearnedArx> learn_arx(const Arguments& arguments, Terminal& terminal) {
  if (arguments.on("merge")) return learn_from_parts(arguments, terminal);
  if (too_large(arguments)) return learn_from_large_tables(arguments, terminal);
  return learn_from_recordings(arguments, terminal);
}

}  // namespace wisp::cli
