namespace wisp {
struct Track {
  int frames = 0;
};

int frames(const Track& track) { return track.frames; }
int seconds();
}  // namespace wisp

int main() { return wisp::frames({}) + wisp::seconds(); }
