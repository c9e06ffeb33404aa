// `wisp learn arx --partial` and `--merge`: a fit in parts, by hand and by job engines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "cli/program.hpp"
#include "paths.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::learn_arx_parts_test {
namespace {

using testing::HasSubstr;

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

class LearnArxParts : public InFolder {
 protected:
  void SetUp() override { write_system(); }

  // Two outputs, an input, two episodes and one too short, one missing sample.
  void write_system() {
    std::mt19937 random(3);
    const auto noise = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
    Recording recording{
        .source = "",
        .rate_hz = 50,
        .channels = {
            {"push", "N", Role::kInput, {}}, {"here", "m", Role::kOutput, {}}, {"there", "m", Role::kOutput, {}}}};
    auto &u = recording.channels[0].samples, &a = recording.channels[1].samples, &b = recording.channels[2].samples;
    for (int t = 0; t < 4000; ++t) {
      u.push_back(3 + noise());
      a.push_back(t < 2 ? 0 : 1.4 * a[t - 1] - 0.7 * a[t - 2] + 0.1 * b[t - 1] + u[t - 1] + 0.1 * noise());
      b.push_back(t < 2 ? 0 : 0.6 * b[t - 1] - 0.2 * a[t - 1] + 0.3 * u[t - 2] + 0.1 * noise());
      recording.episode_ids.push_back(t < 1500 ? 1 : t < 1502 ? 2 : 3);
    }
    a[777] = std::numeric_limits<double>::quiet_NaN();
    ASSERT_TRUE(write_csv(folder_ / "system.csv", recording));
  }

  std::string whole() const { return at("system.csv") + " --inputs push --outputs here,there --na 3 --nb 2 --nk 1"; }

  std::string write_parts(int count, const std::string& more = "") {
    std::string names;
    for (int k = 1; k <= count; ++k) {
      const std::string name = at(std::to_string(k) + ".part");
      const Said said = wisp("learn arx " + whole() + " --part " + std::to_string(k) + "/" + std::to_string(count) +
                             " --partial " + name + " " + more);
      EXPECT_EQ(said.status, 0) << said.err;
      names = " " + name + names;  // the last first
    }
    return names;
  }

  // Rounding of 1e-16 times the condition number (below 1e3) and a few hundred additions.
  static void expect_same(const nlohmann::json& got, const nlohmann::json& want) {
    for (const char* field : {"A", "B", "std_error", "V", "noise_covariance", "fpe", "aic", "aicc", "bic"}) {
      const auto flat = want[field].flatten();
      ASSERT_EQ(got[field].flatten().size(), flat.size()) << field;
      for (const auto& [place, value] : flat.items()) {
        EXPECT_NEAR(got[field].flatten()[place].get<double>(), value.get<double>(),
                    1e-11 * std::max(1.0, std::abs(value.get<double>())))
            << field << place;
      }
    }
    for (const char* field : {"na", "nb", "nk", "samples_used", "first_sample", "episodes", "rows_left_out"}) {
      EXPECT_EQ(got[field], want[field]) << field;
    }
  }

