#include "model/chain_payload.hpp"

#include <cstring>
#include <string>

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

}  // namespace

fb::Offset<file::Chain> write_chain(fb::FlatBufferBuilder& builder, const ChainModel& chain) {
  const FlatContexts contexts = flat(chain.contexts);
  const ChainSegments& segments = chain.segments;
  const auto mode = builder.CreateVector(segments.mode);
  const auto steps = builder.CreateVector(segments.steps);
  const auto rows = builder.CreateVector(segments.rows);
  const auto row_scale = builder.CreateVector(segments.row_scale);
  const auto rates = builder.CreateVector(segments.rates);
  const auto rate_scale = builder.CreateVector(segments.rate_scale);
  const auto follow = builder.CreateVector(segments.follow);
  const auto initial = builder.CreateVector(chain.initial);
  const auto lengths = builder.CreateVector(contexts.lengths);
  const auto histories = builder.CreateVector(contexts.modes);
  const auto probabilities = builder.CreateVector(contexts.probabilities);
  const auto gust = chain.gust ? write_gust(builder, *chain.gust) : fb::Offset<file::GustResponse>();
  file::ChainBuilder table(builder);
  table.add_motion(chain.motion == ChainMotion::kPose ? file::ChainMotion::Pose : file::ChainMotion::Position);
  table.add_heading_free(chain.heading_free);
  table.add_modes(static_cast<std::uint16_t>(chain.modes));
  table.add_segment_mode(mode);
  table.add_segment_steps(steps);
  table.add_rows(rows);
  table.add_row_scale(row_scale);
  table.add_rates(rates);
  table.add_rate_scale(rate_scale);
  table.add_follow(follow);
  table.add_breadth(static_cast<std::uint16_t>(segments.breadth));
  table.add_initial(initial);
  table.add_history_lengths(lengths);
  table.add_histories(histories);
  table.add_probabilities(probabilities);
  table.add_blend_share(chain.blend.share);
  table.add_blend_longest_steps(chain.blend.longest_steps);
  if (chain.gust) table.add_gust(gust);
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
  chain.segments = {copied(stored.segment_mode()), copied(stored.segment_steps()),
                    copied(stored.rows()),         copied(stored.row_scale()),
                    copied(stored.rates()),        copied(stored.rate_scale()),
                    copied(stored.follow()),       stored.breadth()};
  chain.initial = copied(stored.initial());
  auto contexts = contexts_of(
      {copied(stored.history_lengths()), copied(stored.histories()), copied(stored.probabilities())}, stored.modes());
  if (!contexts) return contexts.error();
  chain.contexts = std::move(*contexts);
  chain.blend = {stored.blend_share(), stored.blend_longest_steps()};
  if (stored.gust()) chain.gust = read_gust(*stored.gust());
  return chain;
}

}  // namespace wisp
