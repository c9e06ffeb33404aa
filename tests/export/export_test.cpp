#include "wisp/export/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#ifdef WISP_HAS_RLOTTIE
#include <rlottie_capi.h>
#endif

#include "export/outline.hpp"
#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/body_facet.hpp"

namespace wisp::export_test {
namespace {

using Json = nlohmann::json;

// A .glb taken apart as its specification says.
struct Opened {
  Json json;
  std::vector<float> numbers(std::size_t accessor) const {
    const Json& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(), values.size() * 4);
    return values;
  }
  std::vector<std::byte> binary;
};

Opened opened(const std::vector<std::byte>& bytes) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(word(0), 0x46546c67u);
  EXPECT_EQ(word(8), bytes.size());
  const std::size_t json_size = word(12);
  const auto* text = reinterpret_cast<const char*>(bytes.data()) + 20;
  Opened file{Json::parse(text, text + json_size), {}};
  file.binary.assign(bytes.begin() + static_cast<std::ptrdiff_t>(28 + json_size), bytes.end());
  EXPECT_EQ(word(20 + json_size), file.binary.size());
  return file;
}

std::vector<float> keys(const Opened& file, std::size_t channel) {
  const Json& animation = file.json["animations"][0];
  const auto sampler = animation["channels"][channel]["sampler"].get<std::size_t>();
  return file.numbers(animation["samplers"][sampler]["output"].get<std::size_t>());
}

Model leaf() { return *read_model(WISP_SOURCE_DIR "/apps/web/public/models/leaf.wisp"); }

TEST(Gltf, ABodysKeysAreWhatIsPlayed) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 2, .instances = 2});
  const auto bytes = gltf_bytes(model, *taken);
  ASSERT_TRUE(bytes);
  const Opened file = opened(*bytes);
  ASSERT_EQ(file.json["nodes"].size(), 3u);
  const auto places = keys(file, 2), turns = keys(file, 3);
  ASSERT_EQ(places.size(), taken->frames * 3);
  for (std::size_t t = 0; t < taken->frames; ++t) {
    const auto row = taken->at(t, 1);
    double along = 0;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(places[3 * t + k], row[k]);
    // A bank's quaternions are of segments in 16 bits, and as long as those are: 1 within 4e-5.
    for (std::size_t k = 0; k < 4; ++k) along += static_cast<double>(turns[4 * t + k]) * row[3 + (k + 1) % 4];
    EXPECT_NEAR(std::abs(along), 1, 4e-5) << t;
    if (t == 0) continue;
    double step = 0;
    for (std::size_t k = 0; k < 4; ++k) step += static_cast<double>(turns[4 * t + k]) * turns[4 * t - 4 + k];
    EXPECT_GT(step, 0) << "the long way from key to key";
  }
}

TEST(Gltf, ALeafsMidribIsItsFirstAxis) {
  const Model model = leaf();
  const auto& size = std::get<PoseView>(model.view);
  const Opened file = opened(*gltf_bytes(model, *take(model, {.seconds = 0.1})));
  const auto& accessor =
      file.json["accessors"][file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_NEAR(accessor["max"][0].get<double>(), size.half_width, 0.003);
  EXPECT_NEAR(accessor["max"][1].get<double>(), size.half_length, 0.003);
}

TEST(Gltf, ALoopWithoutItsTravelIsRefused) {
  auto taken = take(leaf(), {.seconds = 0.2});
  taken->loop = true;
  EXPECT_FALSE(gltf_bytes(leaf(), *taken));
}

TEST(Gltf, ALoopEndsWithItsFirstFrameAgain) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 2, .loop = true});
  ASSERT_TRUE(taken) << taken.error().message;
  const Opened file = opened(*gltf_bytes(model, *taken));
  const auto places = keys(file, 0), turns = keys(file, 1);
  ASSERT_EQ(places.size(), (taken->frames + 1) * 3);
  double along = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(places[places.size() - 3 + k], places[k] + taken->travel[0][k], 1e-6);
    EXPECT_EQ(file.json["nodes"][1]["extras"]["travel"][k].get<float>(), static_cast<float>(taken->travel[0][k]));
  }
  for (std::size_t k = 0; k < 4; ++k) along += static_cast<double>(turns[turns.size() - 4 + k]) * turns[k];
  EXPECT_NEAR(std::abs(along), 1, 1e-6);
}

