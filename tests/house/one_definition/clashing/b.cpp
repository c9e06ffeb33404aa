// Takes a name that a.cpp has taken. The two never meet in one source; the linker sees both.

namespace wisp {
struct Track {
  double values[3] = {0, 0, 0};
};

int first(const Track& track) { return static_cast<int>(track.values[0]); }
int seconds() { return first({}); }
}  // namespace wisp