  nlohmann::json in_one(const std::string& more = "") {
    const Said said = wisp("learn arx " + whole() + " -o " + at("whole.wisp") + " --json " + more);
    EXPECT_EQ(said.status, 0) << said.err;
    return said.json();
  }
};

TEST_F(LearnArxParts, HoweverTheRowsAreCutTheModelIsTheSame) {
  const auto want = in_one();
  for (int count : {1, 2, 7}) {
    const Said said = wisp("learn arx --merge" + write_parts(count) + " -o " + at("merged.wisp") + " --json");
    ASSERT_EQ(said.status, 0) << said.err;
    expect_same(said.json(), want);
    EXPECT_TRUE(std::filesystem::exists(at("merged.wisp")));
  }
}

TEST_F(LearnArxParts, RangesAndSeveralRecordingsAreCutAlike) {
  std::ofstream(at("second.csv")) << file_text(at("system.csv")) << "3,1,2,3\n";
  const std::string more = at("second.csv") + " --range 101:3001 --offset estimate";
  const auto want = in_one(more);
  const Said said =
      wisp("learn arx --merge" + write_parts(3, more) + " -o " + at("merged.wisp") + " --offset estimate --json");
  ASSERT_EQ(said.status, 0) << said.err;
  expect_same(said.json(), want);
}

TEST_F(LearnArxParts, PartsAreMergedIntoAPart) {
  const auto want = in_one();
  write_parts(3);
  ASSERT_EQ(wisp("learn arx --merge " + at("1.part") + " " + at("3.part") + " --partial " + at("13.part")).status, 0);
  const Said said = wisp("learn arx --merge " + at("2.part") + " " + at("13.part") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  expect_same(said.json(), want);
}

TEST_F(LearnArxParts, ModelsFromPartsKnowUnitsRangesAndRate) {
  in_one();
  ASSERT_EQ(wisp("learn arx --merge" + write_parts(2) + " -o " + at("merged.wisp")).status, 0);
  const auto whole = wisp("info --json " + at("whole.wisp")).json();
  const auto merged = wisp("info --json " + at("merged.wisp")).json();
  for (const char* field : {"rate_hz", "inputs", "outputs", "cost"}) EXPECT_EQ(merged[field], whole[field]) << field;
}

TEST_F(LearnArxParts, LargeTablesAreReadAStretchAtATimeToTheSameResult) {
  const auto want = in_one("--range 2:3999");
  const auto streamed = in_one("--range 2:3999 --memory 0");
  expect_same(streamed, want);
  EXPECT_NEAR(streamed["fit_percent"]["inf"][1], want["fit_percent"]["inf"][1].get<double>(), 1e-9);
  const Said beyond = wisp("learn arx " + whole() + " -o " + at("m.wisp") + " --range 2:4001 --memory 0");
  EXPECT_EQ(beyond.status, 1);
  EXPECT_THAT(beyond.err, HasSubstr("rows 2:4001 were requested, which reach beyond its end"));
}

TEST_F(LearnArxParts, ADamagedPartIsNamedAndNothingIsWritten) {
  const std::string parts = write_parts(2);
  const std::string good = file_text(at("1.part"));
  std::string bytes = good;
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(at("1.part"), std::ios::binary) << bytes;
  const Said changed = wisp("learn arx --merge" + parts + " -o " + at("m.wisp"));
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.err, HasSubstr("1.part: this part of a fit was changed (its hash differs)"));

  std::ofstream(at("1.part"), std::ios::binary) << good.substr(0, good.size() - 8);
  EXPECT_THAT(wisp("learn arx --merge" + parts + " -o " + at("m.wisp")).err,
              HasSubstr("1.part: this part of a fit is cut short"));

  bytes = good;
  bytes[8] = 9;
  std::ofstream(at("1.part"), std::ios::binary) << bytes;
  EXPECT_THAT(wisp("learn arx --merge" + parts + " -o " + at("m.wisp")).err,
              HasSubstr("1.part: this part of a fit has format version 9, expected 4"));

  const Said table = wisp("learn arx --merge " + at("system.csv") + " -o " + at("m.wisp"));
  EXPECT_THAT(table.err, HasSubstr("system.csv: this is not a part of a fit"));
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
}

TEST_F(LearnArxParts, PartsOfDifferentModelsAreNotMerged) {
  write_parts(1);
  ASSERT_EQ(wisp("learn arx " + whole() + " --nb 3 --partial " + at("other.part")).status, 2) << "--nb twice";
  const std::string other = "learn arx " + at("system.csv") + " --inputs push --outputs here,there --na 3 --nb 3 ";
  ASSERT_EQ(wisp(other + "--partial " + at("other.part")).status, 0);
  const Said said = wisp("learn arx --merge " + at("1.part") + " " + at("other.part") + " -o " + at("m.wisp"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("other.part: cannot be merged with " + at("1.part")));
  EXPECT_THAT(said.err, HasSubstr("their orders differ"));
}

TEST_F(LearnArxParts, WhatIsMissingOnTheCommandLineIsNamed) {
  EXPECT_EQ(wisp("learn arx " + whole()).status, 2);
  EXPECT_THAT(wisp("learn arx " + whole()).err, HasSubstr("--output"));
  EXPECT_THAT(wisp("learn arx " + at("system.csv") + " --partial " + at("p.part")).err, HasSubstr("--outputs"));
  EXPECT_THAT(wisp("learn arx " + whole() + " --partial " + at("p.part") + " --focus auto").err,
              HasSubstr("--focus auto needs the recordings in one place"));
  for (const char* share : {"0/2", "3/2", "1", "1/0", "a/b", "1/2/3"}) {
    const Said said = wisp("learn arx " + whole() + " --partial " + at("p.part") + " --part " + share);
    EXPECT_EQ(said.status, 2) << share;
    EXPECT_THAT(said.err, HasSubstr("expected K/N")) << share;
  }
  EXPECT_FALSE(std::filesystem::exists(at("p.part")));
}

TEST_F(LearnArxParts, FlagsThatNeedRowsOrContradictThePartsDoNotGoWithMerge) {
  const std::string parts = write_parts(2);
  for (const char* flag : {"--search na=1:2", "--range 1:100", "--inputs push", "--outputs here", "--na 9",
                           "--coupling diagonal", "--rate 3", "--columns a,b"}) {
    const Said said = wisp("learn arx --merge" + parts + " -o " + at("m.wisp") + " " + flag);
    EXPECT_EQ(said.status, 2) << flag;
    EXPECT_THAT(said.err, HasSubstr("does not go with --merge: parts hold no rows")) << flag;
  }
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
}

TEST_F(LearnArxParts, APartIsWrittenInThePlaceOfAModelNotBesideIt) {
  for (const std::string& flag : {"-o " + at("m.wisp"), "--figures " + at("figures")}) {
    const Said said = wisp("learn arx " + whole() + " --partial " + at("p.part") + " " + flag);
    EXPECT_EQ(said.status, 2) << flag;
    EXPECT_THAT(said.err, HasSubstr("is of a model, and --partial writes a part instead")) << flag;
  }
  EXPECT_FALSE(std::filesystem::exists(at("p.part")));
}

TEST_F(LearnArxParts, APartTwiceOrOneMissingIsRefused) {
  const std::string parts = write_parts(3);
  const Said twice = wisp("learn arx --merge" + parts + " " + at("2.part") + " -o " + at("m.wisp"));
  EXPECT_EQ(twice.status, 1);
  EXPECT_THAT(twice.err, HasSubstr("2.part: cannot be merged with"));
  EXPECT_THAT(twice.err, HasSubstr("of system.csv are in both"));
  const Said missing = wisp("learn arx --merge " + at("1.part") + " " + at("3.part") + " -o " + at("m.wisp"));
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.err, HasSubstr("of system.csv are in no part: merge the part that is missing"));
  EXPECT_EQ(wisp("learn arx --merge " + at("1.part") + " -o " + at("m.wisp")).status, 1);
  const Said fewer =
      wisp("learn arx --merge " + at("1.part") + " " + at("3.part") + " --expect 3 --partial " + at("p.part"));
  EXPECT_THAT(fewer.err, HasSubstr("found 2 parts, expected 3"));
  EXPECT_FALSE(std::filesystem::exists(at("m.wisp")));
  EXPECT_FALSE(std::filesystem::exists(at("p.part")));
  const Said all = wisp("learn arx --merge" + parts + " --expect 3 --json -o " + at("m.wisp"));
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_EQ(all.json()["parts"], 3);
  EXPECT_EQ(all.json()["covered"][0]["source"], "system.csv");
}

// examples/06_parallel_fit, by each of its launchers, with two workers.
class LearnArxExample : public LearnArxParts, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    // No launcher is among what Wisp needs: a machine without one has nothing to try here.
    if (!installed(GetParam())) GTEST_SKIP() << GetParam() << " is not installed (script/bootstrap does it)";
    write_system();
    std::filesystem::create_directory(at("left"));
  }

  // What the example says goes to the file `said`; what it leaves behind, to the folder `left`.
  int run_example(const std::string& program) {
    // Open MPI refuses root and more ranks than cores unless told; in a container both are usual.
    const std::string line =
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 PARTS=" +
        at("left") + " TMPDIR=" + at("left") + " WISP=" + program + " " + WISP_SOURCE_DIR +
        "/examples/06_parallel_fit/with_" + GetParam() + " arx 2 " + at("spread.wisp") + " " + whole() + " >" +
        at("said") + " 2>&1 </dev/null";
    return std::system(line.c_str());
  }
};