TEST(Gltf, ALoopOfABodyThatIsNoChainEndsWhereItBegins) {
  Model model = leaf();
  ArxModel arx;
  arx.orders = {OrderMatrix(7, 7), OrderMatrix(7, 0), OrderMatrix(7, 0)};
  for (int k = 0; k < 7; ++k) arx.orders.na(k, k) = 1;
  arx.theta.assign(7, {-0.5});
  arx.constant.assign(7, 0.0);
  arx.output_mean = {0, 0, 0, 1, 0, 0, 0};
  arx.noise.sd.assign(7, 0.01);
  model.dynamics = arx;
  model.inputs.clear();
  model.training = {};
  for (Output& output : model.outputs) output.lowest = -2, output.highest = 2;
  const auto taken = take(model, {.seconds = 2, .loop = true});
  ASSERT_TRUE(taken) << taken.error().message;
  const auto bytes = gltf_bytes(model, *taken);
  ASSERT_TRUE(bytes);
  const auto places = keys(opened(*bytes), 0);
  ASSERT_EQ(places.size(), (taken->frames + 1) * 3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(places[places.size() - 3 + k], places[k]);
}

// "Twenty leaves that fall for ever": they begin apart, and the last frame is the first one.
TEST(Gltf, LeavesOfALoopBeginApartAndTheSceneReturns) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 2, .loop = true, .instances = 6});
  ASSERT_TRUE(taken) << taken.error().message;
  const Opened file = opened(*gltf_bytes(model, *taken));
  const Json& animation = file.json["animations"][0];
  std::vector<std::array<double, 3>> begins;
  for (std::size_t leaf = 0; leaf < 6; ++leaf) {
    const auto places = keys(file, 2 * leaf), turns = keys(file, 2 * leaf + 1);
    const auto times = file.numbers(animation["samplers"][2 * leaf]["input"].get<std::size_t>());
    ASSERT_EQ(places.size(), 3 * times.size());
    double along = 0;
    for (std::size_t k = 0; k < 4; ++k) along += static_cast<double>(turns[k]) * turns[turns.size() - 4 + k];
    EXPECT_NEAR(std::abs(along), 1, 1e-5);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(places[k], places[places.size() - 3 + k]);
    int jumps = 0;
    for (std::size_t t = 1; t < times.size(); ++t) {
      EXPECT_GT(times[t], times[t - 1]);
      double step = 0;
      for (std::size_t k = 0; k < 3; ++k) step = std::hypot(step, places[3 * t + k] - places[3 * t - 3 + k]);
      if (step < 0.1) continue;
      ++jumps;
      EXPECT_LT(times[t] - times[t - 1], 0.02 / model.rate_hz);
      EXPECT_NEAR(places[3 * t + 2] - places[3 * t - 1], -taken->travel[leaf][2], 1e-5);
    }
    EXPECT_EQ(jumps, 1);
    for (const auto& other : begins) {
      EXPECT_GT(std::hypot(other[0] - places[0], other[1] - places[1], other[2] - places[2]), 0.1);
    }
    begins.push_back({places[0], places[1], places[2]});
  }
}

TEST(Gltf, KeysOfALongLoopAreAtIncreasingTimes) {
  constexpr std::size_t kFrames = 400'000;  // single precision rounds the key before the return to the next key's time
  const Take taken{.rate_hz = 1,
                   .loop = true,
                   .frames = kFrames,
                   .instances = 2,
                   .outputs = 7,
                   .values = std::vector<float>(kFrames * 2 * 7, 1.0F),
                   .travel = {{0, 0, -1}, {0, 0, -1}}};
  const auto bytes = gltf_bytes(leaf(), taken);
  ASSERT_TRUE(bytes);
  const Opened file = opened(*bytes);
  const auto times = file.numbers(file.json["animations"][0]["samplers"][0]["input"].get<std::size_t>());
  ASSERT_EQ(times.size(), kFrames + 2);
  EXPECT_EQ(std::adjacent_find(times.begin(), times.end(), std::greater_equal<float>()), times.end());
}

