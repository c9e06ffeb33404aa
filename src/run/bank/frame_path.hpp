#pragma once
// The work of a frame for a range of blocks. frame_path.cpp is compiled once for every vector width that the machine
// may have (src/run/CMakeLists.txt); a bank chooses one width when it is created. All widths give the same bits.

#include <cstdint>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/run/bank.hpp"

// Hides the symbols of frame paths: the shared library would export them, as their names begin with wisp_.
#ifdef __ELF__
#define WISP_INSIDE __attribute__((visibility("hidden")))
#else
#define WISP_INSIDE
#endif

namespace wisp {

/// Consecutive steps of a bank, with the inputs and outputs of each.
struct Steps {
  int count = 1;
  const float* inputs = nullptr;  ///< per step one row for each slot; null: inputs stay as set
  float* outputs = nullptr;       ///< outputs after each step, in the same layout; null: not written
  bool show = true;               ///< whether the outputs of the last step are written to Bank::State::shown
};

/// Functions of one vector width. Every width has its own types State and Steps, of equal layout, passed as void*.
struct FramePath {
  const char* width;
  void (*set_inputs)(void* state, const float* values);
  void (*set_common_inputs)(void* state, const float* values);
  /// Makes the Steps `made` of blocks first … last − 1 and, with Steps::show, their readable outputs while the blocks
  /// are in the cache. Returns the number of instance-steps in which an output was clamped.
  std::uint64_t (*step)(void* state, int first, int last, const void* made);
  void (*show)(void* state, int first, int last);
  void (*polylines)(const void* state, float* values);
};

/// Returns the frame paths that this machine can run, the narrowest first.
std::span<const FramePath* const> frame_paths();

/// Returns the widest frame path, or the one that the environment variable WISP_WIDTH names (ignored in a build with
/// one path). Errors: WISP_WIDTH names none of them.
Result<const FramePath*> choose_frame_path();

}  // namespace wisp
