// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_source.hpp"

#include <fstream>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sndfile.h>
#include <sys/socket.h>
#include <unistd.h>

#include "app/live/cue_thread.hpp"
#include "app/remote/osc_packet.hpp"
#include "app/surfaces/show_timecode.hpp"
#include "tests/controller/time/led_show.hpp"
#include "tests/controller/time/tape.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using tests::Tape;
using tests::TapePiece;

/// A sound file of 16 bits with two channels: timecode on the first, music on the second.
void write_wav(const std::filesystem::path& file, const std::vector<float>& sound, int sample_rate) {
  SF_INFO info{};
  info.samplerate = sample_rate;
  info.channels = 2;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  SNDFILE* out = sf_open(file.c_str(), SFM_WRITE, &info);
  ASSERT_NE(out, nullptr);
  std::vector<float> frames;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    frames.push_back(std::clamp(sound[i], -1.0F, 1.0F));
    frames.push_back(0.7F * static_cast<float>(std::sin(0.06 * static_cast<double>(i))));
  }
  sf_writef_float(out, frames.data(), static_cast<sf_count_t>(sound.size()));
  sf_close(out);
}

class TimeSources : public testing::Test {
 protected:
  TimeSources() { show_.tempo = TempoMap(120, 4); }
  std::string error(const std::string& name) {
    const auto opened = open_time_source(name, folder_.path(), show_, clock_);
    EXPECT_FALSE(opened) << name;
    std::string text = opened ? "" : opened.error().message;
    const std::string prefix = folder_.path().string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }

  test::TemporaryFolder folder_;
  Show show_;
  ManualClock clock_;
};

TEST_F(TimeSources, ANoisyTapeInASoundFileLeadsAShow) {
  show_.time.start = time_of({1, 0, 0, 0, FrameRate::fps25});
  const Tape tape{
      FrameRate::fps25, 3596, {{.lasts_s = 10}, {.kind = TapePiece::Kind::silent, .lasts_s = 1}, {.lasts_s = 15}}};
  for (const int rate : {44'100, 48'000}) {
    write_wav(folder_.path() / "tape.wav", tests::sound_of(tape, rate, 0.08, 3), rate);
    auto source = open_time_source("ltc:tape.wav", folder_.path(), show_, clock_);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->name(), "ltc tape.wav");
    tests::LedShow led;
    std::vector<std::string> alarms;
    double worst_ms = 0;
    while (led.clock.now() < instant_at(27)) {
      TimeNews news = (*source)->read(led.clock.now(), {});
      for (const TimeFix& fix : news.fixes) led.hear(fix.at, fix.position);
      alarms.insert(alarms.end(), news.alarms.begin(), news.alarms.end());
      for (int i = 0; i < 2; ++i) {
        led.step();
        led.clock.advance(milliseconds(10));
      }
      if (led.phase() != controller::Rehearsal::Phase::runs) continue;
      const double truth_s = to_seconds(led.stepped_at) - 4;
      worst_ms = std::max(worst_ms, std::abs(to_seconds(led.position) - truth_s) * 1e3);
    }
    EXPECT_EQ(led.phase(), controller::Rehearsal::Phase::finished);
    EXPECT_LT(worst_ms, 15) << rate;
    using enum controller::TimeAlarm;
    EXPECT_EQ(led.alarms, (std::vector{follows, freewheels, follows}));
    EXPECT_EQ(alarms, std::vector<std::string>{"ltc tape.wav: the file is over"});
  }
}

TEST_F(TimeSources, ATapeOfAnotherRateThanTheShowFileSaysIsToldOnce) {
  const Tape tape{FrameRate::fps30, 0, {{.lasts_s = 5}}};
  write_wav(folder_.path() / "tape.wav", tests::sound_of(tape, 48'000, 0, 3), 48'000);
  auto source = open_time_source("ltc:tape.wav", folder_.path(), show_, clock_);
  ASSERT_TRUE(source);
  std::vector<std::string> alarms;
  for (int i = 0; i < 200; ++i) {
    TimeNews news = (*source)->read(kStart + i * milliseconds(20), {});
    alarms.insert(alarms.end(), news.alarms.begin(), news.alarms.end());
  }
  EXPECT_EQ(alarms, std::vector<std::string>{
                        "ltc tape.wav: 30 frames a second, the show file says 25: it is followed as it is"});
}

TEST_F(TimeSources, APreRollBeforeMidnightComesFromTheDayBefore) {
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30}) {
    TimeRules rules;
    rules.rate = rate;
    const int last = frames_counted(rate) - 1;
    EXPECT_NEAR(to_seconds(in_show(time_of({23, 59, 59, last, rate}), rules)), -to_seconds(frame_time(rate)), 1e-6);
    rules.start = time_of({23, 59, 58, 0, rate});
    EXPECT_NEAR(to_seconds(in_show(time_of({0, 0, 1, 0, rate}), rules)), 3, 0.01);
    rules.start = time_of({1, 0, 0, 0, rate});
    EXPECT_NEAR(to_seconds(in_show(time_of({0, 59, 50, 0, rate}), rules)), -10, 0.01);
  }
}