// As a shader reads it: the upper bytes in the first rows, the lower ones in the second.
TEST(VertexAnimation, IsTheSurfaceOfEveryFrameToSixteenBits) {
  const Model model = *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  const auto taken = take(model, {.seconds = 1, .loop = true, .round = true});
  ASSERT_TRUE(taken) << taken.error().message;
  ASSERT_EQ(taken->sides, 2u);
  const auto made = vertex_animation(model, *taken);
  ASSERT_TRUE(made) << made.error().message;
  const Json json = Json::parse(made->json);
  constexpr std::size_t kRings = 12, kSegments = 12;
  ASSERT_EQ(made->columns, kRings * kSegments);
  ASSERT_EQ(made->rows, 2 * taken->frames);
  const std::vector<double>& knots = std::get<OutlineView>(model.view).knots;
  for (const std::size_t frame : {std::size_t{0}, taken->frames / 2, taken->frames - 1}) {
    const auto row = taken->at(frame, 0), side = taken->at(frame, 0, 1);
    const auto front = exporting::outline_points(knots, std::vector<double>(row.begin(), row.end()), 2 * kRings);
    const auto across = exporting::outline_points(knots, std::vector<double>(side.begin(), side.end()), 2 * kRings);
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const auto vertex = [&](std::size_t segment, std::size_t axis) {
        const std::size_t at = 3 * (frame * made->columns + ring * kSegments + segment) + axis;
        const double share = (256 * made->rgb[at] + made->rgb[at + made->rgb.size() / 2]) / 65535.0;
        const double low = json["lowest"][axis], high = json["highest"][axis];
        return low + share * (high - low);
      };
      const std::size_t left = 3 * ring, right = 3 * (2 * kRings - 1 - ring);
      // Seen from the front its rim is the outline, and so from the side.
      for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(vertex(0, axis), front[right + axis], 1e-4);
        EXPECT_NEAR(vertex(6, axis), front[left + axis], 1e-4);
      }
      EXPECT_NEAR(vertex(3, 2), across[right], 1e-4);
      EXPECT_NEAR(vertex(9, 2), across[left], 1e-4);
      EXPECT_NEAR(vertex(3, 1), across[right + 1], 1e-4);
    }
  }
  for (const Json& corner : json["triangles"]) EXPECT_LT(corner.get<std::size_t>(), kRings * kSegments);
  EXPECT_FALSE(vertex_animation(flame_model(), Take{}));
}

TEST(Take, AFlameInTheRoundLoopsFromTheSideTooAndLeansWithItsSchedule) {
  const Model model = *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  const auto loop = take(model, {.seconds = 2, .loop = true, .round = true}),
             plane = take(model, {.seconds = 2, .loop = true});
  ASSERT_TRUE(loop && plane);
  double front = 0, moved = 0, jump = 0, step = 0;
  for (std::size_t frame = 0; frame < loop->frames; ++frame) {
    const auto now = loop->at(frame, 0, 1), next = loop->at((frame + 1) % loop->frames, 0, 1);
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double change = std::abs(double{now[k]} - next[k]);
      (frame + 1 == loop->frames ? jump : step) = std::max(frame + 1 == loop->frames ? jump : step, change);
      front = std::max(front, std::abs(double{loop->at(frame, 0)[k]} - plane->at(frame, 0)[k]));
      moved = std::max(moved, std::abs(double{now[k]} - loop->at(0, 0, 1)[k]));
    }
  }
  EXPECT_LE(jump, step);
  EXPECT_GT(moved, 0.01);
  const auto blown = take(model, {.seconds = 1, .round = true, .schedule = std::vector<float>(60, 0.6f)});
  ASSERT_TRUE(blown) << blown.error().message;
  const auto tip = [&](std::size_t side) { return blown->at(59, 0, side)[6] + blown->at(59, 0, side)[8]; };
  EXPECT_GT(std::abs(tip(0)), 4 * std::abs(tip(1)));
}

