// Binary glTF 2.0 (ISO/IEC 12113:2022) of bodies and outlines, with the extension KHR_materials_unlit.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

// The number of components of a value.
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
    int target = 0;  // glTF buffer target; 0: none
    std::vector<float> lowest, highest;
  };

  std::vector<Accessor> accessors_;
  std::vector<std::byte> bytes_;
};

// glTF 2.0 Specification (ISO/IEC 12113:2022), sections 3.6 and 4.4.

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

using namespace exporting;

// A mesh's accessors and properties.
struct Mesh {
  int positions = 0, normals = -1, coordinates = -1, indices = 0;
  std::vector<int> targets;
  std::vector<double> lowest, highest;  // outputs at which a target's weight is 0 and 1
  std::vector<double> weights;          // at the operating point
  std::array<double, 4> colour{};
};

// Keys of one node, as accessors.
struct Track {
  int translation = -1, rotation = -1, weights = -1;
};

// The contents of a file.
struct Document {
  Buffer buffer;
  Mesh mesh;
  int times = 0;
  std::vector<Track> tracks;
  std::array<double, 4> turn{0, 0, 0, 1};  // of the root: x, y, z, w
  double scale = 1;                        // of the root
  double apart = 0;                        // between instances, along x
};

std::size_t key_count(const Take& take) { return take.frames + (take.loop ? 1 : 0); }

std::vector<float> times_of(const Take& take) {
  std::vector<float> times;
  for (std::size_t key = 0; key < key_count(take); ++key) {
    times.push_back(static_cast<float>(static_cast<double>(key) / take.rate_hz));
  }
  return times;
}

// A flat ellipse in the body's first two axes.
Mesh body_mesh(double half_width, double half_length, Buffer& buffer) {
  constexpr int kCorners = 24;
  std::vector<float> positions, normals;
  std::vector<std::uint16_t> indices;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    const double x = half_width * std::cos(angle), y = half_length * std::sin(angle);
    positions.insert(positions.end(), {static_cast<float>(x), static_cast<float>(y), 0});
    normals.insert(normals.end(), {0, 0, 1});
    if (k < 2) continue;
    for (const int corner : {0, k - 1, k}) indices.push_back(static_cast<std::uint16_t>(corner));
  }
  Mesh mesh{.positions = buffer.add_vertices(positions, Shape::kVector3), .colour = {0.62, 0.28, 0.07, 1}};
  mesh.normals = buffer.add_vertices(normals, Shape::kVector3);
  mesh.indices = buffer.add_indices(indices);
  return mesh;
}

// The keys of a body. Quaternions are unit, x first, with signs chosen for the shorter rotation between keys.
Track body_track(const Take& take, std::size_t instance, Buffer& buffer) {
  std::vector<float> places, turns;
  for (std::size_t key = 0; key < key_count(take); ++key) {
    const auto row = take.at(key % take.frames, instance);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double round = key < take.frames ? 0 : take.travel[instance][axis];
      places.push_back(static_cast<float>(row[axis] + round));
    }
    if (take.outputs < 7) continue;
    std::array<float, 4> q{row[4], row[5], row[6], row[3]};
    double size = 0, along = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      size += static_cast<double>(q[k]) * q[k];
      if (key > 0) along += static_cast<double>(q[k]) * turns[turns.size() - 4 + k];
    }
    const double unit = (along < 0 ? -1 : 1) / std::sqrt(size);
    for (std::size_t k = 0; k < 4; ++k) q[k] = static_cast<float>(unit * q[k]);
    turns.insert(turns.end(), q.begin(), q.end());
  }
  Track track{.translation = buffer.add(places, Shape::kVector3)};
  if (!turns.empty()) track.rotation = buffer.add(turns, Shape::kVector4);
  return track;
}

Document body_document(const Take& take, double half_width, double half_length) {
  constexpr double kUnknown = 0.03;  // metres: a small leaf
  Document document;
  const double width = half_width > 0 ? half_width : kUnknown;
  document.mesh = body_mesh(width, half_length > 0 ? half_length : width, document.buffer);
  document.times = document.buffer.add(times_of(take), Shape::kScalar);
  for (std::size_t k = 0; k < take.instances; ++k) document.tracks.push_back(body_track(take, k, document.buffer));
  document.turn = {-std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2};
  return document;
}

