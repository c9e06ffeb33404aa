#include "wisp/learn/validate.hpp"

#include "learn/arx/learn_arx.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/markov/learn_markov.hpp"
#include "learn/same_rate.hpp"

namespace wisp {
Result<Report> validate(const Model& model, const Recording& recording, const ValidationOptions& options,
                        const Progress& progress) {
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return validate_chain(model, std::span(&recording, 1), options.seed, progress);
  }
  const bool outline = std::holds_alternative<OutlineView>(model.view);
  if (!outline) {
    if (auto ok = check_rate(model, recording); !ok) return ok.error();
  }
  if (std::holds_alternative<SwitchedArxModel>(model.dynamics)) {
    return validate_switched(model, recording, options, progress);
  }
  if (!outline) return validate_arx(model, recording, options, progress);
  auto validated = validate_outline(model, recording, options, progress);
  if (!validated) return validated.error();
  return std::move(validated->report);
}

Result<Report> validate(const Model& model, std::span<const Recording> recordings, const ValidationOptions& options,
                        const Progress& progress) {
  if (recordings.empty()) return Error{model.name + ": there is no recording to validate it on"};
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return validate_chain(model, recordings, options.seed, progress);
  }
  if (recordings.size() == 1) return validate(model, recordings.front(), options, progress);
  return Error{recordings[1].source + ": is one recording too many, expected a single one for a model of this kind"};
}

}  // namespace wisp
