// Binary glTF 2.0 (ISO/IEC 12113:2022) of bodies and outlines, with the extension KHR_materials_emissive_strength.

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
namespace exporting {
extern const unsigned char flame_picture[];
extern const unsigned flame_picture_size;
}  // namespace exporting
namespace {

// The number of components of a value.
enum class Shape { kScalar = 1, kVector2 = 2, kVector3 = 3, kVector4 = 4 };

// glTF 2.0 Specification (ISO/IEC 12113:2022), sections 3.6 and 4.4.
constexpr int kFloat = 5126, kShort = 5123, kVertices = 34962, kIndices = 34963;
constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

void append(std::vector<std::byte>& bytes, std::uint32_t word, int size = 4) {
  for (int k = 0; k < size; ++k) bytes.push_back(static_cast<std::byte>(word >> 8 * k & 0xff));
}

class Buffer {
 public:
  /// Adds numbers, of vertices where kVertices is the target; returns the index of their accessor.
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

  /// Adds indices of vertices.
  int add_indices(std::span<const std::uint16_t> indices) {
    Accessor accessor{bytes_.size(), indices.size() * 2, indices.size(), Shape::kScalar, kIndices, {}, {}};
    for (const std::uint16_t index : indices) append(bytes_, index, 2);
    return close(std::move(accessor));
  }

  /// Adds a file of another format, a picture. Precondition: it comes after all numbers.
  void add_picture(std::span<const std::byte> picture) {
    Accessor accessor{.offset = bytes_.size(), .bytes = picture.size()};
    bytes_.insert(bytes_.end(), picture.begin(), picture.end());
    close(std::move(accessor));
  }
  bool has_picture() const { return accessors_.back().count == 0; }

  /// Writes "accessors", "bufferViews" and "buffers" into an open object.
  void describe(JsonText& json) const;

  /// The whole file: header, `json` and the numbers.
  std::vector<std::byte> file(std::string json) const;