INSTANTIATE_TEST_SUITE_P(, LearnArxExample, testing::Values("parallel", "mpirun"),
                         [](const auto& launcher) { return std::string(launcher.param); });

TEST_P(LearnArxExample, SpreadsTheWorkOverTwoWorkers) {
  const auto want = in_one();
  ASSERT_EQ(run_example(WISP_PROGRAM), 0) << file_text(at("said"));
  const auto spread = wisp("info --json " + at("spread.wisp")).json();
  EXPECT_EQ(spread["made"]["sources"], (nlohmann::json{"system.csv"}));
  EXPECT_EQ(spread["made"]["figures"]["samples_used"], want["samples_used"]);
  EXPECT_NEAR(spread["made"]["figures"]["fpe"].get<double>() / want["fpe"].get<double>(), 1, 1e-11);
}

TEST_P(LearnArxExample, LeavesNoModelWhereAWorkerIsKilled) {
  std::ofstream(at("dies")) << "#!/bin/sh\ncase \"$*\" in *'--part 2/2'*) kill -9 $$ ;; esac\nexec " << WISP_PROGRAM
                            << " \"$@\"\n";
  std::filesystem::permissions(at("dies"), std::filesystem::perms::owner_all);
  EXPECT_NE(run_example(at("dies")), 0) << file_text(at("said"));
  EXPECT_FALSE(std::filesystem::exists(at("spread.wisp")));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(at("left"))) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

}  // namespace
}  // namespace wisp::learn_arx_parts_test
