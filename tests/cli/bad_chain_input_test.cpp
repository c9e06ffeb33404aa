// Bad input to `learn leaf`, `validate` and `run` of a chain: each said what it is, nothing left behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "cli/program.hpp"
#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "wisp/model/file.hpp"

namespace wisp::bad_chain_input_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

// One row of a fall: pos.x pos.y pos.z q.w q.x q.y q.z.
using Row = std::vector<double>;

// A leaf that rocks about x and slides to the side that is lower, no two falls alike.
Row rocking(int fall, int row) {
  const double t = row / 60.0, rate = 18 + 0.7 * fall;
  const double tilt = (0.7 + 0.03 * fall) * std::sin(rate * t + fall);
  return {0.02 * t, 0.1 * std::sin(rate * t + fall), -0.7 * t, std::cos(tilt / 2), std::sin(tilt / 2), 0, 0};
}

struct Falls {
  int falls = 6;
  int rows = 120;
  std::string header = "episode,y:pos.x[m],y:pos.y[m],y:pos.z[m],y:q.w,y:q.x,y:q.y,y:q.z";
  std::string attributes = "# wisp-recording 1\n# rate_hz 60\n";
  std::function<Row(int, int)> of = rocking;
  std::function<std::string(int, int, const std::string&)> line = [](int, int, const std::string& text) {
    return text;
  };

  std::string text() const {
    std::ostringstream out;
    out.precision(12);
    out << attributes << header << '\n';
    for (int fall = 0; fall < falls; ++fall) {
      for (int row = 0; row < rows; ++row) {
        std::ostringstream cells;
        cells.precision(12);
        cells << fall;
        for (double x : of(fall, row)) cells << ',' << x;
        out << line(fall, row, cells.str()) << '\n';
      }
    }
    return out.str();
  }
};

class BadChainInput : public InFolder {
 protected:
  BadChainInput() {
    Model leaf = steered_chain();
    leaf.training.motion = MotionTraining{"zero:forward_speed", 0.04, 0.1, 0};
    EXPECT_TRUE(write_model(at("leaf.wisp"), leaf));
    EXPECT_TRUE(write_model(at("flame.wisp"), sample_model()));
  }

  std::string record(const std::string& name, const std::string& text) {
    std::ofstream(at(name), std::ios::binary) << text;
    return at(name);
  }
  std::string record(const std::string& name, const Falls& falls) { return record(name, falls.text()); }

  // What is said, one line; nothing is written.
  std::string refused(const std::string& arguments, int status = 1) {
    const auto before = names();
    const Said said = wisp(arguments);
    EXPECT_EQ(said.status, status) << arguments << '\n' << said.err;
    EXPECT_EQ(names(), before) << arguments;
    return said.err;
  }
  std::string not_learned(const std::string& recordings, const std::string& flags = "", int status = 1) {
    return refused("learn leaf " + recordings + " -o " + at("m.wisp") + " --quiet " + flags, status);
  }
  std::string not_validated(const std::string& recording, const std::string& flags = "") {
    return refused("validate " + at("leaf.wisp") + " " + recording + " --quiet " + flags);
  }

 private:
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("said.")) all.push_back(name);
    }
    std::sort(all.begin(), all.end());
    return all;
  }
};

TEST_F(BadChainInput, WhatIsTooShortIsNamed) {
  const struct {
    int rows;
    const char* words;
  } cases[] = {{0, "has a header but no rows"},
               {1, "has no stretch of 8 complete rows"},
               {7, "has no stretch of 8 complete rows"},
               {9, "has no two events of forward_speed"}};
  for (const auto& one : cases) {
    const auto path = record("short.csv", Falls{.falls = 1, .rows = one.rows});
    EXPECT_THAT(not_learned(path), StartsWith("wisp: " + path + ": " + one.words)) << one.rows;
    EXPECT_THAT(not_validated(path), StartsWith("wisp: " + path + ": has ")) << one.rows;
  }
  const auto empty = record("empty.csv", std::string());
  EXPECT_THAT(not_learned(empty), HasSubstr(empty + ": is empty, expected a header line"));
}

TEST_F(BadChainInput, ARecordingCutInHalfIsAnErrorAtItsLastLine) {
  const std::string whole = Falls{}.text();
  const auto path = record("half.csv", whole.substr(0, whole.size() / 2 + 5));
  EXPECT_THAT(not_learned(path), HasSubstr("half.csv, row "));
  EXPECT_THAT(not_validated(path), HasSubstr("the header has 8"));
}

