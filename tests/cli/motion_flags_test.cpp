// Recordings of motion in another program's names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "cli/program.hpp"

namespace wisp::motion_flags_test {
namespace {

using testing::HasSubstr;

// A leaf that rocks about x and slides to the side that is lower: x, y, z up, then w, x, y, z.
std::array<double, 7> rocking(int fall, int row) {
  const double t = row / 60.0, rate = 18 + 0.7 * fall, tilt = (0.7 + 0.03 * fall) * std::sin(rate * t + fall);
  return {0.02 * t, 0.1 * std::sin(rate * t + fall), -0.7 * t, std::cos(tilt / 2), std::sin(tilt / 2), 0, 0};
}

class MotionFlags : public InFolder {
 protected:
  // Writes the same falls as `shown` has them.
  template <class Shown>
  std::string falls(const std::string& name, const std::string& header, Shown shown) {
    std::ostringstream out;
    out.precision(12);
    const bool own = header.find("y:") != std::string::npos;
    out << (own ? "# wisp-recording 1\n# rate_hz 60\n" : "") << header << '\n';
    for (int fall = 0; fall < 8; ++fall) {
      for (int row = 0; row < 120; ++row) {
        out << fall;
        for (double x : shown(rocking(fall, row))) out << ',' << x;
        out << '\n';
      }
    }
    std::ofstream(at(name)) << out.str();
    return at(name);
  }

  nlohmann::json learned(const std::string& file, const std::string& flags) {
    const Said said = wisp("learn leaf " + file + " -o " + at("m.wisp") + " --modes 2 --json " + flags);
    EXPECT_EQ(said.status, 0) << said.err;
    return said.json();
  }
};

TEST_F(MotionFlags, AnotherProgramsNamesAreTakenOver) {
  const auto plain = falls("plain.csv", "episode,y:pos.x[m],y:pos.y[m],y:pos.z[m],y:q.w,y:q.x,y:q.y,y:q.z",
                           [](const std::array<double, 7>& r) { return r; });
  // Quaternions in columns of other names and another order.
  const auto other = falls("other.csv", "episode,X,Y,Z,qx,qy,qz,qw", [](const std::array<double, 7>& r) {
    return std::array<double, 7>{r[0], r[1], r[2], r[4], r[5], r[6], r[3]};
  });
  const auto a = learned(plain, "");
  const auto b = learned(other, "--position X,Y,Z --orientation qw,qx,qy,qz --rate 60");
  EXPECT_EQ(a["segments"], b["segments"]);
  EXPECT_NEAR(a["mean_segment_seconds"], b["mean_segment_seconds"], 1e-6);
  EXPECT_NEAR(a["fidelity"]["real"]["descent_speed"], b["fidelity"]["real"]["descent_speed"], 1e-6);
}

TEST_F(MotionFlags, TheUsualNamesMayBeInAnotherOrder) {
  const auto plain = falls("plain.csv", "episode,pos.x,pos.y,pos.z", [](const std::array<double, 7>& r) {
    return std::array{r[0], r[1], r[2]};
  });
  const auto other = falls("other.csv", "episode,pos.z,pos.y,pos.x", [](const std::array<double, 7>& r) {
    return std::array{r[0], r[1], r[2]};
  });
  const std::string flags = "--rate 60 --event min:horizontal_speed";
  EXPECT_EQ(learned(other, flags + " --position pos.z,pos.y,pos.x")["fidelity"]["real"],
            learned(plain, flags)["fidelity"]["real"]);
}

TEST_F(MotionFlags, UsualNamesInAPlainTableNeedNoFlag) {
  const auto same = [](const std::array<double, 7>& r) { return r; };
  const auto own = falls("own.csv", "episode,y:pos.x[m],y:pos.y[m],y:pos.z[m],y:q.w,y:q.x,y:q.y,y:q.z", same);
  const auto plain = falls("plain.csv", "episode,pos.x,pos.y,pos.z,q.w,q.x,q.y,q.z", same);
  EXPECT_EQ(learned(own, "")["segments"], learned(plain, "--rate 60")["segments"]);
  const Said said = wisp("validate " + at("m.wisp") + " " + plain);
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(MotionFlags, UnevenTimeInAPlainTableIsAnErrorWithItsRow) {
  std::ofstream out(at("uneven.csv"));
  out << "t_s,X,Y,Z\n";
  for (int row = 0; row < 200; ++row) {
    out << row / 60.0 + (row < 150 ? 0 : 0.01);
    for (std::size_t axis = 0; axis < 3; ++axis) out << ',' << rocking(0, row)[axis];
    out << '\n';
  }
  out.close();
  EXPECT_THAT(wisp("learn chain " + at("uneven.csv") + " --position X,Y,Z --rate 60 -o " + at("m.wisp")).err,
              HasSubstr("row 151: time goes on by 0.02"));
}

TEST_F(MotionFlags, ColumnsThatAreNotThereAreErrors) {
  const auto plain = falls("plain.csv", "episode,y:pos.x[m],y:pos.y[m],y:pos.z[m],y:q.w,y:q.x,y:q.y,y:q.z",
                           [](const std::array<double, 7>& r) { return r; });
  EXPECT_THAT(wisp("learn leaf " + plain + " -o " + at("m.wisp") + " --position X,Y").err,
              HasSubstr("--position names 2 columns, expected 3"));
  EXPECT_THAT(wisp("learn leaf " + plain + " -o " + at("m.wisp") + " --position X,Y,Z").err,
              HasSubstr("has no column \"X\""));
}

}  // namespace
}  // namespace wisp::motion_flags_test
