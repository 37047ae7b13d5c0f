// SPDX-License-Identifier: Apache-2.0
#include "app/remote/msc_surface.hpp"

#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include "tests/app/remote/listener.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MscSurfaceTest : public ::testing::Test {
 protected:
  MscSurfaceTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {
    settings_.port = folder_ / "midi";
    EXPECT_EQ(::mkfifo(settings_.port.c_str(), 0600), 0);
    auto opened = MscSurface::open(settings_, clock_, true);
    EXPECT_TRUE(opened) << opened.error().message;
    surface_ = std::move(opened).value();
    desk_.add(ears_);
    desk_.add(*surface_);
    writer_ = FileDescriptor(::open(settings_.port.c_str(), O_WRONLY | O_CLOEXEC));
    view_.show.standby = 0;
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    ASSERT_EQ(::write(writer_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// Looks until so many commands have come, or 20 s are over.
  std::size_t look_until(std::size_t wanted) {
    std::size_t commands = 0;
    pollfd file{surface_->file(), POLLIN, 0};
    while (commands < wanted && ::poll(&file, 1, 20'000) == 1) commands += desk_.look(view_).commands.size();
    return commands;
  }

  test::TemporaryFolder folder_;
  tests::SmallShow small_;
  ManualClock clock_;
  RunDesk desk_;
  Listener ears_;
  config::MidiRemote settings_;
  std::unique_ptr<MscSurface> surface_;
  FileDescriptor writer_;
  DeskView view_;
};

TEST_F(MscSurfaceTest, AGoComesThroughGarbageAndTheClock) {
  send({0x12, 0x90, 0x3C, 0xF0, 0x7F, 0x7F, 0x02, 0x01, 0xF8});
  send({0x01, 0x31, 0xF7, 0xFF, 0xB0});
  EXPECT_EQ(look_until(1), 1U);
}

TEST_F(MscSurfaceTest, WhatIsNotCarriedOutIsSeenByAll) {
  send({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0x33, 0xF7, 0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x0B, 0xF7});
  send({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x02, 0xF7});
  EXPECT_EQ(look_until(1), 1U) << "the hold";
  const std::string who = " by msc " + settings_.port;
  EXPECT_THAT(
      ears_.take(),
      ElementsAre("show control" + who + " refused: cue 3 is not standby (1 is): load it, then people have a way there",
                  HasSubstr("command 0B is not carried out")));
}

TEST_F(MscSurfaceTest, AFloodLosesMessagesAndTheNextOneIsHeard) {
  for (int i = 0; i < 200; ++i) send({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0xF7});
  // The clock stands still: all of it is within one window, however long the bytes take.
  EXPECT_EQ(look_until(FloodGuard::kMost), static_cast<std::size_t>(FloodGuard::kMost));
  for (int i = 0; i < 50; ++i) {
    EXPECT_THAT(desk_.look(view_).commands, IsEmpty());
    ::poll(nullptr, 0, 1);
  }
  send({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x02, 0xF7});
  EXPECT_EQ(look_until(1), 1U) << "STOP is in no budget";
  clock_.advance(milliseconds(20));
  send({0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x02, 0xF7});
  EXPECT_GE(look_until(1), 1U);
}

TEST(MscSurface, APortThatIsNotThereIsRefused) {
  const ManualClock clock;
  config::MidiRemote settings;
  settings.port = "/dev/snd/midiC99D9";
  EXPECT_EQ(MscSurface::open(settings, clock, true).error().kind, ErrorKind::device);
}

}  // namespace
}  // namespace footlight::app