TEST(VertexAnimation, ALeafTurnsAndMovesWithItsPose) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 1});
  const auto made = vertex_animation(model, *taken);
  ASSERT_TRUE(made);
  const Json json = Json::parse(made->json);
  const std::size_t half = made->rgb.size() / 2, columns = made->columns;
  const auto place = [&](std::size_t frame, std::size_t point, std::size_t axis) {
    const std::size_t at = 3 * (frame * columns + point) + axis;
    const double low = json["lowest"][axis], high = json["highest"][axis];
    return low + (256 * made->rgb[at] + made->rgb[at + half]) / 65535.0 * (high - low);
  };
  for (std::size_t frame = 0; frame < taken->frames; frame += 7) {
    // Rows of an edge, the midrib and the other edge: the middle one's midrib is where the body is.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(place(frame, 3 * 6 + 1, axis), taken->at(frame, 0)[axis], 1e-3);
    }
    double along = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      along = std::hypot(along, place(frame, 1, axis) - place(frame, columns - 2, axis));
    EXPECT_NEAR(along, 2 * std::get<PoseView>(model.view).half_width, 1e-3);
  }
}

TEST(VertexAnimation, MoreFramesThanATextureHoldsAreRefused) {
  const Model model = leaf();
  const auto taken = take(model, {.seconds = 8200 / model.rate_hz});
  ASSERT_TRUE(taken) << taken.error().message;
  const auto made = vertex_animation(model, *taken);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "there are 8200 frames, expected at most 8192; ask for fewer seconds");
}

TEST(Gltf, AFlamesMorphTargetsAndWeightsMakeTheRingsThatABankDraws) {
  const Model model = *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  auto bank = Bank::create(*in_the_round(model), {.seed = 4, .polyline_points = 24});
  bank->spawn();
  bank->set_common_inputs(std::vector<float>{0.4f, 0});
  std::vector<float> rings(12 * kRingNumbers);
  for (int k = 0; k < 240; ++k) bank->step();
  const auto taken = take(model, {.seconds = 2, .seed = 4, .inputs = {0.4}, .round = true});
  ASSERT_TRUE(taken) << taken.error().message;
  const Opened file = opened(*gltf_bytes(model, *taken));
  const Json& primitive = file.json["meshes"][0]["primitives"][0];
  const auto base = file.numbers(primitive["attributes"]["POSITION"].get<std::size_t>());
  const auto weights = keys(file, 0);
  ASSERT_EQ(primitive["targets"].size(), 32u);
  EXPECT_EQ(file.json["meshes"][0]["extras"]["targetNames"][3], "p1.y");
  EXPECT_EQ(file.json["meshes"][0]["extras"]["targetNames"][18], "side p1.x");
  std::vector<std::vector<float>> targets;
  for (const Json& target : primitive["targets"])
    targets.push_back(file.numbers(target["POSITION"].get<std::size_t>()));
  // The outermost shell comes first: three rings below the base, then the rings, of twelve vertices.
  for (std::size_t t = 0; t < taken->frames; ++t) {
    bank->step();
    ASSERT_TRUE(bank->body()->read_rings(bank->at(0), rings));
    for (std::size_t ring = 0; ring < 12; ++ring) {
      const float* at = &rings[ring * kRingNumbers];
      const auto vertex = [&](std::size_t segment, std::size_t axis) {
        const std::size_t place = 3 * ((3 + ring) * 12 + segment) + axis;
        double sum = base[place];
        for (std::size_t k = 0; k < 32; ++k) sum += double{weights[32 * t + k]} * targets[k][place];
        return sum;
      };
      ASSERT_NEAR(vertex(0, 0), at[0] + at[3], 2e-5) << t;
      ASSERT_NEAR(vertex(0, 1), at[1] + at[4], 2e-5) << t;
      ASSERT_NEAR(vertex(3, 2), at[2] + at[3], 2e-5) << t;
      ASSERT_NEAR(vertex(9, 1), at[1] - at[5], 2e-5) << t;
    }
  }
  for (const float weight : weights) ASSERT_TRUE(weight >= 0 && weight <= 1);
}

