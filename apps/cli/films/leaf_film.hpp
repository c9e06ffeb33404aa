#pragma once
// Renders a recording of poses as a video of leaves that fall to the floor.

#include <filesystem>
#include <span>
#include <string>

#include "terminal.hpp"
#include "wisp/draw/leaf.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

struct LeafFilmOptions {
  int width = 1280;  ///< pixels
  int height = 720;
  double max_seconds = 20;    ///< length of the video
  int max_leaves = 7;         ///< number of episodes shown at once
  float fall_metres = 1.45F;  ///< height of a fall; a longer episode is shown as several falls
  LeafStyle style{};
};

/// Checks a film's name before long work. Errors: it does not end in .mp4; its folder is missing or not writable.
Result<void> check_film_name(const std::string& path);

/// Draws the recording's episodes, one leaf each, and encodes them atomically.
/// Errors: the recording has no outputs `pos.x pos.y pos.z q.w q.x q.y q.z`, or the video cannot be written.
Result<void> write_leaf_film(const std::filesystem::path& path, const Recording& recording,
                             const LeafFilmOptions& options, Terminal& terminal);

struct LeafPanel {
  const Recording* recording = nullptr;
  std::string caption{};  ///< empty: none
};

/// Writes a film of one recording, or of several side by side, in equal shares of the width and each with at most 3/5
/// of max_leaves. Errors: as write_leaf_film(); rates that differ. Precondition: !panels.empty().
Result<void> write_leaf_films(const std::filesystem::path& path, std::span<const LeafPanel> panels,
                              const LeafFilmOptions& options, Terminal& terminal);

}  // namespace wisp::cli