 private:
  struct Accessor {
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::size_t count = 0;  // 0: a picture, which has a view of the bytes alone
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
    json.list("textures").object().value(0, "source").end().end();
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
  int times = 0;
  int translation = -1, rotation = -1, weights = -1;
};

// The contents of a file.
struct Document {
  Buffer buffer;
  Mesh mesh;
  std::vector<Track> tracks;
  std::array<double, 4> turn{0, 0, 0, 1};  // of the root: x, y, z, w
  double scale = 1;                        // of the root
  double apart = 0;                        // between instances, along x
};

std::size_t key_count(const Take& take) { return take.frames + (take.loop ? 1 : 0); }

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
  Mesh mesh{.positions = buffer.add(positions, Shape::kVector3, kVertices), .colour = {0.342, 0.064, 0.006, 1}};
  mesh.normals = buffer.add(normals, Shape::kVector3, kVertices);
  mesh.indices = buffer.add_indices(indices);
  return mesh;
}

// Where and when in its round an instance of a loop begins: apart from the others, so that one leaf at a time leaves
// the scene below and comes again above, and the scene's last frame is its first.
struct Start {
  std::size_t frame = 0;
  std::array<double, 2> place{};  // metres, level
};

Start start_of(const Take& take, std::size_t instance) {
  if (!take.loop || take.instances == 1) return {};
  constexpr double kGolden = 0.618033988749895, kApart = 0.25;
  const double k = static_cast<double>(instance) + 0.5, angle = 2 * std::numbers::pi * kGolden * k;
  const double share = kGolden * k - std::floor(kGolden * k), radius = kApart * std::sqrt(k);
  const auto frame = static_cast<std::size_t>(share * static_cast<double>(take.frames));
  return {std::max<std::size_t>(1, frame), {radius * std::cos(angle), radius * std::sin(angle)}};
}

// A unit quaternion, x first, of the sign that is nearer to the one before.
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

// The keys of a body. Where its round ends before the take does, a key just before is where the round leads to.
Track body_track(const Take& take, std::size_t instance, Buffer& buffer) {
  constexpr double kJustBefore = 0.01;  // steps
  const Start start = start_of(take, instance);
  std::vector<float> places, turns, times;
  const auto add = [&](double key, std::size_t frame, bool round) {
    const auto row = take.at(frame % take.frames, instance);
    times.push_back(static_cast<float>(key / take.rate_hz));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = row[axis] + (axis < 2 ? start.place[axis] : 0);
      places.push_back(static_cast<float>(place + (round ? take.travel[instance][axis] : 0)));
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
  const double width = half_width > 0 ? half_width : kUnknownHalfWidth;
  document.mesh = body_mesh(width, half_length > 0 ? half_length : width, document.buffer);
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

// The picture of a flame: from −kFlameAcross to kFlameAcross half widths, and in shares of the way from base to tip
// from kFlameLow to kFlameHigh; the drop around the wick ends at −kFlameDrop.
constexpr double kFlameAcross = 1.75, kFlameLow = -0.2, kFlameHigh = 1.2, kFlameDrop = 0.12;

// Rows of vertices from below the base over the outline's chords to above its tip, linear in the outline. A row has its
// chord's ends, points between them, and a halo's end on either side.
constexpr int kPoints = 32, kChords = kPoints / 2;
constexpr std::array kAcross{-kFlameAcross, -1.0, -0.6, 0.0, 0.6, 1.0, kFlameAcross};

struct MeshRow {
  int chord = 0;
  double width = 1;  // share of the chord
  double down = 0;   // below it, in half chords
  double up = 0;     // above it, in distances to the chord two before
};

std::vector<MeshRow> mesh_rows() {
  std::vector<MeshRow> rows{{0, 0, 1.9, 0}, {0, 0, 1, 0}, {0, 0.5, 0.87, 0}, {0, 0.87, 0.5, 0}};
  for (int chord = 0; chord < kChords; ++chord) rows.push_back({chord});
  rows.push_back({kChords - 1, 0, 0, 0.1});
  rows.push_back({kChords - 1, 0, 0, 2.5});
  return rows;
}

// Vertices of an outline of kPoints points, or of a change of it.
std::vector<float> mesh_vertices(const std::vector<float>& outline) {
  using Place = std::array<double, 2>;
  const auto chord_of = [&](int chord, double sign) {
    Place sum{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double left = outline[3 * static_cast<std::size_t>(chord) + axis];
      const double right = outline[3 * static_cast<std::size_t>(kPoints - 1 - chord) + axis];
      sum[axis] = (right + sign * left) / 2;
    }
    return sum;
  };
  const Place widest = chord_of(kChords / 2, -1), before = chord_of(kChords - 3, 1);
  std::vector<float> vertices;
  for (const MeshRow& row : mesh_rows()) {
    const Place middle = chord_of(row.chord, 1), half = chord_of(row.chord, -1);
    const Place below{half[1] * row.down, -half[0] * row.down};
    for (const double across : kAcross) {
      const double inside = std::clamp(across, -1.0, 1.0) * row.width, outside = across - std::clamp(across, -1.0, 1.0);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        vertices.push_back(static_cast<float>(middle[axis] + below[axis] + row.up * (middle[axis] - before[axis]) +
                                              inside * half[axis] + outside * widest[axis]));
      }
      vertices.push_back(0);
    }
  }
  return vertices;
}

// Where each vertex lies in the flame's picture: rows at their height over the base in the outline at rest.
std::vector<float> mesh_coordinates(const std::vector<float>& rest) {
  const auto vertices = mesh_vertices(rest);
  const auto rows = mesh_rows();
  const std::size_t columns = kAcross.size(), base = 4, tip = base + kChords - 1;
  const auto height = [&](std::size_t row) -> double { return vertices[3 * (row * columns + columns / 2) + 1]; };
  std::vector<float> coordinates;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    double along = (height(row) - height(base)) / std::max(1e-6, height(tip) - height(base));
    if (row < base) along = row == 0 ? kFlameLow : -kFlameDrop * rows[row].down;
    if (row > tip) along = row > tip + 1 ? kFlameHigh : 1;
    for (const double across : kAcross) {
      coordinates.push_back(static_cast<float>((across / kFlameAcross + 1) / 2));
      coordinates.push_back(static_cast<float>(std::clamp((kFlameHigh - along) / (kFlameHigh - kFlameLow), 0.0, 1.0)));
    }
  }
  return coordinates;
}

std::vector<std::uint16_t> mesh_indices() {
  std::vector<std::uint16_t> indices;
  const int columns = static_cast<int>(kAcross.size()), rows = static_cast<int>(mesh_rows().size());
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int at = row * columns + column;
      for (const int corner : {at, at + 1, at + columns + 1, at, at + columns + 1, at + columns}) {
        indices.push_back(static_cast<std::uint16_t>(corner));
      }
    }
  }
  return indices;
}

