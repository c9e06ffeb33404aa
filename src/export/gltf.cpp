// Binary glTF 2.0 (ISO/IEC 12113:2022) of bodies and outlines, with the extension KHR_materials_emissive_strength.

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"

namespace wisp {
namespace exporting {
extern const unsigned char kFlamePicture[];
extern const unsigned kFlamePictureSize;
}  // namespace exporting
namespace {

// Shape of a value, by its number of components.
enum class Shape { kScalar = 1, kVector2 = 2, kVector3 = 3, kVector4 = 4 };

// Codes of glTF 2.0 (ISO/IEC 12113:2022), sections 3.6 and 4.4.
constexpr int kFloat = 5126, kShort = 5123, kVertices = 34962, kIndices = 34963, kLinear = 9729, kClamped = 33071;
constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

void append(std::vector<std::byte>& bytes, std::uint32_t word, int size = 4) {
  for (int k = 0; k < size; ++k) bytes.push_back(static_cast<std::byte>(word >> 8 * k & 0xff));
}

class Buffer {
 public:
  /// Adds numbers; `target` is kVertices for vertex attributes. Returns the index of their accessor.
  int add(std::span<const float> values, Shape shape, int target = 0) {
    const auto width = static_cast<std::size_t>(shape);
    Accessor accessor{bytes_.size(), values.size() * 4, values.size() / width, shape, target, {}, {}};
    accessor.lowest.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
    accessor.highest = accessor.lowest;
    for (std::size_t k = 0; k < values.size(); ++k) {
      accessor.lowest[k % width] = std::min(accessor.lowest[k % width], values[k]);
      accessor.highest[k % width] = std::max(accessor.highest[k % width], values[k]);
      append(bytes_, std::bit_cast<std::uint32_t>(values[k]));
    }
    return close(std::move(accessor));
  }

  int add_indices(std::span<const std::uint16_t> indices) {
    Accessor accessor{bytes_.size(), indices.size() * 2, indices.size(), Shape::kScalar, kIndices, {}, {}};
    for (const std::uint16_t index : indices) append(bytes_, index, 2);
    return close(std::move(accessor));
  }

  /// Adds a picture file. Precondition: all numbers have been added.
  void add_picture(std::span<const std::byte> picture) {
    Accessor accessor{.offset = bytes_.size(), .bytes = picture.size()};
    bytes_.insert(bytes_.end(), picture.begin(), picture.end());
    close(std::move(accessor));
  }
  bool has_picture() const { return accessors_.back().count == 0; }

  /// Writes accessors, views, buffer and, with a picture, its texture into the open root object.
  void describe(JsonText& json) const;

  /// Returns the whole file: header, `json` and the numbers.
  std::vector<std::byte> file(std::string json) const;

 private:
  struct Accessor {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::size_t count = 0;  // 0: a picture, which has only a view of the bytes
    Shape shape = Shape::kScalar;
    int target = 0;  // glTF buffer target; 0: none
    std::vector<float> lowest, highest;
  };

  int close(Accessor accessor) {
    bytes_.resize(padded(bytes_.size()));
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }

