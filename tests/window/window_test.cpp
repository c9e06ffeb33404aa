// The program `wisp play` as a user runs it: its errors, its pictures, and its window on a screen of the test's own.

#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "capture/support/clip_files.hpp"
#include "cli/program.hpp"
#include "paths.hpp"
#include "sound/wind_sounds.hpp"
#include "window/window.hpp"

namespace wisp::window_test {
namespace {

using testing::HasSubstr;

const std::string kFlame = WISP_SOURCE_DIR "/apps/web/public/models/flame-4.wisp";

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

class Play : public InFolder {
 protected:
  // As in a shell without a screen and without a sound card.
  Said play(const std::string& arguments, const std::string& environment = "") {
    const std::string line = "env -u DISPLAY -u WAYLAND_DISPLAY " + environment + " " WISP_PROGRAM " play " +
                             arguments + " >" + at("said.out") + " 2>" + at("said.err") + " </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(at("said.out")), file_text(at("said.err"))};
  }

  void script(const std::string& text) { std::ofstream(at("script.txt")) << text; }

  // A PNG file that is all there.
  static bool is_whole(const std::filesystem::path& path) {
    const std::string text = file_text(path);
    return text.starts_with("\x89PNG") && text.size() > 12 && text.substr(text.size() - 8, 4) == "IEND";
  }

  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(at(folder)))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

int lines_of(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

TEST_F(Play, RefusesWrongFlagsWithStatus2) {
  for (const char* arguments : {"--scene pond", "--size big", "--size 10x10", "--size 800", "--frames many",
                                "--frames 0", "--png out", "--nonsense", "--seed x"}) {
    EXPECT_EQ(play(kFlame + " " + arguments).status, 2) << arguments;
  }
  EXPECT_EQ(play(kFlame + " --scene leaves --frames 1").status, 2);
}

TEST_F(Play, NamesABadFileInOneLineWithStatus1) {
  std::ofstream(at("broken.wisp")) << "WISP";
  std::ofstream(at("broken.wav")) << "RIFF";
  script("0 dance\n");
  const std::string frames = " --frames 2";
  for (const auto& [arguments, named] :
       {std::pair{at("broken.wisp") + frames, "broken.wisp"}, std::pair{at("absent.wisp") + frames, "absent.wisp"},
        std::pair{kFlame + frames + " --sound " + at("broken.wav"), "broken.wav"},
        std::pair{kFlame + frames + " --script " + at("script.txt"), "script.txt:1"},
        std::pair{kFlame + frames + " --png " + at("broken.wav") + "/x", "broken.wav"}}) {
    const Said said = play(arguments);
    EXPECT_EQ(said.status, 1) << named;
    EXPECT_THAT(said.err, HasSubstr(named));
    EXPECT_EQ(lines_of(said.err), 1) << said.err;
  }
}

TEST_F(Play, WithoutAModelPlaysThoseThatComeWithWisp) {
  const Said said = play("--frames 2 --size 64x64 --scene leaves --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.json()["model"].get<std::string>(), HasSubstr("leaf.wisp"));
}

TEST_F(Play, WritesTheSamePicturesForTheSameSeed) {
  for (const char* folder : {"a", "b"}) {
    const Said said = play(kFlame + " --frames 3 --size 128x128 --seed 5 --png " + at(folder));
    ASSERT_EQ(said.status, 0) << said.err;
  }
  EXPECT_THAT(files("a"), testing::ElementsAre("frame-00001.png", "frame-00002.png", "frame-00003.png"));
  for (const std::string& name : files("a")) {
    EXPECT_TRUE(is_whole(folder_ / "a" / name));
    EXPECT_TRUE(file_text(folder_ / "a" / name) == file_text(folder_ / "b" / name)) << name;
  }
}

TEST_F(Play, LeavesWholePicturesOrNoneWhenItIsInterrupted) {
  const std::string first = at("frames") + "/frame-00003.png";
  const std::string line = WISP_PROGRAM " play " + kFlame + " --frames 100000 --png " + at("frames") +
                           " >/dev/null 2>&1 & pid=$!; until [ -e " + first +
                           " ]; do sleep 0.01; done; kill -TERM $pid; wait $pid; test $? = 143";  // 128 + SIGTERM
  EXPECT_EQ(std::system(line.c_str()), 0);
  const auto names = files("frames");
  EXPECT_GE(names.size(), 3U);
  for (const std::string& name : names) EXPECT_TRUE(is_whole(folder_ / "frames" / name)) << name;
}

TEST_F(Play, SaysInOneLineThatThereIsNoDisplay) {
  if (!window::has_window()) GTEST_SKIP() << "built without SDL2";
  const Said said = play(kFlame);
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("no display was found"));
  EXPECT_EQ(lines_of(said.err), 1) << said.err;
}

// script/demo in a tree of its own, where what it calls only says that it was called.
class Demo : public Play {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "script");
    std::filesystem::create_directories(folder_ / "build/release/bin");
    std::filesystem::copy_file(WISP_SOURCE_DIR "/script/demo", folder_ / "script/demo");
    stub("script/bootstrap", "bootstrap");
    stub("script/build", "build");
    stub("script/web", "web");
    stub("build/release/bin/wisp", "wisp");
    stub("npm", "npm");
    stub("emcc", "emcc");
  }
  void stub(const std::string& name, const std::string& says) {
    std::ofstream(folder_ / name) << "#!/bin/sh\necho \"" << says << " $*\"\n";
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }
  std::string demo(const std::string& arguments, const std::string& path) {
    const std::string line =
        "PATH=" + path + " " + at("script/demo") + " " + arguments + " >" + at("out") + " 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << file_text(at("out"));
    return file_text(at("out"));
  }
};

TEST_F(Demo, EndsByItselfWithoutATerminal) {
  EXPECT_EQ(demo("clip.mp4 --points 16", "$PATH"), "build demo wisp\nwisp demo clip.mp4 --points 16\n");
}

TEST_F(Demo, ServesThePageOrOpensTheWindowWhereAskedTo) {
  const std::string path = folder_.string() + ":$PATH";
  EXPECT_THAT(demo("--serve", path), testing::EndsWith("wisp demo\nbootstrap --page\nweb serve 8080\n"));
  EXPECT_THAT(demo("clip.mp4 --serve 9000", path),
              testing::EndsWith("wisp demo clip.mp4\nbootstrap --page\nweb serve 9000\n"));
  EXPECT_THAT(demo("clip.mp4 --window", path), testing::EndsWith("wisp demo clip.mp4 --window\n"));
}

// A screen without a screen, for all tests of the suite.
class PlayInAWindow : public Play {
 protected:
  static void SetUpTestSuite() {
    if (!window::has_window() || !has_program("Xvfb")) return;
    // Tests run side by side, each with a screen of its own.
    const std::string here = testing::TempDir() + "wisp-screen-" + std::to_string(getpid());
    const std::string display = here + ".display", pid = here + ".pid";
    const std::string line =
        "Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp 3>" + display + " >/dev/null 2>&1 & echo $! >" + pid;
    if (std::system(line.c_str()) != 0) return;
    server_ = std::stoi(file_text(pid));
    for (int k = 0; k < 200 && file_text(display).find('\n') == std::string::npos; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    display_ = file_text(display);
    display_.resize(std::min(display_.size(), display_.find('\n')));
    std::filesystem::remove(display);
    std::filesystem::remove(pid);
  }
  static void TearDownTestSuite() {
    if (server_ > 0) kill(server_, SIGTERM);
    server_ = 0;
  }
  void SetUp() override {
    if (display_.empty()) GTEST_SKIP() << "no window: SDL2 or Xvfb is missing";
  }

  Said play_shown(const std::string& arguments, const std::string& audio = "none") {
    return play(arguments + " --json", "DISPLAY=:" + display_ + " SDL_AUDIODRIVER=" + audio);
  }

  static int server_;
  static std::string display_;
};
int PlayInAWindow::server_ = 0;
std::string PlayInAWindow::display_;

TEST_F(PlayInAWindow, ShowsWhatPicturesWithoutAWindowShow) {
  // A soft breath by its level, which leans the flame: a hard blow would put out the cake that comes during it, too.
  sounds::Samples sound = sounds::room(5, 48000, 0.001);
  sounds::add(sound, sounds::steady_blowing(1, 48000, 0.01), 3.4, 48000);
  std::vector<std::int16_t> samples;
  for (const float value : sound) samples.push_back(static_cast<std::int16_t>(std::lround(value * 32767)));
  support::write_wav(at("sound.wav"), 48000, 1, samples);
  script(
      "1 picture calm\n1.2 down left\n1.6 picture leaning\n1.7 up left\n1.8 key space\n2.9 picture smoking\n"
      "3 click 0.5 0.5\n3.3 picture lit\n3.9 picture blown\n4 key c\n4.2 picture cake\n4.3 key h\n4.4 picture help\n"
      "4.5 close\n");
  const std::string arguments = kFlame + " --size 512x256 --sound " + at("sound.wav") + " --script " + at("script.txt");
  const Said shown = play_shown(arguments + " --png " + at("shown"));
  ASSERT_EQ(shown.status, 0) << shown.err;
  EXPECT_EQ(shown.json()["went_out"], 1);
  EXPECT_EQ(shown.json()["relit"], 1);
  const Said drawn = play(arguments + " --json --frames 400 --png " + at("drawn"));
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(shown.json()["pictures"], drawn.json()["pictures"]);
  ASSERT_EQ(files("shown").size(), 7U);
  for (const std::string& name : files("drawn")) {
    EXPECT_TRUE(file_text(folder_ / "shown" / name) == file_text(folder_ / "drawn" / name)) << name;
  }
}

TEST_F(PlayInAWindow, GoesOnWithoutAMicrophoneAndSaysSo) {
  script("0.2 picture end\n0.3 close\n");
  const Said said = play_shown(kFlame + " --size 256x256 --script " + at("script.txt") + " --png " + at("png"));
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.json()["said"][0].get<std::string>(), HasSubstr("no microphone"));
  EXPECT_TRUE(is_whole(folder_ / "png" / "end.png"));
}

TEST_F(PlayInAWindow, GoesOnWhenTheMicrophoneIsLost) {
  script("0.2 unplug\n0.4 drop " + at("script.txt") + "\n0.5 key f11\n0.8 picture end\n0.9 close\n");
  const Said said =
      play_shown(kFlame + " --size 256x256 --script " + at("script.txt") + " --png " + at("png"), "dummy");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.json()["said"][0].get<std::string>(), HasSubstr("the microphone is gone"));
  EXPECT_THAT(said.json()["state"].get<std::string>(), HasSubstr("burning 1"));
  EXPECT_TRUE(is_whole(folder_ / "png" / "end.png"));
}

}  // namespace
}  // namespace wisp::window_test
