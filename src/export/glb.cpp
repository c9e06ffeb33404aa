// glTF 2.0 Specification (ISO/IEC 12113:2022), sections 3.6 and 4.4.

#include "export/glb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace wisp::exporting {
namespace {

constexpr int kFloat = 5126, kShort = 5123, kVertices = 34962, kIndices = 34963;
constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

void append(std::vector<std::byte>& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(word >> shift & 0xff));
}

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

const char* name_of(Shape shape) {
  constexpr std::array kNames{"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kNames[static_cast<std::size_t>(shape) - 1];
}

}  // namespace

int Buffer::add(std::span<const float> values, Shape shape) {
  const auto width = static_cast<std::size_t>(shape);
  Accessor accessor{bytes_.size(), values.size() * 4, values.size() / width, shape, 0, {}, {}};
  accessor.lowest.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
  accessor.highest = accessor.lowest;
  for (std::size_t k = 0; k < values.size(); ++k) {
    accessor.lowest[k % width] = std::min(accessor.lowest[k % width], values[k]);
    accessor.highest[k % width] = std::max(accessor.highest[k % width], values[k]);
    append(bytes_, std::bit_cast<std::uint32_t>(values[k]));
  }
  accessors_.push_back(std::move(accessor));
  return static_cast<int>(accessors_.size()) - 1;
}

int Buffer::add_vertices(std::span<const float> values, Shape shape) {
  const int index = add(values, shape);
  accessors_.back().target = kVertices;
  return index;
}

int Buffer::add_indices(std::span<const std::uint16_t> indices) {
  accessors_.push_back({bytes_.size(), indices.size() * 2, indices.size(), Shape::kScalar, kIndices, {}, {}});
  for (const std::uint16_t index : indices) {
    bytes_.push_back(static_cast<std::byte>(index & 0xff));
    bytes_.push_back(static_cast<std::byte>(index >> 8));
  }
  bytes_.resize(padded(bytes_.size()));
  return static_cast<int>(accessors_.size()) - 1;
}

void Buffer::describe(JsonText& json) const {
  json.list("accessors");
  for (std::size_t k = 0; k < accessors_.size(); ++k) {
    const Accessor& accessor = accessors_[k];
    json.object().value(k, "bufferView").value(accessor.target == kIndices ? kShort : kFloat, "componentType");
    json.value(accessor.count, "count").value(name_of(accessor.shape), "type");
    if (accessor.target != kIndices) json.values(accessor.lowest, "min").values(accessor.highest, "max");
    json.end();
  }
  json.end().list("bufferViews");
  for (const Accessor& accessor : accessors_) {
    json.object().value(0, "buffer").value(accessor.offset, "byteOffset").value(accessor.bytes, "byteLength");
    if (accessor.target != 0) json.value(accessor.target, "target");
    json.end();
  }
  json.end().list("buffers").object().value(bytes_.size(), "byteLength").end().end();
}

std::vector<std::byte> Buffer::file(std::string json) const {
  json.resize(padded(json.size()), ' ');
  std::vector<std::byte> out;
  append(out, kMagic);
  append(out, 2);
  append(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bytes_.size()));
  append(out, static_cast<std::uint32_t>(json.size()));
  append(out, kJsonChunk);
  const auto text = std::as_bytes(std::span(json));
  out.insert(out.end(), text.begin(), text.end());
  append(out, static_cast<std::uint32_t>(bytes_.size()));
  append(out, kBinaryChunk);
  out.insert(out.end(), bytes_.begin(), bytes_.end());
  return out;
}

}  // namespace wisp::exporting
