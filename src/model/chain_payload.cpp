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

}  // namespace

fb::Offset<file::Chain> write_chain(fb::FlatBufferBuilder& builder, const ChainModel& chain) {
  const ChainSegments& segments = chain.segments;
  const auto mode = builder.CreateVector(segments.mode);
  const auto steps = builder.CreateVector(segments.steps);
  const auto packed = builder.CreateVector(packed_segments(chain));
  const auto row_scale = builder.CreateVector(segments.row_scale);
  const auto rate_scale = builder.CreateVector(segments.rate_scale);
  const auto follow = builder.CreateVector(packed_successors(chain));
  const bool bounded = !segments.height.empty();
  const auto height = bounded ? builder.CreateVector(segments.height) : 0;
  const auto initial = builder.CreateVector(chain.initial);
  const auto probabilities = builder.CreateVector(chain.probabilities);
  const auto gust = chain.gust ? write_gust(builder, *chain.gust) : fb::Offset<file::GustResponse>();
  const auto drift = chain.drift ? write_drift(builder, *chain.drift) : fb::Offset<file::ChainDrift>();
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
  table.add_history(static_cast<std::uint8_t>(chain.history));
  table.add_probabilities(probabilities);
  table.add_blend_steps(static_cast<std::uint16_t>(chain.blend_steps));
  if (chain.gust) table.add_gust(gust);
  if (chain.drift) table.add_drift(drift);
  if (bounded) {
    table.add_height(height);
    table.add_height_scale(segments.height_scale);
  }
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
                    copied(stored.height()),
                    stored.height_scale()};
  chain.initial = copied(stored.initial());
  chain.history = stored.history();
  chain.probabilities = copied(stored.probabilities());
  chain.blend_steps = stored.blend_steps();
  if (stored.gust()) chain.gust = read_gust(*stored.gust());
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
