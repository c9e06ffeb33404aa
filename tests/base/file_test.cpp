#include "wisp/base/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/stat.h>
#endif

#include <csignal>
#include <fstream>

#include "folder_test.hpp"

namespace wisp::file_test {
namespace {

namespace fs = std::filesystem;

class FileTest : public FolderTest {
 protected:
  std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }
};

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST_F(FileTest, WhatIsWrittenIsRead) {
  ASSERT_TRUE(write_file(folder_ / "a.txt", std::string_view("one\0two", 7)));
  const auto bytes = read_file(folder_ / "a.txt");
  ASSERT_TRUE(bytes);
  EXPECT_EQ(text_of(*bytes), std::string("one\0two", 7));
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, AnEmptyFileIsNoBytes) {
  ASSERT_TRUE(write_file(folder_ / "empty", std::string_view()));
  const auto bytes = read_file(folder_ / "empty");
  ASSERT_TRUE(bytes);
  EXPECT_TRUE(bytes->empty());
}

TEST_F(FileTest, AMissingFileAndAFolderAreNamed) {
  const auto missing = read_file(folder_ / "nowhere");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("nowhere"), std::string::npos);
  const auto folder = read_file(folder_);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("is a folder"), std::string::npos);
}

TEST_F(FileTest, AFileLargerThanAllowedIsRefused) {
  ASSERT_TRUE(write_file(folder_ / "big", std::string(1000, 'x')));
  EXPECT_FALSE(read_file(folder_ / "big", 999));
  EXPECT_TRUE(read_file(folder_ / "big", 1000));
}

TEST_F(FileTest, APendingFileThatIsNotCommittedLeavesTheOldOneAndNothingElse) {
  ASSERT_TRUE(write_file(folder_ / "a.txt", "old"));
  {
    auto pending = PendingFile::create(folder_ / "a.txt");
    ASSERT_TRUE(pending);
    EXPECT_EQ(pending->path().extension(), ".txt");
    std::ofstream(pending->path()) << "half";
    EXPECT_EQ(files(), 2u);
  }
  EXPECT_EQ(files(), 1u);
  EXPECT_EQ(text_of(*read_file(folder_ / "a.txt")), "old");
}

TEST_F(FileTest, CommittingAFileToWhichNothingWasWrittenKeepsTheOldOne) {
  ASSERT_TRUE(write_file(folder_ / "a.txt", "old"));
  {
    auto pending = PendingFile::create(folder_ / "a.txt");
    ASSERT_TRUE(pending);
    const auto outcome = pending->commit();
    ASSERT_FALSE(outcome);
    EXPECT_THAT(outcome.error().message, testing::HasSubstr("the new file is empty"));
  }
  EXPECT_EQ(text_of(*read_file(folder_ / "a.txt")), "old");
  EXPECT_TRUE(write_file(folder_ / "a.txt", ""));
  EXPECT_EQ(text_of(*read_file(folder_ / "a.txt")), "");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, WritingIntoAMissingFolderSaysSo) {
  const auto outcome = write_file(folder_ / "none" / "a.txt", "text");
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("does not exist"), std::string::npos);
}

TEST_F(FileTest, NamesInAnyScriptWork) {
  const fs::path name = folder_ / fs::path(u8"Kerze 蝋燭 свеча 🕯.txt");
  ASSERT_TRUE(write_file(name, "light"));
  EXPECT_TRUE(fs::exists(name));
  EXPECT_EQ(text_of(*read_file(name)), "light");
  const auto missing = read_file(folder_ / fs::path(u8"蝋燭"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find(reinterpret_cast<const char*>(u8"蝋燭")), std::string::npos);
}

#ifndef _WIN32  // what other systems do not have: pipes with names, permissions, signals from outside

TEST_F(FileTest, APipeIsNotReplacedByAFile) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto outcome = write_file(pipe, "text");
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("is no plain file"), std::string::npos);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, AReadOnlyFileIsNotReplaced) {
  ASSERT_TRUE(write_file(folder_ / "kept", "old"));
  fs::permissions(folder_ / "kept", fs::perms::owner_read);
  const auto written = write_file(folder_ / "kept", "new");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, testing::HasSubstr("kept: is read-only"));
}