TEST_F(TimeSources, WhatIsNoneSaysWhatWouldBeOne) {
  const std::string all = " (" + std::string(kTimeSources) + ")";
  EXPECT_EQ(error("smpte"), "\"smpte\" is no source of time" + all);
  EXPECT_EQ(error("ltc:"), "\"ltc:\" is no source of time" + all);
  EXPECT_EQ(error("ltc"), "\"ltc\" is no source of time" + all);
  EXPECT_EQ(error("ltc:none.wav"),
            "none.wav: System error : No such file or directory (a sound file is wanted: WAV, FLAC, MP3 ...)");
  std::ofstream(folder_.path() / "text.wav") << "no sound";
  EXPECT_NE(error("ltc:text.wav").find("text.wav: "), std::string::npos);
}

/// A datagram to a port of this machine.
void send_to(int port, const std::vector<std::byte>& bytes) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  (void)::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  ::close(socket);
}

TEST_F(TimeSources, OscSaysSecondsOrATimecodeAndGarbageSaysNothing) {
  if (osc_bytes({"/x", {}}).empty()) GTEST_SKIP() << "built without liblo";
  show_.time.start = seconds(3600);
  int port = 47'000;
  auto source = open_time_source("osc:" + std::to_string(port), {}, show_, clock_);
  for (; !source && port < 47'100; source = open_time_source("osc:" + std::to_string(port), {}, show_, clock_)) ++port;
  ASSERT_TRUE(source) << source.error().message;
  const auto hear = [&](const std::vector<std::byte>& bytes) {
    send_to(port, bytes);
    clock_.advance(milliseconds(20));
    return (*source)->read(clock_.now(), {});
  };
  ASSERT_EQ(hear(osc_bytes({"/footlight/time", {3601.5}})).fixes.size(), 1U);
  EXPECT_EQ(hear(osc_bytes({"/footlight/time", {3601.5}})).fixes[0].position, milliseconds(1500));
  EXPECT_EQ(hear(osc_bytes({"/footlight/time", {std::int32_t{3600}}})).fixes[0].position, Duration{});
  EXPECT_EQ(hear(osc_bytes({"/footlight/time", {std::string("01:00:02:00")}})).fixes[0].position, seconds(2));
  EXPECT_TRUE(hear(osc_bytes({"/other/time", {3601.5}})).fixes.empty());
  EXPECT_TRUE(hear({std::byte{'#'}, std::byte{0xFF}}).fixes.empty());
  const TimeNews wrong = hear(osc_bytes({"/footlight/time", {std::string("noon")}}));
  EXPECT_TRUE(wrong.fixes.empty());
  ASSERT_EQ(wrong.alarms.size(), 1U);
  EXPECT_EQ(wrong.alarms[0],
            "osc " + std::to_string(port) + ": /footlight/time without seconds or a timecode of 25 frames");
  EXPECT_TRUE(hear(osc_bytes({"/footlight/time", {-1.0}})).alarms.empty()) << "once";
  EXPECT_EQ(
      error("osc:70000"),
      "osc:70000: a UDP port is wanted, alone (then only this machine is heard) or with the address to hear at, as "
      "osc:7000 or osc:192.168.1.10:7000");
  EXPECT_EQ(error("osc:" + std::to_string(port)), "osc:" + std::to_string(port) + ": Address already in use");
}

TEST_F(TimeSources, ASoundInputThatIsNotThereIsOneClearError) {
  const std::string text = error("ltc:alsa:hw:31,7");
  EXPECT_EQ(text.find("no sound input \"hw:31,7\": "), 0U) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace footlight::app
