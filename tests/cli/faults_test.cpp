// What goes wrong around a run: a signal, a full disk, an output that is an input. Nothing is left half, nothing is
// lost.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "cli/program.hpp"

namespace wisp::faults_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kFlame = WISP_SOURCE_DIR "/tests/c/models/flame.wisp";

class Faults : public InFolder {
 protected:
  std::string table(const std::string& name) {
    std::ofstream out(at(name));
    out << "u,y\n";
    double y = 0;
    for (int k = 0; k < 60; ++k) {
      const double u = k % 7 < 3 ? 1 : -0.5;
      out << u << "," << y << "\n";
      y = 0.7 * y + 0.5 * u + 0.01 * (k % 5);
    }
    return at(name);
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
};

TEST_F(Faults, AnOutputThatIsAnInputIsRefusedByAnyNameOfIt) {
  const std::string rec = table("rec.csv"), before = file_text(rec);
  std::filesystem::create_symlink(rec, at("link.csv"));
  std::filesystem::create_hard_link(rec, at("twin.csv"));
  std::filesystem::copy(kFlame, at("flame.wisp"));
  const std::string model = file_text(at("flame.wisp"));
  const std::string learns = " --inputs u --outputs y --rate 10 -o ";
  for (const std::string& line :
       {"learn arx " + rec + learns + rec, "learn arx " + rec + learns + at("link.csv"),
        "learn arx " + rec + learns + at("twin.csv"), "learn arx " + rec + learns + at("./rec.csv"),
        "learn switched " + rec + learns + rec, "learn flame " + rec + " -o " + rec,
        "learn arx " + rec + " --inputs u --outputs y --rate 10 --partial " + rec,
        "learn arx --merge " + rec + " -o " + rec, "validate " + at("flame.wisp") + " " + rec + " --overlay " + rec,
        "validate " + at("flame.wisp") + " " + rec + " --film-strip " + at("flame.wisp"),
        "validate " + at("flame.wisp") + " x.csv --clip " + rec + " --overlay " + rec,
        "predict " + at("flame.wisp") + " " + rec + " -o " + rec,
        "run " + at("flame.wisp") + " --input " + rec + " -o " + rec,
        "run " + at("flame.wisp") + " --frames 3 -o " + at("flame.wisp"), "capture flame " + rec + " -o " + rec,
        "simulate leaf --wind " + rec + " -o " + rec}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 2) << line << said.err;
    EXPECT_THAT(said.err, HasSubstr("is a file that is read, and would be lost: give another name")) << line;
  }
  EXPECT_EQ(file_text(rec), before);
  EXPECT_EQ(file_text(at("flame.wisp")), model);
}

// A film learned from lies where the demo writes one, a model where an export's second file goes.
TEST_F(Faults, WhatAnOutputBringsAlongReplacesNoInput) {
  for (const char* name : {"flame.mp4", "a.truth.csv", "b.h", "c.atlas.json"}) std::filesystem::copy(kFlame, at(name));
  const std::string before = file_text(kFlame);
  for (const std::string& line :
       {"demo " + at("flame.mp4") + " -o " + at(""),
        "simulate candle --seconds 1 --wind " + at("a.truth.csv") + " -o " + at("a.mp4"),
        "export " + at("b.h") + " -o " + at("b.c"), "export " + at("c.atlas.json") + " -o " + at("c.png")}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 2) << line << said.err;
    EXPECT_THAT(said.err, HasSubstr("which it brings, is a file that is read, and would be lost")) << line;
  }
  for (const char* name : {"flame.wisp", "a.mp4", "b.c", "c.png"}) EXPECT_FALSE(std::filesystem::exists(at(name)));
  for (const char* name : {"flame.mp4", "a.truth.csv", "b.h", "c.atlas.json"}) EXPECT_EQ(file_text(at(name)), before);
}

TEST_F(Faults, AnImageOfAClipIsReplacedByNothing) {
  std::ofstream(at("01.pgm")) << "P5\n1 1\n255\n0";
  const std::string before = file_text(at("01.pgm"));
  for (const std::string& output : {at("01.pgm"), at("./01.pgm")}) {
    const Said said = wisp("capture flame " + at("") + " --rate 30 -o " + output);
    EXPECT_EQ(said.status, 2) << said.err;
    EXPECT_THAT(said.err, HasSubstr("is a file that is read, and would be lost: give another name"));
  }
  EXPECT_EQ(file_text(at("01.pgm")), before);
  std::ofstream(at("rec.csv")) << "of the last time";
  EXPECT_THAT(wisp("capture flame " + at("") + " --rate 30 -o " + at("rec.csv")).err,
              testing::Not(HasSubstr("would be lost")));
}

