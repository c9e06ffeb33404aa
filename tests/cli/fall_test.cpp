// From a film of falling paper to a chain, by the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::fall_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 240, kFallFrames = 48;

// A dark slip of paper that swings as it sinks before a light wall; every fall begins elsewhere in its swing.
Image paper_frame(int frame) {
  Image image(kWidth, kHeight);
  const int fall = frame / kFallFrames;
  const double seconds = frame % kFallFrames / 30.0, phase = 0.7 * fall;
  const double x = 80 + 25 * (std::sin(8 * seconds + phase) - std::sin(phase)), y = 30 + 170 * seconds;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double depth = std::min(12 - std::abs(u - x), 4 - std::abs(v - y));
      const auto grey = static_cast<std::uint32_t>(std::lround(210 - 130 * std::clamp(depth + 0.5, 0.0, 1.0)));
      image.row(v)[static_cast<std::size_t>(u)] = 0xFF000000U | grey << 16 | grey << 8 | grey;
    }
  }
  return image;
}

class FallFilm : public InFolder {
 protected:
  void write_film(const std::string& name, int falls) {
    auto film = VideoWriter::create(at(name), {.width = kWidth, .height = kHeight, .rate_hz = 30});
    ASSERT_TRUE(film) << film.error().message;
    for (int frame = 0; frame < falls * kFallFrames; ++frame) ASSERT_TRUE(film->write(paper_frame(frame)));
    ASSERT_TRUE(film->finish());
  }
};

TEST_F(FallFilm, BecomesFallsInMetresAndAChainThatRuns) {
  write_film("paper.mp4", 12);
  const Said captured = wisp("capture fall " + at("paper.mp4") + " --height 2.4 -o " + at("falls.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_EQ(captured.json()["falls"], 12);
  EXPECT_TRUE(captured.json()["tilt"]);
  EXPECT_EQ(captured.json()["fall"].size(), 12u);
  // 1.7 m/s, in a picture that shows 2.4 m.
  const auto recording = read_csv(at("falls.csv"), {});
  ASSERT_TRUE(recording) << recording.error().message;
  const auto& z = recording->channels[*find_channel(*recording, "pos.z")].samples;
  EXPECT_NEAR((z[0] - z[20]) * 30 / 20, 1.7, 0.02);
  for (const char* kind : {"chain", "leaf"}) {
    ASSERT_EQ(wisp(std::string("learn ") + kind + " " + at("falls.csv") + " --smooth 5 -o " + at("m.wisp")).status, 0)
        << kind;
    EXPECT_EQ(wisp("run " + at("m.wisp") + " --frames 60 -o " + at("run.csv")).status, 0) << kind;
  }
}

TEST_F(FallFilm, WithoutAFallIsRefusedInOneSentence) {
  auto film = VideoWriter::create(at("wall.mp4"), {.width = kWidth, .height = kHeight, .rate_hz = 30});
  ASSERT_TRUE(film);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(film->write(Image(kWidth, kHeight)));
  ASSERT_TRUE(film->finish());
  const Said said = wisp("capture fall " + at("wall.mp4") + " -o " + at("falls.csv"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("nothing moves"));
  EXPECT_FALSE(std::filesystem::exists(at("falls.csv")));
}

TEST_F(FallFilm, OfTooFewFallsTeachesNoModelThatIsCalledUsable) {
  write_film("two.mp4", 2);
  const Said captured = wisp("capture fall " + at("two.mp4") + " --height 2.4 -o " + at("falls.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_FALSE(captured.json()["usable"]["verdict"].get<bool>()) << captured.out;
  const Said learned = wisp("learn chain " + at("falls.csv") + " --modes 1 --holdout 0 -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_FALSE(learned.json()["usable"]["verdict"].get<bool>());
  EXPECT_THAT(learned.json()["usable"]["reason"].get<std::string>(), HasSubstr("captured as not usable: only 2 falls"));
}

}  // namespace
}  // namespace wisp::fall_test
