// `wisp learn arx`, `info` and `run` on a small recording.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "cli/program.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::learn_arx_test {
namespace {

using testing::HasSubstr;

class LearnArx : public InFolder {
 protected:
  void SetUp() override { write_system(); }

  // y(t) = 1.5 y(t−1) − 0.7 y(t−2) + 0.5 u(t−1) + 0.25 u(t−2), without noise.
  void write_system() {
    std::mt19937 random(1);
    Recording recording{
        .source = "", .rate_hz = 10, .channels = {{"push", "N", Role::kInput, {}}, {"place", "m", Role::kOutput, {}}}};
    auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
    for (int t = 0; t < 500; ++t) {
      u.push_back(static_cast<double>(random() % 1000) / 500 - 1);
      y.push_back(t < 2 ? 0 : 1.5 * y[t - 1] - 0.7 * y[t - 2] + 0.5 * u[t - 1] + 0.25 * u[t - 2]);
    }
    ASSERT_TRUE(write_csv(folder_ / "system.csv", recording));
  }

  std::string learn(const std::string& more) const {
    return "learn arx " + at("system.csv") + " -o " + at("m.wisp") +
           " --inputs push --outputs place --offset none --json " + more;
  }
};

TEST_F(LearnArx, FindsTheCoefficientsThatMadeTheData) {
  const Said said = wisp(learn("--na 2 --nb 2 --nk 1"));
  ASSERT_EQ(said.status, 0) << said.err;
  const auto json = said.json();
  // Noiseless data: what is left is rounding, 1e-16 times a condition number below 1e3.
  EXPECT_NEAR(json["A"][0][0][0], -1.5, 1e-12);
  EXPECT_NEAR(json["A"][0][0][1], 0.7, 1e-12);
  EXPECT_NEAR(json["B"][0][0][0], 0.5, 1e-12);
  EXPECT_NEAR(json["B"][0][0][1], 0.25, 1e-12);
  EXPECT_EQ(json["first_sample"], 2);
  EXPECT_EQ(json["samples_used"], 498);
  EXPECT_FALSE(json["stable"]["changed"]);
  EXPECT_TRUE(std::filesystem::exists(at("m.wisp")));
}

TEST_F(LearnArx, TheModelIsDescribedAndRun) {
  ASSERT_EQ(wisp(learn("--na 2 --nb 2 --nk 1")).status, 0);
  const Said info = wisp("info --json " + at("m.wisp"));
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_EQ(info.json()["cost"]["multiply_adds_per_frame"], 4);
  EXPECT_EQ(info.json()["inputs"][0]["name"], "push");

  const std::string run = "run " + at("m.wisp") + " --input " + at("system.csv") + " --noise off -o ";
  ASSERT_EQ(wisp(run + at("a.csv")).status, 0);
  ASSERT_EQ(wisp(run + at("b.csv")).status, 0);
  EXPECT_EQ(file_text(at("a.csv")), file_text(at("b.csv")));
  const auto truth = read_csv(folder_ / "system.csv"), run_back = read_csv(folder_ / "a.csv");
  ASSERT_TRUE(truth && run_back);
  ASSERT_EQ(run_back->rows(), truth->rows());
  // In single precision, rounding of 3e-7 of outputs below 10 adds up to about 3e-5 over the system's memory; the first
  // rows differ by how the two start, which dies as 0.84^row and is gone after 120.
  double worst = 0;
  for (std::size_t row = 120; row < truth->rows(); ++row) {
    worst = std::max(worst, std::abs(run_back->channels[1].samples[row] - truth->channels[1].samples[row]));
  }
  EXPECT_LT(worst, 1e-4);
}

TEST_F(LearnArx, AMatrixOfTheWrongShapeIsExplained) {
  const Said said =
      wisp("learn arx " + at("system.csv") + " -o " + at("m.wisp") + " --inputs push --outputs place --na '2,2;2,2'");
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("expected 1 × 1"));
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
}

TEST_F(LearnArx, ABadRecordingIsNamedOrLeftOut) {
  std::ofstream(folder_ / "bad.csv") << "# wisp-recording 1\n# rate_hz 10\nu:push,y:place\n1,x\n";
  const std::string both = "learn arx " + at("bad.csv") + " " + at("system.csv") + " -o " + at("m.wisp") +
                           " --inputs push --outputs place --na 2 --nb 2 --json ";
  const Said strict = wisp(both);
  EXPECT_EQ(strict.status, 1);
  EXPECT_THAT(strict.err, HasSubstr("bad.csv, row 4"));
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
  const Said lenient = wisp(both + "--skip-bad");
  EXPECT_EQ(lenient.status, 0) << lenient.err;
  EXPECT_EQ(lenient.json()["skipped"].size(), 1u);
}

TEST_F(LearnArx, ARecordingThatIsShorterThanTheRangeIsLeftOutToo) {
  std::ofstream(folder_ / "short.csv") << "# wisp-recording 1\n# rate_hz 10\nu:push,y:place\n1,2\n3,4\n";
  const std::string both = "learn arx " + at("short.csv") + " " + at("system.csv") +
                           " --inputs push --outputs place --na 2 --nb 2 --range 1:100 --json ";
  EXPECT_THAT(wisp(both).err, HasSubstr("short.csv: --range 1:100 reaches beyond its 2 rows"));
  const Said lenient = wisp(both + "--skip-bad");
  EXPECT_EQ(lenient.status, 0) << lenient.err;
  EXPECT_EQ(lenient.json()["skipped"].size(), 1u);
}

TEST_F(LearnArx, AnOutputNamedTwiceIsWrongUsage) {
  const Said said = wisp("learn arx " + at("system.csv") + " --inputs push --outputs place,place --json");
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("--outputs names 'place' twice"));
}

TEST_F(LearnArx, ADamagedModelIsRefusedByEveryCommand) {
  ASSERT_EQ(wisp(learn("--na 2 --nb 2 --nk 1")).status, 0);
  std::string bytes = file_text(at("m.wisp"));
  bytes[bytes.size() / 2] ^= 4;
  std::ofstream(at("m.wisp"), std::ios::binary) << bytes;
  for (const char* command : {"info ", "run --frames 10 -o never.csv "}) {
    const Said said = wisp(command + at("m.wisp"));
    EXPECT_EQ(said.status, 1) << command;
    EXPECT_THAT(said.err, HasSubstr("is damaged")) << command;
  }
}

TEST_F(LearnArx, ModesThatSwitchAreLearnedRunAndExplained) {
  const std::string learn =
      "learn switched " + at("system.csv") + " -o " + at("m.wisp") + " --inputs push --outputs place";
  const Said learned = wisp(learn + " --na 2 --nb 2 --nk 1 --modes 2 --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_EQ(learned.json()["mode_rows"].size(), 2u);
  EXPECT_EQ(learned.json()["seed"], 1);
  const Said judged = wisp("validate " + at("m.wisp") + " " + at("system.csv") + " --json");
  ASSERT_EQ(judged.status, 0) << judged.err;
  EXPECT_GT(judged.json()["channels"][0]["fit_percent"]["1"], 90);
  EXPECT_EQ(wisp("run " + at("m.wisp") + " --frames 20 -o " + at("a.csv")).status, 0);
  EXPECT_THAT(wisp("info " + at("m.wisp")).out, HasSubstr("2 modes"));
  EXPECT_EQ(wisp(learn + " --modes 0").status, 2);
}

}  // namespace
}  // namespace wisp::learn_arx_test