TEST_F(Faults, NamesOfAnotherKindOfFileAreRefused) {
  for (const std::string& line :
       {"simulate leaf --drops 1 -o " + at("rec.png"), std::string("capture flame no.mp4 -o ") + at("rec.mp4"),
        std::string("learn arx no.csv --inputs u --outputs y -o ") + at("model.csv"),
        std::string("validate ") + kFlame + " no.csv --overlay " + at("overlay.mkv"),
        std::string("validate ") + kFlame + " no.csv --film-strip " + at("strip.mp4")}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 2) << line << said.err;
    EXPECT_THAT(said.err, HasSubstr("the name is of another kind of file, expected one such as ")) << line;
  }
  EXPECT_EQ(wisp(std::string("run ") + kFlame + " --frames 3 -o " + at("play.csv")).status, 0);
  EXPECT_EQ(wisp("simulate candle --seconds 0.2 -o " + at("a.mp4")).status, 0);
  // Other endings say nothing of what is in a file.
  EXPECT_EQ(wisp("capture flame " + at("a.mp4") + " -o " + at("a.txt")).err.find("another kind"), std::string::npos);
}

TEST_F(Faults, AnOutputInAMissingFolderIsFoundBeforeAnythingIsRead) {
  for (const std::string& line :
       {std::string("learn arx no.csv --inputs u --outputs y -o nowhere/m.wisp"),
        std::string("learn arx no.csv --inputs u --outputs y -o nowhere/m"),
        std::string("learn flame no.mp4 -o nowhere/m.wisp"), std::string("capture flame no.mp4 -o nowhere/rec.csv"),
        std::string("validate ") + kFlame + " no.mp4 --overlay nowhere/o.mp4"}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 1) << line;
    EXPECT_THAT(said.err, AllOf(testing::StartsWith("wisp: nowhere/"), HasSubstr("cannot be written"))) << line;
  }
}

TEST_F(Faults, ADemoWhoseFilesCannotBeWrittenEndsBeforeItsWork) {
  std::filesystem::create_directories(at("recording.csv"));
  EXPECT_THAT(wisp("demo no.mp4 -o " + at("")).err, HasSubstr("recording.csv: is a folder, expected a file name"));
}

TEST_F(Faults, FlagsOfAnotherKindOfModelOrFileAreRefused) {
  const std::string flame = std::string("validate ") + kFlame;
  for (const auto& [line, why] :
       {std::pair{flame + " no.csv --initial zero", "--initial is for plain models"},
        {flame + " no.mp4 --columns a,b", "--columns is of a table, and no.mp4 is a clip"},
        {flame + " no.csv --film-strip " + at("a.svg"), "expected a name in .png"},
        {std::string("run ") + kFlame + " --input no.wav --own-gain -o " + at("a.csv"), "--own-gain is of a table"},
        {"validate " WISP_SOURCE_DIR "/tests/c/models/leaf.wisp no.csv --steps 3", "--steps is for models that"}}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 2) << line << said.err;
    EXPECT_THAT(said.err, HasSubstr(why)) << line;
  }
}

TEST_F(Faults, OutputThatCannotBeWrittenIsStatus1) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  for (const std::string& words : {std::string("info ") + kFlame + " --json", std::string("--help"),
                                   std::string("run --help"), std::string("--version")}) {
    const std::string line = std::string(WISP_PROGRAM) + " " + words + " >/dev/full 2>" + at("err") + " </dev/null";
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << words;
    EXPECT_THAT(file_text(at("err")), HasSubstr("standard output cannot be written")) << words;
  }
}

// A film of hours, ended as soon as its hidden part is there.
TEST_F(Faults, ASignalLeavesTheOldFileAloneAndItsOwnStatus) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1}) {
    std::ofstream(at("film.mp4")) << "old";
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      execl(WISP_PROGRAM, WISP_PROGRAM, "run", kFlame, "--frames", "400000", "-o", at("film.mp4").c_str(), "--quiet",
            static_cast<char*>(nullptr));
      _exit(127);
    }
    while (files() < 2 && waitpid(child, nullptr, WNOHANG) == 0) std::this_thread::yield();
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
    EXPECT_EQ(files(), 1u);
    EXPECT_EQ(file_text(at("film.mp4")), "old");
  }
}

}  // namespace
}  // namespace wisp::faults_test
