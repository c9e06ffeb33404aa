// A host that plays a model and has a FlatBuffers of its own. Prints a checksum of every output bit, so that what the
// host's own flags change would show, and what its own FlatBuffers holds, so that a clash would.

#include <bit>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "flatbuffers/flatbuffers.h"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace {

std::uint64_t play(wisp::Bank& bank) {
  bank.spawn();
  std::vector<float> outputs(static_cast<std::size_t>(bank.output_count()));
  std::uint64_t checksum = 1469598103934665603u;
  for (int step = 0; step < 1000; ++step) {
    bank.step();
    bank.outputs(outputs);
    for (const float value : outputs) checksum = (checksum ^ std::bit_cast<std::uint32_t>(value)) * 1099511628211u;
  }
  return checksum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto model = wisp::read_model(argv[1]);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message.c_str());
    return 1;
  }
  auto bank = wisp::Bank::create(*model);
  if (!bank) {
    std::fprintf(stderr, "%s\n", bank.error().message.c_str());
    return 1;
  }
  const flatbuffers::FlatBufferBuilder builder;
  const auto bytes = wisp::model_bytes(*model);
  std::printf("checksum %016llx, %s, host's FlatBuffers %d holds %zu\n", static_cast<unsigned long long>(play(*bank)),
              bytes ? "written again" : "not written", FLATBUFFERS_VERSION_MAJOR, builder.GetSize());
  return bytes && builder.GetSize() == 7 ? 0 : 1;
}
