// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_input.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

class MidiFifo : public ::testing::Test {
 protected:
  MidiFifo() : path_(folder_ / "midi") {
    EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    auto opened = open_midi_input(path_, clock_);
    EXPECT_TRUE(opened) << opened.error().message;
    input_ = std::move(opened).value();
    writer_ = FileDescriptor(::open(path_.c_str(), O_WRONLY | O_CLOEXEC));
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    ASSERT_EQ(::write(writer_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// The next message, waited for.
  MidiMessage next() const {
    while (true) {
      if (auto message = input_->take()) return *message;
      pollfd wanted{input_->poll_handle(), POLLIN, 0};
      if (::poll(&wanted, 1, 20'000) != 1) {
        ADD_FAILURE() << "nothing came";
        return {};
      }
    }
  }

  test::TemporaryFolder folder_;
  std::string path_;
  ManualClock clock_;
  std::unique_ptr<MidiInput> input_;
  FileDescriptor writer_;
};

TEST_F(MidiFifo, WholeMessagesAreHandedOverWithTheTimeOfTheClock) {
  clock_.advance(milliseconds(1500));
  send({0xF0, 0x7F, 0x7F});
  send({0x02, 0xF8, 0x01, 0x01, 0xF7, 0xFE, 0xF1, 0x23});
  EXPECT_THAT(next().view(), ElementsAre(0xF8));
  const MidiMessage go = next();
  EXPECT_THAT(go.view(), ElementsAre(0xF0, 0x7F, 0x7F, 0x02, 0x01, 0x01, 0xF7));
  EXPECT_EQ(go.at, instant_at(1.5));
  EXPECT_THAT(next().view(), ElementsAre(0xF1, 0x23)) << "active sensing is left out";
}

TEST_F(MidiFifo, AWriterThatComesAndGoesEndsNothing) {
  send({0xFA});
  EXPECT_THAT(next().view(), ElementsAre(0xFA));
  writer_ = FileDescriptor();
  writer_ = FileDescriptor(::open(path_.c_str(), O_WRONLY | O_CLOEXEC));
  send({0xFC});
  EXPECT_THAT(next().view(), ElementsAre(0xFC));
  EXPECT_FALSE(input_->closed());
}

TEST_F(MidiFifo, AFloodLosesMessagesAndIsCounted) {
  for (int i = 0; i < 50; ++i) send(std::vector<std::uint8_t>(1000, 0xF8));
  std::uint64_t taken = 0;
  pollfd wanted{input_->poll_handle(), POLLIN, 0};
  while (taken + input_->lost() < 50'000 && ::poll(&wanted, 1, 20'000) == 1) {
    while (input_->take()) ++taken;
  }
  EXPECT_EQ(taken + input_->lost(), 50'000U);
}

TEST(MidiInput, WhatIsNoDeviceIsRefusedWithWhatWouldBeRight) {
  const SteadyClock clock;
  EXPECT_EQ(open_midi_input("/dev/snd/midiC99D9", clock).error().message,
            "MIDI device \"/dev/snd/midiC99D9\": No such file or directory (`amidi -l` lists those of this machine)");
  EXPECT_EQ(open_midi_input("/etc/passwd", clock).error().message,
            "MIDI device \"/etc/passwd\": neither a device nor a FIFO (such as /dev/snd/midiC1D0)");
}

TEST(MidiInput, ADeviceThatEndsIsClosed) {
  const SteadyClock clock;
  const auto input = open_midi_input("/dev/null", clock);
  ASSERT_TRUE(input);
  pollfd wanted{(*input)->poll_handle(), POLLIN, 0};
  EXPECT_EQ(::poll(&wanted, 1, 20'000), 1);
  EXPECT_TRUE((*input)->closed());
}

TEST(MidiInput, APortIsFoundByNumberNameAndPartOfAName) {
  const std::vector<std::string> ports{"Midi Through 14:0", "USB MIDI 20:0", "USB MIDI 20:1"};
  EXPECT_EQ(find_midi_port(ports, "1").value(), 1U);
  EXPECT_EQ(find_midi_port(ports, "usb midi 20:1").value(), 2U);
  EXPECT_EQ(find_midi_port(ports, "through").value(), 0U);
  EXPECT_EQ(find_midi_port(ports, "usb").error().message,
            "MIDI port \"usb\": more than one is called so (there are 0 \"Midi Through 14:0\", 1 \"USB MIDI 20:0\", 2 "
            "\"USB MIDI 20:1\")");
  EXPECT_EQ(find_midi_port({}, "3").error().message, "MIDI port \"3\": no such port (there is none)");
}

TEST(MidiInput, AMachineWithoutPortsSaysSo) {
  const SteadyClock clock;
  const auto input = open_midi_input("no such thing", clock);
  ASSERT_FALSE(input);
  EXPECT_EQ(input.error().kind, ErrorKind::device);
#if FOOTLIGHT_WITH_rtmidi
  EXPECT_THAT(input.error().message, StartsWith("MIDI"));
#else
  EXPECT_EQ(input.error().message,
            "MIDI port \"no such thing\": this program was built without RtMidi (install librtmidi-dev and build "
            "again)");
  EXPECT_FALSE(midi_input_ports());
#endif
}

}  // namespace
}  // namespace footlight::app