// The weight of a target: the position of its output in the range of the bank, since tools clamp weights to 0 … 1.
double weight_of(const Mesh& mesh, std::size_t output, double value) {
  const double range = mesh.highest[output] - mesh.lowest[output];
  return range > 0 ? std::clamp((value - mesh.lowest[output]) / range, 0.0, 1.0) : 0;
}

void set_ranges(const Model& model, Mesh& mesh) {
  const auto middle = operating_point(model);
  for (std::size_t k = 0; k < model.outputs.size(); ++k) {
    const double margin = kRangeMargin * (model.outputs[k].highest - model.outputs[k].lowest);
    mesh.lowest.push_back(model.outputs[k].lowest - margin);
    mesh.highest.push_back(model.outputs[k].highest + margin);
    mesh.weights.push_back(weight_of(mesh, k, middle[k]));
  }
}

// A strip between the two sides of the outline, with a morph target for each output.
Mesh outline_mesh(const Model& model, const std::vector<double>& knots, Buffer& buffer) {
  constexpr int kPoints = 32;
  Mesh mesh{.colour = {1, 0.62, 0.2, 1}};
  set_ranges(model, mesh);
  std::vector<float> coordinates;
  std::vector<std::uint16_t> indices;
  for (int k = 0; k < kPoints; ++k) {
    const bool left = k < kPoints / 2;
    const int up = left ? k : kPoints - 1 - k;
    coordinates.insert(coordinates.end(), {left ? 0.0F : 1.0F, 1 - static_cast<float>(up) / (kPoints / 2 - 1)});
    if (k + 1 >= kPoints / 2) continue;
    const int across = kPoints - 1 - k;
    for (const int corner : {k, across, across - 1, k, across - 1, k + 1}) {
      indices.push_back(static_cast<std::uint16_t>(corner));
    }
  }
  mesh.positions = buffer.add_vertices(outline_points(knots, mesh.lowest, kPoints), Shape::kVector3);
  mesh.coordinates = buffer.add_vertices(coordinates, Shape::kVector2);
  mesh.indices = buffer.add_indices(indices);
  for (std::size_t output = 0; output < mesh.lowest.size(); ++output) {
    std::vector<double> unit(mesh.lowest.size(), 0.0);
    unit[output] = mesh.highest[output] - mesh.lowest[output];
    mesh.targets.push_back(buffer.add_vertices(outline_points(knots, unit, kPoints), Shape::kVector3));
  }
  return mesh;
}

Document outline_document(const Model& model, const OutlineView& view, const Take& take) {
  constexpr double kApart = 1.2;
  Document document;
  document.mesh = outline_mesh(model, view.knots, document.buffer);
  document.times = document.buffer.add(times_of(take), Shape::kScalar);
  for (std::size_t k = 0; k < take.instances; ++k) {
    std::vector<float> weights;
    for (std::size_t key = 0; key < key_count(take); ++key) {
      const auto row = take.at(key % take.frames, k);
      for (std::size_t i = 0; i < row.size(); ++i)
        weights.push_back(static_cast<float>(weight_of(document.mesh, i, row[i])));
    }
    document.tracks.push_back({.weights = document.buffer.add(weights, Shape::kScalar)});
  }
  document.scale = view.metres_per_unit > 0 ? view.metres_per_unit : 1;
  document.apart = kApart;
  return document;
}

void write_nodes(const Document& document, const Take& take, JsonText& json) {
  json.value(0, "scene").list("scenes").object().list("nodes").value(0).end().end().end();
  json.list("nodes").object().value("wisp", "name").values(document.turn, "rotation");
  json.values(std::array{document.scale, document.scale, document.scale}, "scale").list("children");
  for (std::size_t k = 1; k <= take.instances; ++k) json.value(k);
  json.end().end();
  for (std::size_t k = 0; k < take.instances; ++k) {
    json.object().value("instance " + std::to_string(k), "name").value(0, "mesh");
    if (document.apart > 0) json.values(std::array{document.apart * static_cast<double>(k), 0.0, 0.0}, "translation");
    if (!take.travel.empty()) {
      // Rounded to the precision of the keys: further digits depend on the C library.
      const auto [x, y, z] = take.travel[k];
      const std::array travel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
      json.object("extras").values(travel, "travel").end();
    }
    json.end();
  }
  json.end();
}