TEST_F(BadChainInput, SamplesThatAreNoneAreNamed) {
  const auto gone = [](int, int, const std::string& text) { return text.substr(0, text.rfind(',') + 1); };
  EXPECT_THAT(not_learned(record("gone.csv", Falls{.line = gone})),
              HasSubstr("gone.csv: q.z has no sample in any of its 720 rows"));
  const auto gaps = [&](int fall, int row, const std::string& text) { return row % 5 ? text : gone(fall, row, text); };
  EXPECT_THAT(not_learned(record("gaps.csv", Falls{.line = gaps})), HasSubstr("has no stretch of 8 complete rows"));
  const auto word = [](int fall, int row, const std::string& text) {
    return fall == 0 && row == 2 ? text.substr(0, text.rfind(',') + 1) + "inf" : text;
  };
  EXPECT_THAT(not_learned(record("word.csv", Falls{.line = word})),
              HasSubstr("word.csv, row 6: found \"inf\", column 8, expected a finite number"));
}

TEST_F(BadChainInput, OrientationThatIsNoneOrOnlyInPartIsExplained) {
  const auto longer = [](int fall, int row) {
    Row all = rocking(fall, row);
    for (std::size_t k = 3; k < 7; ++k) all[k] *= 1.3;
    return all;
  };
  EXPECT_THAT(not_learned(record("long.csv", Falls{.of = longer})),
              HasSubstr("length 1.300000, expected 1 within 1 %"));
  EXPECT_THAT(not_validated(at("long.csv")), HasSubstr("row 1: the quaternion q has length 1.3"));
  const std::string positions = "episode,y:pos.x,y:pos.y,y:pos.z";
  const auto first = [](std::size_t count) {
    return [count](int fall, int row) {
      Row all = rocking(fall, row);
      all.resize(count);
      return all;
    };
  };
  const auto three = record("three.csv", Falls{.header = positions + ",y:q.w,y:q.x,y:q.y", .of = first(6)});
  EXPECT_THAT(not_learned(three), HasSubstr("has 3 of the channels q.w, q.x, q.y, q.z"));
  const auto none = record("none.csv", Falls{.header = positions, .of = first(3)});
  EXPECT_THAT(not_learned(none), HasSubstr("has no orientation, which the event's forward_speed needs"));
  EXPECT_THAT(not_learned(record("flat.csv", Falls{.header = "episode,y:pos.x,y:pos.y", .of = first(2)})),
              HasSubstr("has no channel pos.z"));
}

TEST_F(BadChainInput, PositionsThatAreNoMetresAreNamed) {
  const auto far = [](int fall, int row) {
    Row all = rocking(fall, row);
    all[0] = row == 50 ? 1e9 : 0;
    return all;
  };
  const auto path = record("far.csv", Falls{.of = far});
  EXPECT_THAT(not_learned(path), HasSubstr("far.csv: row 51: pos.x is 1e+09, expected metres, within 1000 km"));
  EXPECT_THAT(not_validated(path), HasSubstr("expected metres"));
}

TEST_F(BadChainInput, FewerSegmentsThanModesIsSaidInSegments) {
  const auto path = record("few.csv", Falls{.falls = 1, .rows = 60});
  EXPECT_THAT(not_learned(path, "--modes 50"),
              testing::AllOf(HasSubstr("few.csv: has "), HasSubstr("segments in all, expected at least as many as")));
}

TEST_F(BadChainInput, AnEventThatIsNoneIsExplained) {
  const auto path = record("falls.csv", Falls{});
  EXPECT_THAT(not_learned(path, "--event stall", 2),
              HasSubstr("--event: the event is \"stall\", expected zero:SIGNAL"));
  EXPECT_THAT(not_learned(path, "--event zero:flap"), HasSubstr("falls.csv: has no channel flap for the event"));
}

TEST_F(BadChainInput, FlagsOutsideTheirRangeAreWrongUsage) {
  const auto path = record("falls.csv", Falls{});
  for (const char* flag : {"--modes 0", "--modes 65", "--history 3", "--holdout 0.95", "--blend 0.6", "--best-of 257",
                           "--shortest=-1", "--debounce=-1", "--max-bytes 0"}) {
    EXPECT_THAT(not_learned(path, flag, 2), StartsWith("wisp: --")) << flag;
  }
}

TEST_F(BadChainInput, WhatCannotBeWrittenIsFoundBeforeAnythingIsRead) {
  const auto path = at("missing.csv");
  for (const std::string& output : {at("nowhere/m.wisp"), at(""), std::string("/proc/m.wisp")}) {
    EXPECT_THAT(refused("learn leaf " + path + " --quiet -o " + output), StartsWith("wisp: " + output)) << output;
  }
}

