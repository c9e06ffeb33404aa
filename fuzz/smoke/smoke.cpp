// Runs a fuzzer's target over its seeds and over INPUTS changed seeds, the same ones every time, with any compiler.
// script/fuzz searches for longer.
//
//   smoke FOLDER-OF-SEEDS INPUTS

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> seeds_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> seeds;
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return seeds;
}

// A seed with a few bytes changed, taken out, put in twice or cut off.
Bytes changed(Bytes bytes, std::mt19937& random) {
  for (std::uint32_t k = 1 + random() % 4; k > 0 && !bytes.empty(); --k) {
    const std::size_t at = random() % bytes.size();
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random() % 6) {
      case 0:
        bytes.erase(place,
                    place + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size() - at, 1 + random() % 8)));
        break;
      case 1: {
        const Bytes piece(place, place + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size() - at, 16)));
        bytes.insert(place, piece.begin(), piece.end());
        break;
      }
      case 2:
        if (random() % 4 == 0) bytes.resize(at);
        break;
      case 3: {
        constexpr std::uint8_t kEnds[] = {0, 1, 0x7f, 0x80, 0xff};
        bytes[at] = kEnds[random() % std::size(kEnds)];
        break;
      }
      default:
        bytes[at] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::vector<Bytes> seeds = seeds_in(argv[1]);
  if (seeds.empty()) {
    std::fprintf(stderr, "no seeds in %s\n", argv[1]);
    return 2;
  }
  for (const Bytes& seed : seeds) LLVMFuzzerTestOneInput(seed.data(), seed.size());
  std::mt19937 random(1);
  const int inputs = std::atoi(argv[2]);
  for (int k = 0; k < inputs; ++k) {
    const Bytes bytes = changed(seeds[random() % seeds.size()], random);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%zu seeds, %d inputs made of them\n", seeds.size(), inputs);
}
