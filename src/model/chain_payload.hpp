#pragma once
// A segment chain as a table of the model file, and back.

#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"
#include "wisp_generated.h"

namespace wisp {

wisp_flatbuffers::Offset<file::Chain> write_chain(wisp_flatbuffers::FlatBufferBuilder& builder,
                                                  const ChainModel& chain);

/// Errors: an enumeration that this program does not know, or probabilities whose number does not fit the histories.
Result<ChainModel> read_chain(const file::Chain& stored);

}  // namespace wisp
