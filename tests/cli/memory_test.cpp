// Commands of README and guides within a budget of address space, which `ulimit -v` holds them to: 300 MB to capture, 1
// GB for all others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/support/clip_files.hpp"
#include "capture/support/made_clip.hpp"
#include "cli/program.hpp"

namespace wisp::memory_test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowed = true;  // sanitizers reserve terabytes
#else
constexpr bool kShadowed = false;
#endif

class Memory : public InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    if (kShadowed) GTEST_SKIP() << "a sanitizer takes more address space than any budget";
  }

  // What a command says that fails within so many megabytes; empty: it does not.
  std::string fails_within(int megabytes, const std::string& arguments) {
    const std::string line = "cd " + folder_.string() + " && ulimit -v " + std::to_string(megabytes * 1000) +
                             " && " WISP_PROGRAM " " + arguments + " --quiet >said 2>&1 </dev/null";
    return std::system(line.c_str()) == 0 ? "" : arguments + ": " + file_text(at("said"));
  }
};

TEST_F(Memory, AFilmOfAFlameIsCapturedIn300MegabytesAndLearnedInAGigabyte) {
  {
    support::RawVideo video(at("flame.y4m"), 1920, 1080, 30);
    for (int k = 0; k < 90; ++k) {
      support::Plane plane(1920, 1080, 8);
      support::Flame flame = support::swaying(k);
      flame.base_x += 800;
      flame.base_y += 500;
      support::paint(plane, 230, 3, [&](double x, double y) { return flame.depth(x, y); });
      support::add_noise(plane, static_cast<unsigned>(k));
      video.add(plane);
    }
  }
  EXPECT_EQ(fails_within(300, "capture flame flame.y4m -o flame.csv"), "");
  EXPECT_EQ(fails_within(1000, "learn outline flame.csv -o flame.wisp"), "");
  for (const char* command :
       {"validate flame.wisp flame.csv --film-strip strip.png", "run flame.wisp --frames 60 -o flame.mp4",
        "info flame.wisp", "report flame.wisp flame.csv -o flame.html", "export flame.wisp --loop 2 -o flame.png"}) {
    EXPECT_EQ(fails_within(1000, command), "");
  }
}

TEST_F(Memory, ALeafIsSimulatedLearnedAndPlayedInAGigabyte) {
  EXPECT_EQ(fails_within(1000, "simulate leaf --drops 60 -o drops.csv"), "");
  EXPECT_EQ(fails_within(1000, "learn leaf drops.csv -o leaf.wisp"), "");
  EXPECT_EQ(fails_within(1000, "run leaf.wisp --frames 600 -o falls.csv"), "");
  EXPECT_EQ(fails_within(1000, "export leaf.wisp --loop 6 --instances 20 -o leaves.glb"), "");
}

TEST_F(Memory, ATableIsLearnedInAGigabyte) {
  {
    std::ofstream table(at("dryer.csv"));
    table << "u,y\n";
    double y = 0;
    for (int k = 0; k < 200'000; ++k) {
      const int u = k / 7 % 3;
      y = 0.9 * y + 0.1 * u + 0.01 * (k * 7919 % 101 - 50);
      table << u << ',' << y << '\n';
    }
  }
  EXPECT_EQ(fails_within(1000, "learn arx dryer.csv --rate 12.5 --inputs u --outputs y --na 4 --nb 4 -o dryer.wisp"),
            "");
}

TEST_F(Memory, LearningTakesAtMostATenthMoreThanItIsAllowed) {
  constexpr int kRows = 1'000'000;
  {
    std::ofstream table(at("long.csv"));
    table << "u,v,y\n";
    double y = 0;
    for (int k = 0; k < kRows; ++k) {
      const int u = k / 7 % 3, v = k / 11 % 5;
      y = 0.9 * y + 0.1 * u + 0.05 * v + 0.01 * static_cast<double>(k * 7919LL % 101 - 50);
      table << u << ',' << v << ',' << y << '\n';
    }
  }
  for (const auto& [flags, allowed] : std::vector<std::pair<std::string, int>>{
           {"--inputs u", 115}, {"--inputs u,v", 160}, {"--inputs u,v", 60}, {"--inputs u,v", 45}}) {
    const std::string line = "exec " WISP_PROGRAM " learn arx " + at("long.csv") + " --rate 1 --outputs y " + flags +
                             " --memory " + std::to_string(allowed) + " -o " + at("m.wisp") + " --quiet >" +
                             at("said") + " 2>&1";
    const pid_t child = fork();
    if (child == 0) _exit(execl("/bin/sh", "sh", "-c", line.c_str(), nullptr));
    int status = 0;
    rusage used{};
    ASSERT_EQ(wait4(child, &status, 0, &used), child);
    EXPECT_EQ(status, 0) << file_text(at("said"));
    EXPECT_LE(static_cast<double>(used.ru_maxrss) / 1024, 1.1 * allowed) << flags;
  }
}

// Red on a wrong budget.
TEST_F(Memory, ABudgetIsSeenToBePassed) {
  EXPECT_THAT(fails_within(50, "info nothing.wisp"),
              testing::Not(testing::HasSubstr("nothing.wisp: cannot be opened")));
}

}  // namespace
}  // namespace wisp::memory_test