  std::vector<Accessor> accessors_;
  std::vector<std::byte> bytes_;
};

void Buffer::describe(JsonText& json) const {
  constexpr std::array kShapes{"SCALAR", "VEC2", "VEC3", "VEC4"};
  json.list("accessors");
  for (std::size_t k = 0; k < accessors_.size() - (has_picture() ? 1 : 0); ++k) {
    const Accessor& accessor = accessors_[k];
    json.object().value(k, "bufferView").value(accessor.target == kIndices ? kShort : kFloat, "componentType");
    json.value(accessor.count, "count").value(kShapes[static_cast<std::size_t>(accessor.shape) - 1], "type");
    if (accessor.target != kIndices) json.values(accessor.lowest, "min").values(accessor.highest, "max");
    json.end();
  }
  json.end().list("bufferViews");
  for (const Accessor& accessor : accessors_) {
    json.object().value(0, "buffer").value(accessor.offset, "byteOffset").value(accessor.bytes, "byteLength");
    if (accessor.target != 0) json.value(accessor.target, "target");
    json.end();
  }
  json.end();
  if (has_picture()) {
    json.list("images").object().value(accessors_.size() - 1, "bufferView").value("image/png", "mimeType").end().end();
    // Samples without mipmaps, which would mix the texture's columns.
    json.list("samplers").object().value(kLinear, "magFilter").value(kLinear, "minFilter");
    json.value(kClamped, "wrapS").value(kClamped, "wrapT").end().end();
    json.list("textures").object().value(0, "source").value(0, "sampler").end().end();
  }
  json.list("buffers").object().value(bytes_.size(), "byteLength").end().end();
}

std::vector<std::byte> Buffer::file(std::string json) const {
  json.resize(padded(json.size()), ' ');
  std::vector<std::byte> out;
  const auto total = static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bytes_.size());
  const auto text = std::as_bytes(std::span(json));
  for (const std::uint32_t word : {kMagic, 2U, total, static_cast<std::uint32_t>(json.size()), kJsonChunk})
    append(out, word);
  out.insert(out.end(), text.begin(), text.end());
  for (const std::uint32_t word : {static_cast<std::uint32_t>(bytes_.size()), kBinaryChunk}) append(out, word);
  out.insert(out.end(), bytes_.begin(), bytes_.end());
  return out;
}

using namespace exporting;

struct Mesh {
  int positions = 0, normals = -1, coordinates = -1, indices = 0;
  std::vector<int> targets;
  std::vector<double> lowest, highest;  // outputs at which a target's weight is 0 and 1
  std::vector<double> weights;          // weights at the operating point
  std::vector<std::string> names;       // names of the targets
  std::array<double, 4> colour{};
};

// Keyframes of one node, as accessors.
struct Track {
  int times = 0;
  int translation = -1, rotation = -1, weights = -1;
};

struct Document {
  Buffer buffer;
  Mesh mesh;
  std::vector<Track> tracks;
  std::array<double, 4> turn{0, 0, 0, 1};  // rotation of the root: x, y, z, w
  double scale = 1;                        // scale of the root
  double apart = 0;                        // spacing of instances along x
};

std::size_t key_count(const Take& take) { return take.frames + (take.loop ? 1 : 0); }

Mesh body_mesh(double half_width, double half_length, Buffer& buffer) {
  const Surface leaf = leaf_blade(half_width, half_length);
  Mesh mesh{.positions = buffer.add(leaf.places, Shape::kVector3, kVertices), .colour = {0.342, 0.064, 0.006, 1}};
  mesh.normals = buffer.add(leaf.normals, Shape::kVector3, kVertices);
  mesh.indices = buffer.add_indices(leaf.triangles);
  return mesh;
}

// Start of an instance in its loop's period, and its position: starts differ, so that one leaf at a time leaves the
// scene below and re-enters above, and the scene's last frame equals its first.
struct Start {
  std::size_t frame = 0;
  std::array<double, 2> place{};  // horizontal position, metres
};

Start start_of(const Take& take, std::size_t instance) {
  if (!take.loop || take.instances == 1) return {};
  constexpr double kGolden = 0.618033988749895, kApart = 0.25;
  const double k = static_cast<double>(instance) + 0.5, angle = 2 * std::numbers::pi * kGolden * k;
  const double share = kGolden * k - std::floor(kGolden * k), radius = kApart * std::sqrt(k);
  const auto frame = static_cast<std::size_t>(share * static_cast<double>(take.frames));
  return {std::max<std::size_t>(1, frame), {radius * std::cos(angle), radius * std::sin(angle)}};
}

// Returns a unit quaternion, x first, with the sign that is nearer to the previous quaternion.
std::array<float, 4> turn_of(std::span<const float> row, std::span<const float> before) {
  std::array<float, 4> q{row[4], row[5], row[6], row[3]};
  double size = 0, along = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    size += static_cast<double>(q[k]) * q[k];
    if (!before.empty()) along += static_cast<double>(q[k]) * before[before.size() - 4 + k];
  }
  const double unit = (along < 0 ? -1 : 1) / std::sqrt(size);
  for (std::size_t k = 0; k < 4; ++k) q[k] = static_cast<float>(unit * q[k]);
  return q;
}

