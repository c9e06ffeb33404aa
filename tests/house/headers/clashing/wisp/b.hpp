#pragma once
// Takes a name that a.hpp has taken. Each header compiles alone; no source can include both.

namespace wisp {
struct Track {
  double seconds = 0;
};
}  // namespace wisp
