// SPDX-License-Identifier: Apache-2.0
#include "app/live/waiting.hpp"

#include <array>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

namespace footlight::app {
namespace {

class WaitingTest : public ::testing::Test {
 protected:
  WaitingTest() {
    std::array<int, 2> ends{-1, -1};
    EXPECT_EQ(::pipe(ends.data()), 0);
    out_ = FileDescriptor(ends[0]);
    in_ = FileDescriptor(ends[1]);
  }

  SteadyClock clock_;
  Waiting waiting_{clock_};
  FileDescriptor in_;
  FileDescriptor out_;
};

TEST_F(WaitingTest, NeverEndsBeforeItsInstant) {
  for (const Duration length : {Duration(-1), Duration(1), milliseconds(3)}) {
    const Instant until = clock_.now() + length;
    EXPECT_EQ(waiting_.until(until), Waiting::Why::time);
    EXPECT_GE(clock_.now(), until);
  }
}

TEST_F(WaitingTest, IsWokenFromAnotherThread) {
  std::thread other([&] { waiting_.wake(); });
  EXPECT_EQ(waiting_.until(clock_.now() + std::chrono::seconds(60)), Waiting::Why::woken);
  other.join();
}

TEST_F(WaitingTest, AWakeThatComesFirstIsNotLostAndManyAreOne) {
  for (int i = 0; i < 3; ++i) waiting_.wake();
  EXPECT_EQ(waiting_.until(clock_.now() + std::chrono::seconds(60)), Waiting::Why::woken);
  EXPECT_EQ(waiting_.until(clock_.now()), Waiting::Why::time);
}

TEST_F(WaitingTest, IsEndedByInput) {
  ASSERT_EQ(::write(in_.get(), "x", 1), 1);
  EXPECT_EQ(waiting_.until(clock_.now() + std::chrono::seconds(60), out_.get()), Waiting::Why::input);
}

TEST_F(WaitingTest, TellsAWireThatHasGoneFromOneThatSpeaks) {
  in_ = FileDescriptor();
  EXPECT_EQ(waiting_.until(clock_.now() + std::chrono::seconds(60), out_.get()), Waiting::Why::trouble);
}

}  // namespace
}  // namespace footlight::app