TEST_F(FileTest, AReplacedFileKeepsItsPermissions) {
  ASSERT_TRUE(write_file(folder_ / "secret", "old"));
  fs::permissions(folder_ / "secret", fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_file(folder_ / "secret", "new"));
  EXPECT_EQ(fs::status(folder_ / "secret").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(text_of(*read_file(folder_ / "secret")), "new");
}

TEST_F(FileTest, ASymbolicLinkStaysOneAndItsTargetIsWritten) {
  fs::create_directories(folder_ / "there");
  ASSERT_TRUE(write_file(folder_ / "there" / "a.txt", "old"));
  fs::create_symlink(folder_ / "there" / "a.txt", folder_ / "link");
  ASSERT_TRUE(write_file(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text_of(*read_file(folder_ / "there" / "a.txt")), "new");
}

TEST_F(FileTest, ALinkToAFileThatIsNotThereYetStaysOneToo) {
  fs::create_directories(folder_ / "there");
  fs::create_symlink("there/a.txt", folder_ / "first");
  fs::create_symlink("first", folder_ / "link");
  ASSERT_TRUE(write_file(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "first"));
  EXPECT_EQ(text_of(*read_file(folder_ / "there" / "a.txt")), "new");
}

TEST_F(FileTest, LinksInACircleAreNamed) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  const auto outcome = write_file(folder_ / "a", "text");
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("it is a link that leads nowhere"), std::string::npos);
}

TEST_F(FileTest, APrivateFileIsPrivateWhileItIsWritten) {
  const auto secret = fs::perms::owner_write;
  ASSERT_TRUE(write_file(folder_ / "secret", "old"));
  fs::permissions(folder_ / "secret", secret);
  auto pending = PendingFile::create(folder_ / "secret");
  ASSERT_TRUE(pending);
  std::ofstream(pending->path()) << "new";
  EXPECT_EQ(fs::status(pending->path()).permissions(), secret | fs::perms::owner_write);
  ASSERT_TRUE(pending->commit());
  EXPECT_EQ(fs::status(folder_ / "secret").permissions(), secret);
  EXPECT_EQ(text_of(*read_file(folder_ / "secret")), "new");
}

TEST_F(FileTest, AnInterruptedProcessLeavesTheOldFileAndNothingElse) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ}) {
    ASSERT_TRUE(write_file(folder_ / "a.txt", "old"));
    const auto interrupted = [&] {
      std::signal(signal, SIG_DFL);  // what a shell starts in the background ignores some
      remove_pending_files_when_interrupted();
      auto first = PendingFile::create(folder_ / "a.txt");
      auto second = PendingFile::create(folder_ / "b.txt");
      const PendingFile moved = std::move(*first);
      std::ofstream(moved.path()) << "half";
      std::ofstream(second->path()) << "half";
      std::raise(signal);
    };
    EXPECT_EXIT(interrupted(), testing::KilledBySignal(signal), "");
    EXPECT_EQ(files(), 1u);
    EXPECT_EQ(text_of(*read_file(folder_ / "a.txt")), "old");
  }
}

#endif

TEST_F(FileTest, PendingFilesBeyondTheListWorkLikeTheOthers) {
  std::vector<PendingFile> many;
  for (int k = 0; k < 100; ++k) {
    auto pending = PendingFile::create(folder_ / std::to_string(k));
    ASSERT_TRUE(pending);
    std::ofstream(pending->path()) << k;
    many.push_back(std::move(*pending));
  }
  for (PendingFile& pending : many) EXPECT_TRUE(pending.commit());
  EXPECT_EQ(files(), 100u);
}

}  // namespace
}  // namespace wisp::file_test
