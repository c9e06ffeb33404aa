#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "run/bank/frame_path.hpp"

extern "C" WISP_INSIDE const wisp::FramePath wisp_frame_path;
#ifdef WISP_WIDE_PATHS
extern "C" WISP_INSIDE const wisp::FramePath wisp_frame_path_avx2;
#endif

namespace wisp {

#ifdef WISP_WIDE_PATHS

std::span<const FramePath* const> frame_paths() {
  static constexpr std::array kPaths{&wisp_frame_path, &wisp_frame_path_avx2};
  return std::span(kPaths).first(__builtin_cpu_supports("avx2") ? 2 : 1);
}

Result<const FramePath*> choose_frame_path() {
  const auto paths = frame_paths();
  const char* wanted = std::getenv("WISP_WIDTH");
  if (!wanted || !*wanted) return paths.back();
  std::string known;
  for (const FramePath* path : paths) {
    if (std::string_view(wanted) == path->width) return path;
    known += (known.empty() ? "" : ", ") + std::string(path->width);
  }
  return Error{"the environment variable WISP_WIDTH is '" + std::string(wanted) + "', this machine has " + known +
               ": set one of them or none"};
}

#else

std::span<const FramePath* const> frame_paths() {
  static constexpr const FramePath* kOnly[] = {&wisp_frame_path};
  return kOnly;
}

Result<const FramePath*> choose_frame_path() { return &wisp_frame_path; }

#endif

}  // namespace wisp