TEST_F(BadChainInput, FallsThatAreAllTheSameAreLearnedButNotUsable) {
  const auto path = record("same.csv", Falls{.of = [](int, int row) { return rocking(0, row); }});
  const Said said = wisp("learn leaf " + path + " -o " + at("m.wisp") + " --modes 2 --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("same.csv: 5 of 6 episodes repeat another"));
  EXPECT_EQ(said.json()["usable"]["verdict"], false);
  EXPECT_EQ(said.json()["repeated_episodes"], 5);
}

TEST_F(BadChainInput, ABadRecordingIsLeftOutWhereThatIsAskedFor) {
  const auto good = record("falls.csv", Falls{});
  const auto bad = record("bad.csv", Falls{.of = [](int, int) { return Row{0, 0, 0, 2, 0, 0, 0}; }});
  EXPECT_THAT(not_learned(good + " " + bad), HasSubstr("bad.csv: row 1: the quaternion"));
  const Said said = wisp("learn leaf " + good + " " + bad + " -o " + at("m.wisp") + " --modes 2 --skip-bad --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["skipped"].size(), 1u);
  EXPECT_THAT(not_learned(bad, "--skip-bad"), HasSubstr("bad.csv: none of the recordings can be used"));
}

TEST_F(BadChainInput, ASizeThatIsNoneIsExplained) {
  Falls falls;
  falls.attributes += "# leaf_length_width_density -4 0.05 0.07\n";
  EXPECT_THAT(not_learned(record("size.csv", falls)),
              HasSubstr("size.csv: \"# leaf_length_width_density\" begins with"));
}

// A pair of recordings, windy and calm, and what is wrong with the windy one.
class BadPair : public BadChainInput {
 protected:
  static constexpr const char* kHeader =
      "episode,u:wind.x,u:wind.y,u:wind.z,y:pos.x,y:pos.y,y:pos.z,y:q.w,y:q.x,y:q.y,y:q.z";

  static Falls gusts(double speed, const std::string& clones, const std::string& pair = "a") {
    Falls falls{.falls = 8, .rows = 60, .header = kHeader};
    falls.attributes += "# pair " + pair + "\n# clones " + clones + "\n";
    falls.of = [speed](int fall, int row) {
      Row all = {row > 20 && row < 40 ? speed : 0, 0, 0};
      for (double x : rocking(fall, row)) all.push_back(x);
      return all;
    };
    return falls;
  }

  std::string calm() { return record("calm.csv", gusts(0, "2")); }
};

TEST_F(BadPair, TwinsThatAreNoneAreRefused) {
  const auto falls = record("falls.csv", Falls{});
  const auto windy = record("windy.csv", gusts(1, "2"));
  const auto other = record("other.csv", gusts(1, "2", "b"));
  EXPECT_THAT(not_learned(falls + " " + windy), HasSubstr("is one of 1 recordings with the attribute pair"));
  EXPECT_THAT(not_learned(falls + " " + other + " " + calm()), HasSubstr("expected two of one pair"));
  EXPECT_THAT(not_learned(windy + " " + calm()), HasSubstr("expected recordings of calm falls beside it"));
  EXPECT_THAT(not_validated(windy), HasSubstr("expected its twin as a third argument"));
  EXPECT_THAT(not_validated(falls + " " + calm()), HasSubstr("is not one of a pair"));
  EXPECT_THAT(not_validated(other + " " + calm()), HasSubstr("expected two of one pair"));
  EXPECT_THAT(not_validated(windy + " " + calm() + " " + at("none.csv")), HasSubstr("none.csv: is one file too many"));
}

TEST_F(BadPair, ARangeIsOfBothTwins) {
  const auto windy = record("windy.csv", gusts(1, "2"));
  EXPECT_THAT(not_validated(windy + " " + calm(), "--range 1:120"), HasSubstr("have 2 and 2 episodes"));
}

TEST_F(BadPair, ClonesThatAreNoNumberOfEpisodesAreRefused) {
  const auto falls = record("falls.csv", Falls{});
  for (const char* clones : {"1e300", "-3", "2.5", "0"}) {
    const auto windy = record("windy.csv", gusts(1, clones));
    EXPECT_THAT(not_learned(falls + " " + windy + " " + calm()), HasSubstr("windy.csv: \"# clones\" is")) << clones;
    EXPECT_THAT(not_validated(windy + " " + calm()), HasSubstr("expected a whole number from 1 to")) << clones;
  }
  EXPECT_THAT(not_validated(record("windy.csv", gusts(1, "many")) + " " + calm()), HasSubstr("\"many\""));
  EXPECT_THAT(not_validated(record("windy.csv", gusts(1, "3")) + " " + calm()), HasSubstr("3 for each of at least 4"));
}

TEST_F(BadPair, AWindThatIsMissingIsNamed) {
  const auto falls = record("falls.csv", Falls{});
  Falls gap = gusts(1, "2");
  gap.line = [](int fall, int row, const std::string& text) {
    return fall == 1 && row == 5 ? "1,," + text.substr(text.find(',', 2) + 1) : text;
  };
  const auto windy = record("windy.csv", gap);
  EXPECT_THAT(not_learned(falls + " " + windy + " " + calm()), HasSubstr("windy.csv: row 66: has no wind.x"));
  EXPECT_THAT(not_validated(windy + " " + calm()), HasSubstr("windy.csv: row 66: has no wind.x"));
}

TEST_F(BadChainInput, AModelThatIsNoneOrNoChainIsExplained) {
  const auto falls = record("falls.csv", Falls{});
  EXPECT_THAT(refused("validate " + falls + " " + falls), HasSubstr("falls.csv: is not a .wisp model"));
  EXPECT_THAT(refused("validate " + at("flame.wisp") + " " + falls), HasSubstr("falls.csv: has 0 control points"));
  EXPECT_THAT(refused("validate " + at("flame.wisp") + " " + falls + " --film " + at("f.mp4"), 2),
              HasSubstr("--film is for segment chains of poses; this model is of an outline"));
  EXPECT_THAT(not_validated(falls, "--film " + at("f.gif")), HasSubstr("f.gif: cannot be written, expected a name"));
  EXPECT_THAT(not_validated(falls, "--film " + at("nowhere/f.mp4")), HasSubstr("nowhere does not exist"));
}

TEST_F(BadChainInput, AFallTooShortToBeMeasuredIsSaid) {
  const auto path = record("brief.csv", Falls{.falls = 1, .rows = 30});
  const Said said = wisp("validate " + at("leaf.wisp") + " " + path + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("brief.csv: its stretches are shorter than"));
  EXPECT_TRUE(said.json()["fidelity"]["energy_distance"]["value"].is_null());
}

TEST_F(BadChainInput, AChainWhoseFallsHaveNoEventsIsNotLikeRecordedFallsThatDo) {
  // The sample glides ahead all along.
  const auto path = record("brief.csv", Falls{.falls = 1, .rows = 40});
  const Said said = wisp("validate " + at("leaf.wisp") + " " + path + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["usable"]["verdict"], false);
  EXPECT_THAT(said.json()["usable"]["reason"], HasSubstr("its falls have no events"));
}

TEST_F(BadChainInput, ARunThatCannotBeIsExplained) {
  const auto falls = record("falls.csv", Falls{});
  const auto run = [&](const std::string& flags, int status) {
    return refused("run " + at("leaf.wisp") + " -o " + at("o.csv") + " " + flags, status);
  };
  EXPECT_THAT(run("", 2), HasSubstr("--frames is 0 or not given"));
  EXPECT_THAT(run("--frames 0", 2), HasSubstr("--frames is 0 or not given"));
  EXPECT_THAT(run("--frames 999999999 --instances 10000", 2), HasSubstr("numbers, expected at most 5e+08"));
  EXPECT_THAT(run("--frames 9 --instances 0", 2), HasSubstr("--instances: found \"0\", expected 1 to 10000"));
  EXPECT_THAT(refused("run " + falls + " --frames 9 -o " + at("o.csv")), HasSubstr("is not a .wisp model"));
  for (const char* name : {"/proc/o.csv", "/proc/o.png", "/proc/o.mp4"}) {
    EXPECT_THAT(refused("run " + at("leaf.wisp") + " --frames 9 -o " + name), HasSubstr("cannot be written")) << name;
  }
}

TEST_F(BadChainInput, WhatHasNoInputIsNotDriven) {
  const auto falls = record("falls.csv", Falls{});
  for (const std::string& flag : {"--input " + falls, std::string("--wind 3")}) {
    EXPECT_THAT(refused("run " + at("leaf.wisp") + " --frames 9 -o " + at("o.csv") + " " + flag, 2),
                HasSubstr("leaf.wisp has none"));
  }
  EXPECT_EQ(wisp("run " + at("leaf.wisp") + " --frames 9 --wind 0 -o " + at("o.csv")).status, 0);
}

}  // namespace
}  // namespace wisp::bad_chain_input_test
