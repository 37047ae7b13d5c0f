// SPDX-License-Identifier: Apache-2.0
#include "app/edit/file_watch.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

/// A watch over two files; time is told, so that nothing waits.
class FileWatchTest : public ::testing::Test {
 protected:
  FileWatchTest() {
    folder_.write("show.yaml", "one");
    folder_.write("line.csv", "a");
    watch_.watch({(folder_.path() / "show.yaml").string(), (folder_.path() / "line.csv").string()});
    (void)watch_.changed(now_);  // the first look
  }
  /// Looked at often, for so long. @return how many changes were told
  int told_in(Duration time) {
    int told = 0;
    for (const Instant end = now_ + time; now_ < end; now_ += milliseconds(20)) told += watch_.changed(now_) ? 1 : 0;
    return told;
  }

  test::TemporaryFolder folder_;
  FileWatch watch_;
  Instant now_ = kStart + seconds(1);
};

TEST_F(FileWatchTest, NothingHappensNothingIsTold) { EXPECT_EQ(told_in(seconds(10)), 0); }

TEST_F(FileWatchTest, AFileWrittenInPlaceIsOneChange) {
  folder_.write("show.yaml", "another");
  EXPECT_EQ(told_in(seconds(5)), 1);
  folder_.write("line.csv", "bb");
  EXPECT_EQ(told_in(seconds(5)), 1);
}

TEST_F(FileWatchTest, AFileThatIsBeingWrittenIsWaitedFor) {
  for (int i = 0; i < 20; ++i) {
    folder_.write("show.yaml", "piece " + std::to_string(i));
    EXPECT_EQ(told_in(milliseconds(200)), 0) << i;
  }
  EXPECT_EQ(told_in(seconds(1)), 1);
}

TEST_F(FileWatchTest, AFileThatIsRenamedIntoItsPlaceIsSeen) {
  folder_.write("show.yaml~", "three");
  EXPECT_EQ(told_in(seconds(1)), 0) << "that is no file of the show";
  std::filesystem::rename(folder_.path() / "show.yaml~", folder_.path() / "show.yaml");
  EXPECT_EQ(told_in(seconds(1)), 1);
  std::filesystem::remove(folder_.path() / "line.csv");
  EXPECT_EQ(told_in(seconds(1)), 1) << "and one that is gone";
}

TEST_F(FileWatchTest, WhatIsWatchedFromNowOnIsNoChange) {
  folder_.write("other.csv", "x");
  watch_.watch({(folder_.path() / "other.csv").string()});
  EXPECT_EQ(told_in(seconds(3)), 0);
  folder_.write("show.yaml", "nobody minds");
  EXPECT_EQ(told_in(seconds(3)), 0);
  folder_.write("other.csv", "yy");
  EXPECT_EQ(told_in(seconds(3)), 1);
}

}  // namespace
}  // namespace footlight::app