TEST(Gltf, AFlameThatCannotBeInTheRoundIsABodyOfRevolution) {
  const Model model = flame_model();
  const auto taken = take(model, {.seconds = 1, .round = true});
  ASSERT_TRUE(taken);
  const Opened file = opened(*gltf_bytes(model, *taken));
  EXPECT_EQ(file.json["meshes"][0]["primitives"][0]["targets"].size(), 16u);
}

// A cubic Bézier curve of a Lottie path at a parameter.
std::array<double, 2> on_path(const Json& path, std::size_t curve, double s) {
  std::array<double, 2> point{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::size_t next = (curve + 1) % path["v"].size();
    const double from = path["v"][curve][axis], to = path["v"][next][axis];
    const double out = from + path["o"][curve][axis].get<double>(), in = to + path["i"][next][axis].get<double>();
    const double r = 1 - s;
    point[axis] = r * r * r * from + 3 * r * r * s * out + 3 * r * s * s * in + s * s * s * to;
  }
  return point;
}

TEST(Lottie, PathsAreTheSplineItself) {
  const Model model = flame_model();
  const auto taken = take(model, {.seconds = 1});
  const auto text = lottie_text(model, *taken, 400);
  ASSERT_TRUE(text);
  const Json layer = Json::parse(*text)["layers"][0];
  const Json& path_keys = layer["shapes"][0]["it"][0]["ks"]["k"];
  ASSERT_EQ(path_keys.size(), taken->frames);
  for (std::size_t t = 0; t + 1 < taken->frames; ++t) {
    const auto points = outline_of(model, *taken, t, 0, 51);
    const Json& path = path_keys[t]["s"][0];
    ASSERT_EQ(path["v"].size(), 6u);  // eight control points make five curves
    // Both are the same points but for the scale and the place of the picture.
    const auto first = on_path(path, 0, 0), last = on_path(path, 4, 1);
    const double scale = (last[0] - first[0]) / (points[100] - points[0]);
    for (std::size_t k = 0; k <= 50; ++k) {
      const std::size_t curve = std::min<std::size_t>(4, k / 10);
      const auto found = on_path(path, curve, (static_cast<double>(k) - 10.0 * static_cast<double>(curve)) / 10);
      EXPECT_NEAR(found[0] - first[0], scale * (points[2 * k] - points[0]), 0.02);
      EXPECT_NEAR(found[1] - first[1], -scale * (points[2 * k + 1] - points[1]), 0.02);
    }
  }
}

TEST(Lottie, AnAnimationOfOneFrameHasItsShape) {
  const Model model = flame_model();
  const auto taken = take(model, {.seconds = 1.2 / model.rate_hz});
  ASSERT_EQ(taken->frames, 1u);
  const auto text = lottie_text(model, *taken);
  ASSERT_TRUE(text);
  const Json layer = Json::parse(*text)["layers"][0];
  const Json& path_keys = layer["shapes"][0]["it"][0]["ks"]["k"];
  ASSERT_EQ(path_keys.size(), 2u);  // the frame, and the end
  EXPECT_EQ(path_keys[0]["s"][0]["v"].size(), 6u);
}

