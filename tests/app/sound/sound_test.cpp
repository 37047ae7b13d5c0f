// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "app/sound/click_file.hpp"
#include "app/sound/count_in.hpp"
#include "app/sound/heard_count_in.hpp"
#include "app/sound/mixer.hpp"
#include "app/sound/samples.hpp"
#include "app/sound/sound_file.hpp"
#include "app/sound/voice.hpp"
#include "app/surfaces/run_desk.hpp"
#include "core/clock.hpp"
#include "core/rng.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;

std::shared_ptr<const Samples> impulse() { return std::make_shared<const Samples>(Samples{1.0F, 0.5F}); }

TEST(Samples, AClickIsLoudAtOnceAndOverSoon) {
  for (const bool accented : {false, true}) {
    const Samples sound = click(accented);
    const auto loudest = std::ranges::max_element(sound, {}, [](float s) { return std::abs(s); });
    EXPECT_LT(loudest - sound.begin(), kSampleRate / 1000);
    EXPECT_LT(std::abs(sound.back()), 0.01F);
    EXPECT_LE(std::abs(*loudest), 1.0F);
  }
  EXPECT_NE(click(true), click(false));
}

TEST(Samples, AnotherRateKeepsTheTone) {
  constexpr double kTone_hz = 800;
  Samples sound(22'050 / 4);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    sound[i] = static_cast<float>(std::sin(2 * std::numbers::pi * kTone_hz * static_cast<double>(i) / 22'050));
  }
  const Samples out = resampled(sound, 22'050);
  ASSERT_EQ(out.size(), 11'999U);
  for (std::size_t i = 200; i + 200 < out.size(); ++i) {
    const double t = static_cast<double>(i) / kSampleRate;
    ASSERT_NEAR(out[i], std::sin(2 * std::numbers::pi * kTone_hz * t), 2e-3) << i;
  }
  EXPECT_EQ(resampled(sound, kSampleRate), sound);
}

TEST(Samples, WhatIsSilentBeforeASoundIsCutOff) {
  Samples sound(1000, 0.0F);
  sound[300] = 0.5F;
  sound[400] = -0.5F;
  EXPECT_EQ(trimmed(sound, 1).size(), 101U);
  EXPECT_EQ(trimmed(sound, 1).front(), 0.5F);
  EXPECT_EQ(trimmed(Samples(100, 0.001F), 1), Samples{});
  const Samples cut = trimmed(Samples(kSampleRate, 0.5F), 0.1);
  EXPECT_EQ(cut.size(), 4800U);
  EXPECT_EQ(cut.back(), 0.0F);
}

TEST(MixerProperty, EverySoundBeginsAtItsSampleWhateverTheBlocks) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    Mixer mixer;
    std::vector<Sounding> sounds;
    std::vector<std::size_t> at;
    for (int i = 0; i < 5; ++i) {
      const std::size_t sample = 100 + rng.below(40'000);
      at.push_back(sample);
      sounds.push_back({Instant(Duration(std::llround(static_cast<double>(sample) * 1e9 / kSampleRate))), impulse()});
    }
    mixer.plan(sounds);
    std::vector<float> out;
    while (out.size() < 48'000) {
      std::vector<float> block(1 + rng.below(700));
      mixer.render(Instant(Duration(static_cast<std::int64_t>(out.size()) * 1'000'000'000 / kSampleRate)), block);
      out.insert(out.end(), block.begin(), block.end());
      // Planned again and again, as a desk that looks fifty times a second does: nothing sounds twice.
      mixer.plan(sounds);
    }
    std::vector<float> wanted(out.size(), 0.0F);
    for (const std::size_t sample : at) {
      wanted[sample] += 1.0F;
      wanted[sample + 1] += 0.5F;
    }
    for (float& sample : wanted) sample = std::min(sample, 1.0F);
    RC_ASSERT(out == wanted);
  }));
}

TEST(Mixer, WhatIsTooLateIsLeftOut) {
  Mixer mixer;
  std::vector<float> block(480);
  mixer.plan({{instant_at(1), impulse()}});
  mixer.render(instant_at(1.02), block);
  EXPECT_EQ(block[0], 1.0F) << "20 ms late";
  mixer.plan({{instant_at(2), impulse()}});
  mixer.render(instant_at(2.05), block);
  EXPECT_EQ(block[0], 0.0F) << "50 ms late";
}

TEST(Mixer, WhatIsCalledOffIsNotHeard) {
  Mixer mixer;
  std::vector<float> block(480);
  mixer.plan({{instant_at(1), impulse()}});
  mixer.plan({});
  mixer.render(instant_at(1), block);
  EXPECT_EQ(block, std::vector<float>(480, 0.0F));
}

DeskView counting_in(double goes_at_s, int percent) {
  DeskView view;
  view.show.phase = Phase::counts_in;
  view.show.goes_at = instant_at(goes_at_s);
  view.show.percent = percent;
  return view;
}

TEST(CountIn, SaysTheCountsBeforeTheFirstStep) {
  const Show show = tests::random_show(6, 6, 4, 1, 2, 1).show;  // 120 counts a minute
  EXPECT_EQ(count_in_beats(show, counting_in(10, 100), 4), (std::vector<Beat>{{instant_at(8), 1, true},
                                                                              {instant_at(8.5), 2, false},
                                                                              {instant_at(9), 3, false},
                                                                              {instant_at(9.5), 4, false},
                                                                              {instant_at(10), 0, true}}));
  EXPECT_EQ(count_in_beats(show, counting_in(10, 50), 2.5),
            (std::vector<Beat>{{instant_at(8), 1, true}, {instant_at(9), 2, false}, {instant_at(10), 0, true}}));
  const auto ten = count_in_beats(show, counting_in(10, 100), 10);
  ASSERT_EQ(ten.size(), 11U);
  EXPECT_EQ(ten[0].number, 0);
  EXPECT_EQ(ten[1].number, 0);
  EXPECT_EQ(ten[2].number, 1);
  EXPECT_EQ(ten[9].number, 8);
  EXPECT_TRUE(count_in_beats(show, counting_in(10, 100), 0).empty());
  DeskView runs = counting_in(10, 100);
  runs.show.phase = Phase::runs;
  EXPECT_TRUE(count_in_beats(show, runs, 4).empty());
}

TEST(CountIn, OfAResetMoveEndsWhenPeopleBeginToWalk) {
  const Show show = tests::random_show(6, 6, 4, 1, 2, 1).show;
  Plan way;
  way.sections = {{"start", kStart, instant_at(2), 1, {}, {}, {}},
                  {"places", instant_at(5), instant_at(5), 1, {}, {}, {}}};
  DeskView view;
  view.way = std::make_shared<const Plan>(way);
  view.show.phase = Phase::resets;
  view.show.goes_at = instant_at(7);
  const std::vector<Beat> wanted{{instant_at(7), 1, true},
                                 {instant_at(7.5), 2, false},
                                 {instant_at(8), 3, false},
                                 {instant_at(8.5), 4, false},
                                 {instant_at(9), 0, true}};
  EXPECT_EQ(count_in_beats(show, view, 4), wanted);
  view.show.goes_at = kNever;
  view.show.at = instant_at(7.25);
  view.show.target.show_time = seconds(0.25);
  EXPECT_EQ(count_in_beats(show, view, 4), wanted) << "a look later";
}

TEST(ClickTrack, HasAClickForEachCountAndAccentsForMeasures) {
  const auto beats = click_track(TempoMap(120, 4), kStart, instant_at(4));
  ASSERT_EQ(beats.size(), 9U);
  for (std::size_t i = 0; i < beats.size(); ++i) {
    EXPECT_EQ(beats[i].at, instant_at(0.5 * static_cast<double>(i)));
    EXPECT_EQ(beats[i].accented, i % 4 == 0);
  }
}

#if FOOTLIGHT_WITH_SNDFILE

TEST(ClickFile, HasEveryClickAtItsSample) {
  const test::TemporaryFolder folder;
  const TempoMap tempo(113, 3);
  const auto beats = click_track(tempo, instant_at(-1), instant_at(20));
  ASSERT_TRUE(write_clicks(folder / "click.wav", beats, instant_at(-1)));
  const auto heard = SoundFile::read(folder / "click.wav");
  ASSERT_TRUE(heard);
  for (const Beat& beat : beats) {
    const auto at = static_cast<std::size_t>(std::llround((to_seconds(beat.at) + 1) * kSampleRate));
    for (std::size_t i = 100; i < 1000 && at > i; ++i) ASSERT_EQ((*heard)[at - i], 0.0F) << to_seconds(beat.at);
    const Samples wanted = click(beat.accented);
    for (std::size_t i = 0; i < 500; ++i) ASSERT_NEAR((*heard)[at + i], wanted[i], 1e-4F) << to_seconds(beat.at);
  }
}

class HeardTest : public ::testing::Test {
 protected:
  HeardTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {
    path_before_ = std::getenv("PATH");
  }
  ~HeardTest() override { setenv("PATH", path_before_.c_str(), 1); }
  /// A program in the place of espeak-ng.
  void speak_by(const std::string& script) {
    const std::string program = folder_.write("espeak-ng", "#!/bin/sh\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("PATH", (folder_.path().string() + ":" + path_before_).c_str(), 1);
  }
  void look(HeardCountIn& sound, DeskView view) {
    view.now = clock_.now() - seconds(3);  // the run began 3 s after this clock
    sound.look(view, desk_);
  }
  test::TemporaryFolder folder_;
  tests::SmallShow small_;
  RunDesk desk_;
  ManualClock clock_;
  std::string path_before_;
};

TEST_F(HeardTest, AFileHasEveryClickAtItsSample) {
  speak_by("exit 1\n");
  const std::string file = folder_ / "count.wav";
  {
    auto sound = HeardCountIn::open(small_.show, {file, "xx"}, 4, clock_);
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_EQ((*sound)->lacks(), "espeak-ng does not speak \"xx\": the count-in is clicked and not spoken");
    for (int i = 0; i < 250; ++i) {
      clock_.advance(milliseconds(20));
      // GO at 1.0 s, first count 0.12 s later; the run's clock is 3 s behind.
      const bool counts = clock_.now() >= instant_at(1) && clock_.now() < instant_at(3.12);
      DeskView view = counts ? counting_in(0.12, 100) : DeskView{};
      if (clock_.now() >= instant_at(3.12)) view.show.phase = Phase::runs;
      look(**sound, view);
    }
  }
  const auto heard = SoundFile::read(file);
  ASSERT_TRUE(heard) << heard.error().message;
  EXPECT_EQ(heard->size(), 240'000U);
  std::vector<std::size_t> begins;
  for (std::size_t i = 1; i < heard->size(); ++i) {
    const bool silent = i < 4800 || std::all_of(heard->begin() + static_cast<std::ptrdiff_t>(i) - 2400,
                                                heard->begin() + static_cast<std::ptrdiff_t>(i),
                                                [](float s) { return std::abs(s) < 1e-3F; });
    if (std::abs((*heard)[i]) > 1e-3F && silent) begins.push_back(i);
  }
  // The first sample of a click is silent. Counts at 1.12, 1.62, 2.12, 2.62 s, the GO at 3.12 s.
  EXPECT_EQ(begins, (std::vector<std::size_t>{53'761, 77'761, 101'761, 125'761, 149'761}));
}

TEST_F(HeardTest, NumbersAreSpokenByAnotherProgram) {
  // It "says" a number by a WAV file of that many samples of sound.
  auto one = SoundFile::create(folder_ / "tone.wav");
  ASSERT_TRUE(one);
  Samples tone(4800, 0.0F);
  for (std::size_t i = 960; i < 2400; ++i) tone[i] = 0.5F;
  ASSERT_TRUE(one->write(tone));
  one = SoundFile::create(folder_ / "other.wav");
  speak_by("while [ \"$1\" != -w ]; do shift; done\ncp '" + (folder_ / "tone.wav") + "' \"$2\"\n");
  const auto voice = speak_numbers("de");
  ASSERT_TRUE(voice) << voice.error().message;
  for (std::size_t n = 1; n <= 8; ++n) EXPECT_EQ(voice->numbers[n]->size(), 1440U) << "silence is cut off";
  EXPECT_EQ(voice->numbers[0], nullptr);
}

TEST_F(HeardTest, WithoutTheProgramThereIsAReason) {
  setenv("PATH", folder_.path().c_str(), 1);
  EXPECT_EQ(speak_numbers("en").error().message,
            "espeak-ng is not installed: the count-in is clicked and not spoken (apt install espeak-ng)");
}

TEST_F(HeardTest, AFileThatCannotBeWrittenIsRefused) {
  const auto sound = HeardCountIn::open(small_.show, {"/nonexistent/count.wav", "en"}, 4, clock_);
  ASSERT_FALSE(sound);
  EXPECT_EQ(sound.error().kind, ErrorKind::input);
  EXPECT_NE(sound.error().message.find("cannot write '/nonexistent/count.wav': "), std::string::npos);
}

#endif

TEST(SoundDevice, OneThatIsNotThereIsToldWithItsName) {
  const auto device = SoundDevice::open("no-such-device");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::device);
  EXPECT_TRUE(device.error().message.starts_with("sound device \"no-such-device\": ")) << device.error().message;
}

}  // namespace
}  // namespace footlight::app
