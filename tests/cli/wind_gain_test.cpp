// Several recordings, heard by one microphone or by two: learned, asked for, validated, by the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/program.hpp"
#include "learn/outline/made_outline.hpp"
#include "record/loudness.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::wind_gain_test {
namespace {

using testing::HasSubstr;

class WindGainProgram : public InFolder {
 protected:
  // A recording whose tracker called 1 what is `gusts` times as strong as in the others.
  void write_heard(const std::string& name, std::uint64_t seed, double gusts) {
    Recording out = made::outline_recording({.rows = 900, .shock = 0.003, .wind = true, .seed = seed});
    for (double& value : out.channels[*find_channel(out, "wind")].samples) value /= gusts;
    set_one_rms(out, "wind", 0.04 * gusts * gusts);
    ASSERT_TRUE(write_csv(at(name), out));
  }

  Said learned(const std::string& flags = "") {
    return wisp("learn flame " + at("soft.csv") + " " + at("loud.csv") + " -o " + at("m.wisp") + " --json " + flags);
  }
};

TEST_F(WindGainProgram, OneMicrophoneIsFoundOutAndKept) {
  write_heard("soft.csv", 1, 1);
  write_heard("loud.csv", 2, 2.5);
  write_heard("later.csv", 3, 1.6);
  const Said said = learned();
  ASSERT_EQ(said.status, 0) << said.err;
  const auto gain = said.json()["gain"];
  EXPECT_NEAR(gain["factors"][0].get<double>(), 0.4, 1e-9);
  const Said told = wisp("validate " + at("m.wisp") + " " + at("later.csv"));
  EXPECT_THAT(told.out + told.err, HasSubstr("times  0.64"));
  EXPECT_THAT(told.out + told.err, HasSubstr("--own-gain"));
}

TEST_F(WindGainProgram, ARunHearsARecordingAsLoudAsValidationDoes) {
  write_heard("soft.csv", 1, 1);
  write_heard("loud.csv", 2, 2.5);
  write_heard("later.csv", 3, 1.6);
  ASSERT_EQ(learned().status, 0);
  const auto strongest = [&](const std::string& name, const std::string& flags = "") {
    if (name == "run.csv") {
      const Said said = wisp("run " + at("m.wisp") + " --input " + at("later.csv") + " -o " + at(name) + " " + flags);
      EXPECT_EQ(said.status, 0) << said.err;
    }
    const Recording recording = *read_csv(at(name));
    const auto& wind = recording.channels[*find_channel(recording, "wind")].samples;
    return *std::max_element(wind.begin(), wind.end());
  };
  const double recorded = strongest("later.csv");
  const double scale = wisp("info " + at("m.wisp") + " --json").json()["training"]["inputs"][0]["scale"].get<double>();
  EXPECT_NEAR(strongest("run.csv"), 0.64 * recorded / scale, 1e-4 * recorded);  // written with single precision
  EXPECT_NEAR(strongest("run.csv", "--own-gain"), 1.1, 0.4);                    // 1 is its 95th percentile
}

// With gusts six times as strong in one of two recordings the training's 1 is far from either's.
TEST_F(WindGainProgram, ARunMovesAsFarAsThePredictionDoes) {
  write_heard("soft.csv", 1, 1);
  write_heard("loud.csv", 2, 6);
  write_heard("later.csv", 3, 1.6);
  ASSERT_EQ(learned().status, 0);
  ASSERT_EQ(wisp("run " + at("m.wisp") + " --input " + at("later.csv") + " --noise off -o " + at("run.csv")).status, 0);
  ASSERT_EQ(wisp("predict " + at("m.wisp") + " " + at("later.csv") + " --steps inf -o " + at("free.csv")).status, 0);
  const auto spread = [&](const std::string& file, const std::string& channel) {
    const Recording recording = *read_csv(at(file));
    std::vector<double> samples = recording.channels[*find_channel(recording, channel)].samples;
    samples.erase(samples.begin(), samples.begin() + 60);  // both have their starts behind them
    std::erase_if(samples, [](double value) { return std::isnan(value); });
    std::sort(samples.begin(), samples.end());
    return samples[samples.size() * 9 / 10] - samples[samples.size() / 10];
  };
  const auto view = wisp("info " + at("m.wisp") + " --json").json()["view"];
  const double unit = view["pixels_per_unit"].get<double>();
  for (const std::string channel : {"p3.y", "p4.y"}) {
    const double played = spread("run.csv", channel), predicted = spread("free.csv", channel + ".predicted") / unit;
    EXPECT_NEAR(played / predicted, 1, 0.05) << channel;
  }
}

TEST_F(WindGainProgram, ABadLoudnessStopsBeforeAnythingIsWritten) {
  write_heard("soft.csv", 1, 1);
  Recording bad = *read_csv(at("soft.csv"));
  set_one_rms(bad, "wind", 0);
  ASSERT_TRUE(write_csv(at("loud.csv"), bad));
  const Said said = learned();
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("loud.csv"));
  EXPECT_THAT(said.err, HasSubstr("wind.one_rms"));
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
}

}  // namespace
}  // namespace wisp::wind_gain_test
