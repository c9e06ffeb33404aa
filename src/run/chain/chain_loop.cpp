#include "wisp/run/chain_facet.hpp"

#include <map>
#include <utility>
#include <vector>

#include "run/chain/chain_lane.hpp"
#include "wisp/model/file.hpp"

namespace wisp {

std::optional<ChainLoop> chain_loop(const Model& model) {
  const auto* chain = std::get_if<ChainModel>(&model.dynamics);
  if (!chain || !check(model)) return {};
  Arena measured;
  make_chain_program(*chain, model.rate_hz, 1, measured);
  std::vector<std::byte> memory(measured.bytes());
  Arena arena(memory);
  const ChainProgram program = make_chain_program(*chain, model.rate_hz, 1, arena);
  ChainChoice choice;
  choice.set_chance(false);
  const ChainMover<float> mover(program);
  float state = 0;
  std::uint32_t segment = 0;
  std::map<std::pair<float, std::uint32_t>, std::size_t> seen;  // by what it remembers and plays
  std::vector<double> began;                                    // seconds, per segment
  double now = 0;
  for (bool begins = true;; begins = false) {
    segment = begins ? mover.draw_first(state, choice, {}) : mover.draw(state, segment, choice, {});
    const auto [before, fresh] = seen.try_emplace({state, segment}, began.size());
    if (!fresh) {
      const std::size_t lead = before->second;
      return ChainLoop{lead, began.size() - lead, began[lead], now - began[lead]};
    }
    began.push_back(now);
    now += program.steps(segment) / model.rate_hz;
  }
}

}  // namespace wisp