// Computes the keys of a body. If its period ends before the take does, an additional key just before that frame holds
// the state at the period's end, so that the body does not slide back to its start.
Track body_track(const Take& take, std::size_t instance, Buffer& buffer) {
  constexpr double kJustBefore = 0.01;  // in steps
  assert(take.frames > 0);
  const Start start = start_of(take, instance);
  const std::array<double, 3> travel = take.travel.empty() ? std::array<double, 3>{} : take.travel[instance];
  std::vector<float> places, turns, times;
  const auto add = [&](double key, std::size_t frame, bool round) {
    const auto row = take.at(frame % take.frames, instance);
    const auto time = static_cast<float>(key / take.rate_hz);
    times.push_back(times.empty() ? time : std::max(time, std::nextafter(times.back(), 1e30F)));  // glTF: increasing
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = row[axis] + (axis < 2 ? start.place[axis] : 0);
      places.push_back(static_cast<float>(place + (round ? travel[axis] : 0)));
    }
    if (take.outputs < 7) return;
    const auto q = turn_of(row, turns);
    turns.insert(turns.end(), q.begin(), q.end());
  };
  for (std::size_t key = 0; key < key_count(take); ++key) {
    const std::size_t frame = key + start.frame;
    if (take.loop && start.frame > 0 && frame == take.frames) add(static_cast<double>(key) - kJustBefore, frame, true);
    add(static_cast<double>(key), frame, start.frame == 0 && frame == take.frames);
  }
  Track track{.times = buffer.add(times, Shape::kScalar), .translation = buffer.add(places, Shape::kVector3)};
  if (!turns.empty()) track.rotation = buffer.add(turns, Shape::kVector4);
  return track;
}

Document body_document(const Take& take, double half_width, double half_length) {
  Document document;
  document.mesh = body_mesh(half_width, half_length, document.buffer);
  for (std::size_t k = 0; k < take.instances; ++k) document.tracks.push_back(body_track(take, k, document.buffer));
  document.turn = {-std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2};
  return document;
}

// Returns a target's weight: the position of its output in the bank's range, since tools clamp weights to 0 … 1.
double weight_of(const Mesh& mesh, std::size_t target, double value) {
  const double range = mesh.highest[target] - mesh.lowest[target];
  return range > 0 ? std::clamp((value - mesh.lowest[target]) / range, 0.0, 1.0) : 0;
}

// Sets the ranges of outputs in the front view, then in the side view, where x ranges are symmetric about 0.
void set_ranges(const Model& model, std::size_t sides, Mesh& mesh) {
  const auto middle = operating_point(model);
  for (std::size_t k = 0; k < sides * model.outputs.size(); ++k) {
    const Output& output = model.outputs[k % model.outputs.size()];
    const bool side = k >= model.outputs.size(), level = k % 2 == 0;
    const double margin = kRangeMargin * (output.highest - output.lowest);
    mesh.lowest.push_back(output.lowest - margin);
    mesh.highest.push_back(output.highest + margin);
    if (side && level) mesh.highest[k] = std::max(mesh.highest[k], -mesh.lowest[k]), mesh.lowest[k] = -mesh.highest[k];
    mesh.weights.push_back(weight_of(mesh, k, side && level ? 0 : middle[k % model.outputs.size()]));
    mesh.names.push_back((side ? "side " : "") + output.name);
  }
}

// Sizes of a flame's nested shells, relative to its outline. Each shell adds some light, so that the flame is bright
// where it is thick and has no edge, in any drawing order. flame.png has a column per shell.
constexpr std::array kShells{1.0, 0.93, 0.82, 0.66, 0.46, 0.22};

// A row of vertices made from a ring. Some rows form a drop around the wick below the base, and one closes the tip.
struct MeshRow {
  int ring = 0;
  double width = 1;  // width as a share of the ring's width
  double down = 0;   // distance below the ring, in ring radii
  double up = 0;     // distance above the ring, as a share of the distance to the ring two before
};

