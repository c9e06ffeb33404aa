// A host that reads a model and has a FlatBuffers of its own: prints both, so that a clash shows.

#include <cstdio>

#include "flatbuffers/flatbuffers.h"
#include "wisp/model/file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto model = wisp::read_model(argv[1]);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message.c_str());
    return 1;
  }
  const auto bytes = wisp::model_bytes(*model);
  const flatbuffers::FlatBufferBuilder builder;
  std::printf("model %zu outputs, %s; host's FlatBuffers %d, %zu\n", model->outputs.size(),
              bytes ? "written again" : "not written", FLATBUFFERS_VERSION_MAJOR, builder.GetSize());
  return bytes && builder.GetSize() == 7 ? 0 : 1;
}
