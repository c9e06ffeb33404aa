// Recounts the operations that models need per frame and updates their files where the counts have changed:
// `wisp_recount_costs MODEL.wisp …`. The page shows the stored counts. The rest of a model's file does not change.

#include <cstdio>

#include "wisp/model/file.hpp"
#include "wisp/run/cost.hpp"

namespace {

using namespace wisp;

Result<void> recount(const char* path) {
  auto model = read_model(path);
  if (!model) return model.error();
  const auto cost = count_operations(*model);
  if (!cost) return cost.error();
  Training& made = model->training;
  if (made.multiply_adds_per_frame == cost->multiply_adds_per_frame &&
      made.operations_per_frame == cost->operations_per_frame)
    return {};
  std::printf("%s: %lld operations, was %lld\n", path, static_cast<long long>(cost->operations_per_frame),
              static_cast<long long>(made.operations_per_frame));
  made.multiply_adds_per_frame = cost->multiply_adds_per_frame;
  made.operations_per_frame = cost->operations_per_frame;
  return write_model(path, *model);
}

}  // namespace

int main(int count, char** paths) {
  for (int k = 1; k < count; ++k) {
    if (const auto ok = recount(paths[k]); !ok) {
      std::fprintf(stderr, "%s\n", ok.error().message.c_str());
      return 1;
    }
  }
  return 0;
}