std::vector<MeshRow> mesh_rows() {
  std::vector<MeshRow> rows{{0, 0, 1, 0}, {0, 0.5, 0.87, 0}, {0, 0.87, 0.5, 0}};
  for (int ring = 0; ring < kRings; ++ring) rows.push_back({ring});
  rows.push_back({kRings - 1, 0, 0, 0.1});
  return rows;
}

// Computes vertices of all shells, or the change of the vertices from a change of the rings: linear in the rings.
std::vector<float> mesh_vertices(const std::vector<float>& rings) {
  const float* before = &rings[(kRings - 3) * kRingNumbers];
  std::vector<float> all;
  for (const double shell : kShells) {
    for (const MeshRow& row : mesh_rows()) {
      const float* ring = &rings[static_cast<std::size_t>(row.ring) * kRingNumbers];
      const double down[] = {ring[4], -ring[3], ring[5]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = row.up * (ring[axis] - before[axis]) + row.down * shell * down[axis];
        all.push_back(static_cast<float>(ring[axis] + along));
      }
      for (std::size_t k = 3; k < kRingNumbers; ++k) all.push_back(static_cast<float>(ring[k] * row.width * shell));
    }
  }
  return ring_places(all, kSegments);
}

constexpr double kFlameDrop = 0.12;  // flame.png's lower edge below the base, as a share of the flame's height at rest

// Returns texture coordinates: the shell's column, and a row's height above the base in the outline at rest.
std::vector<float> mesh_coordinates(const std::vector<float>& rest) {
  const double base = rest[1], tip = std::max(rest[(kRings - 1) * kRingNumbers + 1] - base, 1e-6);
  std::vector<float> coordinates;
  for (std::size_t shell = 0; shell < kShells.size(); ++shell) {
    for (const MeshRow& row : mesh_rows()) {
      const double height = (rest[static_cast<std::size_t>(row.ring) * kRingNumbers + 1] - base) / tip;
      const double along = row.down > 0 ? -kFlameDrop * row.down : height;
      for (int k = 0; k < kSegments; ++k) {
        coordinates.push_back(static_cast<float>((static_cast<double>(shell) + 0.5) / kShells.size()));
        coordinates.push_back(static_cast<float>(std::clamp((1 - along) / (1 + kFlameDrop), 0.0, 1.0)));
      }
    }
  }
  return coordinates;
}

std::vector<std::uint16_t> mesh_indices() {
  std::vector<std::uint16_t> indices;
  const auto rows = static_cast<int>(mesh_rows().size());
  const auto of_shell = ring_corners(rows, kSegments);
  for (std::size_t shell = 0; shell < kShells.size(); ++shell) {
    const std::size_t first = shell * static_cast<std::size_t>(rows * kSegments);
    for (const auto corner : of_shell) indices.push_back(static_cast<std::uint16_t>(first + corner));
  }
  return indices;
}

// Builds the shells of a flame, with a morph target for each output, in front view and in side view.
Mesh outline_mesh(const Model& model, const std::vector<double>& knots, std::size_t sides, Buffer& buffer) {
  Mesh mesh{.colour = {0, 0, 0, 1}};
  set_ranges(model, sides, mesh);
  const auto rings = [&](const std::vector<double>& numbers) {
    const std::vector<float> all(numbers.begin(), numbers.end());
    const auto both = std::span(all);
    return rings_of(knots, both.first(model.outputs.size()), both.subspan(model.outputs.size()));
  };
  const auto vertices_of = [&](const std::vector<double>& numbers) {
    return buffer.add(mesh_vertices(rings(numbers)), Shape::kVector3, kVertices);
  };
  mesh.positions = vertices_of(mesh.lowest);
  mesh.coordinates = buffer.add(mesh_coordinates(rings(operating_point(model))), Shape::kVector2, kVertices);
  mesh.indices = buffer.add_indices(mesh_indices());
  for (std::size_t target = 0; target < mesh.lowest.size(); ++target) {
    std::vector<double> unit(mesh.lowest.size(), 0.0);
    unit[target] = mesh.highest[target] - mesh.lowest[target];
    mesh.targets.push_back(vertices_of(unit));
  }
  return mesh;
}

