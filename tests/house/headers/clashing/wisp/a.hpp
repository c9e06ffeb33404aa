#pragma once

namespace wisp {
struct Track {
  int frames = 0;
};
}  // namespace wisp