#ifdef WISP_HAS_RLOTTIE
// Opaque pixels of a frame, and the picture.
double filled_by_rlottie(const std::string& text, std::size_t frame, std::size_t& width, std::size_t& height,
                         std::vector<std::uint32_t>& pixels) {
  Lottie_Animation* animation =
      lottie_animation_from_data(text.c_str(), std::to_string(std::hash<std::string>()(text)).c_str(), "");
  EXPECT_TRUE(animation);
  lottie_animation_get_size(animation, &width, &height);
  pixels.assign(width * height, 0);
  lottie_animation_render(animation, frame, pixels.data(), width, height, width * 4);
  lottie_animation_destroy(animation);
  double filled = 0;
  for (const std::uint32_t pixel : pixels) filled += (pixel >> 24) / 255.0;
  return filled;
}

// The body alone, opaque, fills the outline and the drop below its base.
TEST(Lottie, RlottieFillsTheOutline) {
  const Model model = flame_model();
  const auto taken = take(model, {.seconds = 1});
  const auto text = lottie_text(model, *taken, 400);
  auto json = nlohmann::ordered_json::parse(*text);  // rlottie wants a shape's type first
  auto& shapes = json["layers"][0]["shapes"];
  ASSERT_EQ(shapes.size(), 4u);
  while (shapes.size() > 1) shapes.erase(0);
  auto& stops = shapes[0]["it"][1]["g"];
  const auto colours = 4 * stops["p"].get<std::size_t>();
  for (std::size_t k = colours + 1; k < stops["k"]["k"].size(); k += 2) stops["k"]["k"][k] = 1;
  for (const std::size_t frame : {0u, 7u, 28u}) {
    std::vector<std::array<double, 2>> polygon;
    const Json path = Json::parse(shapes[0]["it"][0]["ks"]["k"][frame]["s"][0].dump());
    for (std::size_t k = 0; k < 120; ++k) polygon.push_back(on_path(path, k / 20, static_cast<double>(k % 20) / 20));
    double area = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    std::size_t width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
    const double filled = filled_by_rlottie(json.dump(), frame, width, height, pixels);
    EXPECT_EQ(height, 400u);
    EXPECT_NEAR(filled, std::abs(area), 0.01 * std::abs(area)) << frame;
  }
}

// Blue at the base, warm and bright in the middle, round below: no flat orange lollipop.
TEST(Lottie, AFlameIsBlueAtItsBaseAndBrightInside) {
  const Model model = *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  const auto taken = take(model, {.seconds = 1});
  std::size_t width = 0, height = 0;
  std::vector<std::uint32_t> pixels;
  filled_by_rlottie(*lottie_text(model, *taken, 400), 7, width, height, pixels);
  // Premultiplied: the mean of all that a row has.
  const auto mean_of = [&](double share, int shift) {
    double sum = 0, weight = 1e-9;
    const auto row = static_cast<std::size_t>(share * static_cast<double>(height));
    for (std::size_t x = 0; x < width; ++x) {
      sum += pixels[row * width + x] >> shift & 0xff;
      weight += (pixels[row * width + x] >> 24) / 255.0;
    }
    return sum / weight;
  };
  constexpr int kRed = 16, kGreen = 8, kBlue = 0;
  EXPECT_GT(mean_of(0.93, kBlue), mean_of(0.93, kRed));
  EXPECT_GT(mean_of(0.55, kRed), 1.2 * mean_of(0.55, kBlue));
  EXPECT_GT(mean_of(0.55, kGreen), 1.2 * mean_of(0.12, kGreen));
}
#endif

TEST(Export, WhatHasNoShapeIsRefusedWithAReason) {
  Model plain = flame_model();
  plain.view = PlainView{};
  const auto taken = take(plain, {.seconds = 1});
  EXPECT_NE(gltf_bytes(plain, *taken).error().message.find("neither an outline nor a body"), std::string::npos);
  EXPECT_NE(lottie_text(plain, *taken).error().message.find("no outline"), std::string::npos);
  EXPECT_NE(gltf_bytes(leaf(), *taken).error().message.find("expected one of this model"), std::string::npos);
  const Model flame = flame_model();
  EXPECT_NE(lottie_text(flame, *taken, 3).error().message.find("expected 16 to 8192"), std::string::npos);
}

}  // namespace
}  // namespace wisp::export_test