Document outline_document(const Model& model, const OutlineView& view, const Take& take) {
  constexpr double kApart = 1.2;
  Document document;
  document.mesh = outline_mesh(model, view.knots, take.sides, document.buffer);
  std::vector<float> seconds(key_count(take));
  for (std::size_t k = 0; k < seconds.size(); ++k)
    seconds[k] = static_cast<float>(static_cast<double>(k) / take.rate_hz);
  const int times = document.buffer.add(seconds, Shape::kScalar);
  for (std::size_t k = 0; k < take.instances; ++k) {
    std::vector<float> weights;
    for (std::size_t key = 0; key < key_count(take); ++key) {
      std::size_t target = 0;
      for (std::size_t side = 0; side < take.sides; ++side) {
        for (const float value : take.at(key % take.frames, k, side)) {
          weights.push_back(static_cast<float>(weight_of(document.mesh, target++, value)));
        }
      }
    }
    document.tracks.push_back({.times = times, .weights = document.buffer.add(weights, Shape::kScalar)});
  }
  document.buffer.add_picture(std::as_bytes(std::span(kFlamePicture, kFlamePictureSize)));
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
    if (take.travel.size() == 1) {
      // Rounds to the precision of the keys: further digits depend on the C library.
      const auto [x, y, z] = take.travel[k];
      const std::array travel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
      json.object("extras").values(travel, "travel").end();
    }
    json.end();
  }
  json.end();
}

constexpr double kEmissiveStrength = 5;  // relative to a screen's white; tools/flame_picture.py uses it too

void write_mesh(const Mesh& mesh, JsonText& json) {
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
    for (const std::string& name : mesh.names) json.value(name, {});
    json.end().values(mesh.lowest, "lowest").values(mesh.highest, "highest").end();
  }
  json.end().end();
  json.list("materials").object().value("shape", "name").object("pbrMetallicRoughness");
  json.values(mesh.colour, "baseColorFactor").value(0, "metallicFactor").value(1, "roughnessFactor");
  if (mesh.coordinates < 0) {
    json.end().value(true, "doubleSided").end().end();
    return;
  }
  // The flame emits the picture's light. The base colour is black and has the picture's opacity.
  json.object("baseColorTexture").value(0, "index").end().end();
  json.value("BLEND", "alphaMode").object("emissiveTexture").value(0, "index").end();
  json.values(std::array{1, 1, 1}, "emissiveFactor").object("extensions").object("KHR_materials_emissive_strength");
  json.value(kEmissiveStrength, "emissiveStrength").end().end().end().end();
}

void write_animation(const Document& document, const Model& model, const Take& take, JsonText& json) {
  constexpr std::array kPaths{"translation", "rotation", "weights"};
  const auto each = [&](auto write) {
    for (std::size_t k = 0; k < document.tracks.size(); ++k) {
      const Track& track = document.tracks[k];
      const std::array outputs{track.translation, track.rotation, track.weights};
      for (std::size_t path = 0; path < 3; ++path) {
        if (outputs[path] >= 0) write(track.times, outputs[path], k + 1, kPaths[path]);
      }
    }
  };
  json.list("animations").object().value(model.name.empty() ? "wisp" : model.name, "name").list("samplers");
  each([&](int times, int output, std::size_t, const char*) {
    json.object().value(times, "input").value("LINEAR", "interpolation").value(output, "output").end();
  });
  json.end().list("channels");
  int sampler = 0;
  each([&](int, int, std::size_t node, const char* path) {
    json.object().value(sampler++, "sampler").object("target").value(node, "node").value(path, "path").end().end();
  });
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
  if (document->buffer.has_picture()) json.list("extensionsUsed").value("KHR_materials_emissive_strength", {}).end();
  write_nodes(*document, take, json);
  write_mesh(document->mesh, json);
  write_animation(*document, model, take, json);
  document->buffer.describe(json);
  json.end();
  return document->buffer.file(json.text());
}

}  // namespace wisp
