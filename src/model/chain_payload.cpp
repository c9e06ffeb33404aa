#include "model/chain_payload.hpp"

#include <cstring>
#include <string>

#include "model/chain_rows.hpp"

namespace wisp {
namespace {

namespace fb = wisp_flatbuffers;

// The verifier bounds a vector but does not align its elements beyond 4 bytes, so they are copied out as bytes.
template <class Number>
std::vector<Number> copied(const fb::Vector<Number>* values) {
  std::vector<Number> out(values ? values->size() : 0);
  if (!out.empty()) std::memcpy(out.data(), values->Data(), out.size() * sizeof(Number));
  return out;
}

// All histories one after the other, and all their probabilities.
struct FlatContexts {
  std::vector<std::uint8_t> lengths;
  std::vector<std::uint16_t> modes;
  std::vector<double> probabilities;
};

FlatContexts flat(const std::vector<ChainContext>& contexts) {
  FlatContexts out;
  for (const ChainContext& context : contexts) {
    out.lengths.push_back(static_cast<std::uint8_t>(context.history.size()));
    out.modes.insert(out.modes.end(), context.history.begin(), context.history.end());
    out.probabilities.insert(out.probabilities.end(), context.probability.begin(), context.probability.end());
  }
  return out;
}

Result<std::vector<ChainContext>> contexts_of(const FlatContexts& stored, std::size_t modes) {
  std::size_t total = 0;
  for (std::uint8_t length : stored.lengths) total += length;
  if (stored.modes.size() != total || stored.probabilities.size() != stored.lengths.size() * modes) {
    return Error{"is damaged: its chain's histories and probabilities do not fit each other"};
  }
  std::vector<ChainContext> contexts;
  auto mode = stored.modes.begin();
  auto probability = stored.probabilities.begin();
  for (std::uint8_t length : stored.lengths) {
    contexts.push_back({{mode, mode + length}, {probability, probability + static_cast<long>(modes)}});
    mode += length;
    probability += static_cast<long>(modes);
  }
  return contexts;
}

std::vector<double> joined(const std::vector<double>& ground, const std::vector<double>& vertical) {
  std::vector<double> both = ground;
  both.insert(both.end(), vertical.begin(), vertical.end());
  return both;
}

fb::Offset<file::GustResponse> write_gust(fb::FlatBufferBuilder& builder, const GustResponse& gust) {
  const auto change = builder.CreateVector(joined(gust.ground.change, gust.vertical.change));
  const auto wind = builder.CreateVector(joined(gust.ground.wind, gust.vertical.wind));
  const auto press = builder.CreateVector(joined(gust.ground.press, gust.vertical.press));
  return file::CreateGustResponse(builder, change, wind, press);
}

GustResponse read_gust(const file::GustResponse& stored) {
  GustResponse gust;
  const auto split = [](const std::vector<double>& both, std::vector<double>& ground, std::vector<double>& vertical) {
    const auto middle = both.begin() + static_cast<long>(both.size() / 2);
    ground.assign(both.begin(), middle);
    vertical.assign(middle, both.end());
  };
  split(copied(stored.change()), gust.ground.change, gust.vertical.change);
  split(copied(stored.wind()), gust.ground.wind, gust.vertical.wind);
  split(copied(stored.press()), gust.ground.press, gust.vertical.press);
  return gust;
}

fb::Offset<file::ChainDrift> write_drift(fb::FlatBufferBuilder& builder, const ChainDrift& drift) {
  const auto lead = builder.CreateVector(drift.lead);
  const auto velocity = builder.CreateVector(std::vector<double>(drift.drift.begin(), drift.drift.end()));
  return file::CreateChainDrift(builder, lead, drift.lead_scale, velocity, drift.spread_ground, drift.spread_height,
                                drift.memory_seconds);
}

Result<ChainDrift> read_drift(const file::ChainDrift& stored) {
  const auto velocity = copied(stored.drift());
  if (velocity.size() != 3) return Error{"is damaged: its chain's drift has not three axes"};
  return ChainDrift{copied(stored.lead()),  stored.lead_scale(),    {velocity[0], velocity[1], velocity[2]},
                    stored.spread_ground(), stored.spread_height(), stored.memory_seconds()};
}

fb::Offset<file::ModeSystems> write_systems(fb::FlatBufferBuilder& builder, const ModeSystems& systems) {
  std::vector<double> coefficients, noise, ranges;
  std::vector<std::uint16_t> steps;
  for (const ModeSystem& mode : systems.modes) {
    coefficients.insert(coefficients.end(), mode.coefficient.begin(), mode.coefficient.end());
    noise.insert(noise.end(), mode.noise.begin(), mode.noise.end());
    ranges.insert(ranges.end(), mode.lowest.begin(), mode.lowest.end());
    ranges.insert(ranges.end(), mode.highest.begin(), mode.highest.end());
    steps.insert(steps.end(), mode.steps.begin(), mode.steps.end());
  }
  const auto all = builder.CreateVector(coefficients), shocks = builder.CreateVector(noise);
  const auto held = builder.CreateVector(ranges);
  return file::CreateModeSystems(builder, static_cast<std::uint8_t>(systems.degree), all, shocks, held,
                                 builder.CreateVector(steps));
}

Result<ModeSystems> read_systems(const file::ModeSystems& stored, std::size_t modes) {
  ModeSystems systems{stored.degree(), {}};
  const std::size_t terms = kSystemStates * system_terms(systems.degree);
  const auto coefficients = copied(stored.coefficients()), noise = copied(stored.noise());
  const auto ranges = copied(stored.ranges());
  const auto steps = copied(stored.steps());
  const std::size_t shocks = noise.empty() ? 0 : kSystemStates * kSystemStates;
  if (coefficients.size() != modes * terms || noise.size() != modes * shocks ||
      ranges.size() != modes * 2 * kSystemStates || steps.size() != modes * kSystemDurations) {
    return Error{"is damaged: the systems of its chain's modes do not fit each other"};
  }
  for (std::size_t k = 0; k < modes; ++k) {
    ModeSystem mode;
    const auto part = [k](const auto& all, std::size_t size) { return all.begin() + static_cast<long>(k * size); };
    mode.coefficient.assign(part(coefficients, terms), part(coefficients, terms) + static_cast<long>(terms));
    mode.noise.assign(part(noise, shocks), part(noise, shocks) + static_cast<long>(shocks));
    std::copy_n(part(ranges, 2 * kSystemStates), kSystemStates, mode.lowest.begin());
    std::copy_n(part(ranges, 2 * kSystemStates) + kSystemStates, kSystemStates, mode.highest.begin());
    std::copy_n(part(steps, kSystemDurations), kSystemDurations, mode.steps.begin());
    systems.modes.push_back(std::move(mode));
  }
  return systems;
}

fb::Offset<file::ModeSplines> write_splines(fb::FlatBufferBuilder& builder, const ModeSplines& splines) {
  const auto mean = builder.CreateVector(splines.mean), component = builder.CreateVector(splines.component);
  return file::CreateModeSplines(builder, static_cast<std::uint8_t>(splines.control_points),
                                 static_cast<std::uint8_t>(splines.components), mean, component,
                                 builder.CreateVector(splines.score));
}

// Takes the splines and makes the rows of them.
Result<void> read_splines(const file::ModeSplines& stored, ChainModel& chain) {
  ChainSegments& segments = chain.segments;
  chain.splines = ModeSplines{stored.control_points(), stored.components(), copied(stored.mean()),
                              copied(stored.component()), copied(stored.score())};
  const int channels = channel_count(chain.motion);
  if (auto ok = check(*chain.splines, segments, chain.modes, channels); !ok) return ok;
  segments.rows = rows_of(*chain.splines, segments, channels);
  return {};
}

}  // namespace

fb::Offset<file::Chain> write_chain(fb::FlatBufferBuilder& builder, const ChainModel& chain) {
  const FlatContexts contexts = flat(chain.contexts);
  const ChainSegments& segments = chain.segments;
  const auto mode = builder.CreateVector(segments.mode);
  const auto steps = builder.CreateVector(segments.steps);
  const auto packed = builder.CreateVector(packed_segments(chain));
  const auto row_scale = builder.CreateVector(segments.row_scale);
  const auto rate_scale = builder.CreateVector(segments.rate_scale);
  const auto follow = builder.CreateVector(packed_successors(chain));
  const bool leads_on = !segments.successor_weights.empty();
  const auto successor_weights = leads_on ? builder.CreateVector(segments.successor_weights) : 0;
  const auto initial = builder.CreateVector(chain.initial);
  const auto lengths = builder.CreateVector(contexts.lengths);
  const auto histories = builder.CreateVector(contexts.modes);
  const auto probabilities = builder.CreateVector(contexts.probabilities);
  const auto gust = chain.gust ? write_gust(builder, *chain.gust) : fb::Offset<file::GustResponse>();
  const auto drift = chain.drift ? write_drift(builder, *chain.drift) : fb::Offset<file::ChainDrift>();
  const auto systems = chain.systems ? write_systems(builder, *chain.systems) : fb::Offset<file::ModeSystems>();
  const auto splines = chain.splines ? write_splines(builder, *chain.splines) : fb::Offset<file::ModeSplines>();
  file::ChainBuilder table(builder);
  table.add_motion(chain.motion == ChainMotion::kPose ? file::ChainMotion::Pose : file::ChainMotion::Position);
  table.add_heading_free(chain.heading_free);
  table.add_modes(static_cast<std::uint16_t>(chain.modes));
  table.add_segment_mode(mode);
  table.add_segment_steps(steps);
  table.add_packed(packed);
  table.add_row_scale(row_scale);
  table.add_rate_scale(rate_scale);
  table.add_follow(follow);
  table.add_breadth(static_cast<std::uint16_t>(segments.breadth));
  table.add_initial(initial);
  table.add_history_lengths(lengths);
  table.add_histories(histories);
  table.add_probabilities(probabilities);
  table.add_blend_steps(static_cast<std::uint16_t>(chain.blend_steps));
  if (chain.gust) table.add_gust(gust);
  if (chain.drift) table.add_drift(drift);
  if (chain.systems) table.add_systems(systems);
  if (leads_on) table.add_successor_weights(successor_weights);
  if (chain.splines) table.add_splines(splines);
  return table.Finish();
}

Result<ChainModel> read_chain(const file::Chain& stored) {
  ChainModel chain;
  if (stored.motion() != file::ChainMotion::Position && stored.motion() != file::ChainMotion::Pose) {
    return Error{"has a chain of a kind of motion that this program does not know; update Wisp"};
  }
  chain.motion = stored.motion() == file::ChainMotion::Pose ? ChainMotion::kPose : ChainMotion::kPosition;
  chain.heading_free = stored.heading_free();
  chain.modes = stored.modes();
  chain.segments = {copied(stored.segment_mode()),
                    copied(stored.segment_steps()),
                    {},
                    copied(stored.row_scale()),
                    {},
                    copied(stored.rate_scale()),
                    {},
                    stored.breadth(),
                    copied(stored.successor_weights())};
  chain.initial = copied(stored.initial());
  auto contexts = contexts_of(
      {copied(stored.history_lengths()), copied(stored.histories()), copied(stored.probabilities())}, stored.modes());
  if (!contexts) return contexts.error();
  chain.contexts = std::move(*contexts);
  chain.blend_steps = stored.blend_steps();
  if (stored.gust()) chain.gust = read_gust(*stored.gust());
  if (stored.systems()) {
    auto systems = read_systems(*stored.systems(), stored.modes());
    if (!systems) return systems.error();
    chain.systems = std::move(*systems);
  }
  if (stored.splines()) {
    if (auto ok = read_splines(*stored.splines(), chain); !ok) return ok.error();
  }
  if (auto ok = unpack_successors(copied(stored.follow()), chain); !ok) return ok.error();
  if (auto ok = unpack_segments({stored.packed()->data(), stored.packed()->size()}, chain); !ok) return ok.error();
  if (stored.drift()) {
    auto drift = read_drift(*stored.drift());
    if (!drift) return drift.error();
    chain.drift = std::move(*drift);
  }
  return chain;
}

}  // namespace wisp