void write_mesh(const Mesh& mesh, const Model& model, JsonText& json) {
  json.list("meshes").object().value("shape", "name").list("primitives").object().object("attributes");
  json.value(mesh.positions, "POSITION");
  if (mesh.normals >= 0) json.value(mesh.normals, "NORMAL");
  if (mesh.coordinates >= 0) json.value(mesh.coordinates, "TEXCOORD_0");
  json.end().value(mesh.indices, "indices").value(0, "material");
  if (!mesh.targets.empty()) {
    json.list("targets");
    for (const int target : mesh.targets) json.object().value(target, "POSITION").end();
    json.end();
  }
  json.end().end();
  if (!mesh.targets.empty()) {
    json.values(mesh.weights, "weights").object("extras").list("targetNames");
    for (const Output& output : model.outputs) json.value(output.name, {});
    json.end().values(mesh.lowest, "lowest").values(mesh.highest, "highest").end();
  }
  json.end().end();
  json.list("materials").object().value("shape", "name").object("pbrMetallicRoughness");
  json.values(mesh.colour, "baseColorFactor").value(0, "metallicFactor").end().value(true, "doubleSided");
  // A flame emits light and is drawn unlit.
  if (mesh.normals < 0) json.object("extensions").object("KHR_materials_unlit").end().end();
  json.end().end();
}

void write_animation(const Document& document, const Model& model, const Take& take, JsonText& json) {
  struct Channel {
    int output;
    std::size_t node;
    const char* path;
  };
  std::vector<Channel> channels;
  for (std::size_t k = 0; k < document.tracks.size(); ++k) {
    const Track& track = document.tracks[k];
    if (track.translation >= 0) channels.push_back({track.translation, k + 1, "translation"});
    if (track.rotation >= 0) channels.push_back({track.rotation, k + 1, "rotation"});
    if (track.weights >= 0) channels.push_back({track.weights, k + 1, "weights"});
  }
  json.list("animations").object().value(model.name.empty() ? "wisp" : model.name, "name").list("samplers");
  for (const Channel& channel : channels) {
    json.object().value(document.times, "input").value("LINEAR", "interpolation").value(channel.output, "output").end();
  }
  json.end().list("channels");
  for (std::size_t k = 0; k < channels.size(); ++k) {
    json.object().value(k, "sampler").object("target").value(channels[k].node, "node");
    json.value(channels[k].path, "path").end().end();
  }
  json.end().object("extras").value(take.rate_hz, "rate_hz").value(take.loop, "loop").end().end().end();
}

std::optional<Document> document_of(const Model& model, const Take& take) {
  if (const auto* outline = std::get_if<OutlineView>(&model.view)) return outline_document(model, *outline, take);
  if (const auto* pose = std::get_if<PoseView>(&model.view)) {
    return body_document(take, pose->half_width, pose->half_length);
  }
  if (const auto* position = std::get_if<PositionView>(&model.view)) {
    return body_document(take, position->half_width, position->half_width);
  }
  return {};
}

}  // namespace

Result<std::vector<std::byte>> gltf_bytes(const Model& model, const Take& take) {
  if (auto ok = check_take(model, take); !ok) return ok.error();
  const auto document = document_of(model, take);
  if (!document) {
    return Error{
        "the model's outputs are neither an outline nor a body, so there is nothing to move; a lamp goes into a .c, "
        "and numbers are written with `wisp run -o X.csv`"};
  }
  JsonText json;
  json.object().object("asset").value("2.0", "version").value("Wisp", "generator").end();
  if (document->mesh.normals < 0) json.list("extensionsUsed").value("KHR_materials_unlit", {}).end();
  write_nodes(*document, take, json);
  write_mesh(document->mesh, model, json);
  write_animation(*document, model, take, json);
  document->buffer.describe(json);
  json.end();
  return document->buffer.file(json.text());
}

}  // namespace wisp