// The outline as rows of vertices, with a morph target for each output.
Mesh outline_mesh(const Model& model, const std::vector<double>& knots, Buffer& buffer) {
  Mesh mesh{.colour = {0, 0, 0, 1}};
  set_ranges(model, mesh);
  const auto vertices_of = [&](std::span<const double> control) {
    return buffer.add(mesh_vertices(outline_points(knots, control, kPoints)), Shape::kVector3, kVertices);
  };
  mesh.positions = vertices_of(mesh.lowest);
  const auto rest = outline_points(knots, operating_point(model), kPoints);
  mesh.coordinates = buffer.add(mesh_coordinates(rest), Shape::kVector2, kVertices);
  mesh.indices = buffer.add_indices(mesh_indices());
  for (std::size_t output = 0; output < mesh.lowest.size(); ++output) {
    std::vector<double> unit(mesh.lowest.size(), 0.0);
    unit[output] = mesh.highest[output] - mesh.lowest[output];
    mesh.targets.push_back(vertices_of(unit));
  }
  return mesh;
}

Document outline_document(const Model& model, const OutlineView& view, const Take& take) {
  constexpr double kApart = 1.2;
  Document document;
  document.mesh = outline_mesh(model, view.knots, document.buffer);
  std::vector<float> seconds(key_count(take));
  for (std::size_t k = 0; k < seconds.size(); ++k)
    seconds[k] = static_cast<float>(static_cast<double>(k) / take.rate_hz);
  const int times = document.buffer.add(seconds, Shape::kScalar);
  for (std::size_t k = 0; k < take.instances; ++k) {
    std::vector<float> weights;
    for (std::size_t key = 0; key < key_count(take); ++key) {
      const auto row = take.at(key % take.frames, k);
      for (std::size_t i = 0; i < row.size(); ++i)
        weights.push_back(static_cast<float>(weight_of(document.mesh, i, row[i])));
    }
    document.tracks.push_back({.times = times, .weights = document.buffer.add(weights, Shape::kScalar)});
  }
  document.buffer.add_picture(std::as_bytes(std::span(flame_picture, flame_picture_size)));
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
      // Rounded to the precision of the keys: further digits depend on the C library.
      const auto [x, y, z] = take.travel[k];
      const std::array travel{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
      json.object("extras").values(travel, "travel").end();
    }
    json.end();
  }
  json.end();
}

constexpr double kEmissiveStrength = 1.5;  // of a screen's white: what glows in an engine's bloom

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
  json.values(mesh.colour, "baseColorFactor").value(0, "metallicFactor").value(1, "roughnessFactor");
  if (mesh.coordinates < 0) {
    json.end().value(true, "doubleSided").end().end();
    return;
  }
  // A flame emits its picture's light; the picture's opacity is the base colour's, which is black.
  json.object("baseColorTexture").value(0, "index").end().end().value(true, "doubleSided");
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
  write_mesh(document->mesh, model, json);
  write_animation(*document, model, take, json);
  document->buffer.describe(json);
  json.end();
  return document->buffer.file(json.text());
}

}  // namespace wisp
