#pragma once
// The numbers of a glTF file: buffer views and accessors over one binary chunk.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.hpp"

namespace wisp::exporting {

/// How many numbers make one value.
enum class Shape { kScalar = 1, kVector2 = 2, kVector3 = 3, kVector4 = 4 };

class Buffer {
 public:
  /// Adds numbers; returns the index of their accessor.
  int add(std::span<const float> values, Shape shape);
  /// Adds an attribute of vertices.
  int add_vertices(std::span<const float> values, Shape shape);
  /// Adds indices of vertices.
  int add_indices(std::span<const std::uint16_t> indices);

  /// Writes "accessors", "bufferViews" and "buffers" into an open object.
  void describe(JsonText& json) const;

  /// The whole file: header, `json` and the numbers.
  std::vector<std::byte> file(std::string json) const;

 private:
  struct Accessor {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::size_t count = 0;
    Shape shape = Shape::kScalar;
    int target = 0;  // what a graphics card keeps it for; 0: nothing
    std::vector<float> lowest, highest;
  };

  std::vector<Accessor> accessors_;
  std::vector<std::byte> bytes_;
};

}  // namespace wisp::exporting
