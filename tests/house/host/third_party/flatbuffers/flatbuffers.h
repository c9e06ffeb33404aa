#pragma once
// The host's own FlatBuffers: the same names as everyone's, another version's insides.

#include <cstddef>

#define FLATBUFFERS_VERSION_MAJOR 99

namespace flatbuffers {

class FlatBufferBuilder {
 public:
  explicit FlatBufferBuilder(std::size_t initial_size = 7) : size_(initial_size) {}
  std::size_t GetSize() const { return size_; }

 private:
  std::size_t size_;
};

class Verifier {
 public:
  bool VerifyAlignment(std::size_t) const { return false; }
};

}  // namespace flatbuffers
