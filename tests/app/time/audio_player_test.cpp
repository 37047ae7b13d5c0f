// SPDX-License-Identifier: Apache-2.0
#include "app/time/audio_player.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <sndfile.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

constexpr int kSampleRate = 44'100;

/// Keeps what it plays.
class Recorder final : public SoundOutput {
 public:
  Recorder(std::unique_ptr<SoundOutput> output, std::vector<float>& heard)
      : output_(std::move(output)), heard_(heard) {}
  std::size_t room(Instant now) override { return output_->room(now); }
  void write(std::span<const float> frames, Instant now) override {
    heard_.insert(heard_.end(), frames.begin(), frames.end());
    output_->write(frames, now);
  }
  std::size_t waiting(Instant now) override { return output_->waiting(now); }
  void drop(Instant now) override { output_->drop(now); }

 private:
  std::unique_ptr<SoundOutput> output_;
  std::vector<float>& heard_;
};

/// A tone of 441 Hz for 20 s.
class AudioPlayerTest : public testing::Test {
 protected:
  void SetUp() override { write("tone.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16); }
  void write(const std::string& name, int format) {
    SF_INFO info{};
    info.samplerate = kSampleRate;
    info.channels = 1;
    info.format = format;
    SNDFILE* file = sf_open((folder_.path() / name).c_str(), SFM_WRITE, &info);
    ASSERT_NE(file, nullptr) << name;
    std::vector<float> tone(20 * kSampleRate);
    for (std::size_t i = 0; i < tone.size(); ++i) {
      tone[i] = 0.5F * static_cast<float>(std::sin(2 * std::numbers::pi * static_cast<double>(i) / 100));
    }
    sf_writef_float(file, tone.data(), static_cast<sf_count_t>(tone.size()));
    sf_close(file);
  }
  std::unique_ptr<AudioPlayer> player(const std::string& name = "tone.wav") {
    heard_.clear();
    auto opened = AudioPlayer::open(folder_.path() / name, [&](int channels, int sample_rate) {
      return std::make_unique<Recorder>(clocked_output(channels, sample_rate), heard_);
    });
    EXPECT_TRUE(opened);
    return std::move(opened).value();
  }
  /// Every 10 ms, as the program does.
  void run(AudioPlayer& player, const AudioPlayer::Wanted& wanted, double time_s) {
    for (const Instant end = now_ + seconds(time_s); now_ < end; now_ += milliseconds(10)) player.step(now_, wanted);
  }
  /// Of what was played between two of its frames.
  [[nodiscard]] double pitch_hz(double from_s, double to_s) const {
    int crossings = 0;
    for (auto i = static_cast<std::size_t>(from_s * kSampleRate); i + 1 < static_cast<std::size_t>(to_s * kSampleRate);
         ++i) {
      crossings += heard_[i] < 0 && heard_[i + 1] >= 0 ? 1 : 0;
    }
    return crossings / (to_s - from_s);
  }

  test::TemporaryFolder folder_;
  std::vector<float> heard_;
  Instant now_ = instant_at(100);
};

TEST_F(AudioPlayerTest, BeginsInTheMomentInWhichTheShowDoesAndSaysWhereItIs) {
  const auto music = player();
  AudioPlayer::Wanted wanted{true, now_ + milliseconds(730), seconds(3), 100};
  run(*music, wanted, 0.7);
  EXPECT_FALSE(music->position(now_)) << "it is silence yet";
  run(*music, wanted, 5.3);
  EXPECT_NEAR(to_seconds(*music->position(now_)), 3 + 6 - 0.73, 0.001);
  EXPECT_NEAR(pitch_hz(1, 4), 441, 1);
}

TEST_F(AudioPlayerTest, StopsAtOnceAndGoesOnWhereTheShowDoes) {
  const auto music = player();
  run(*music, {true, now_, seconds(0), 100}, 2);
  run(*music, {}, 1);
  EXPECT_FALSE(music->position(now_));
  const AudioPlayer::Wanted again{true, now_, seconds(8), 100};
  run(*music, again, 1);
  EXPECT_NEAR(to_seconds(*music->position(now_)), 9, 0.02);
}

TEST_F(AudioPlayerTest, AnotherTempoKeepsThePitch) {
  const auto music = player();
  if (!make_time_stretch(1, kSampleRate)) GTEST_SKIP() << "built without SoundTouch";
  for (const int percent : {80, 125}) {
    heard_.clear();
    run(*music, {}, 0.1);
    const AudioPlayer::Wanted wanted{true, now_, seconds(2), percent};
    run(*music, wanted, 3);
    const double first_s = to_seconds(*music->position(now_));
    run(*music, wanted, 4);
    EXPECT_NEAR(to_seconds(*music->position(now_)) - first_s, 4 * percent / 100.0, 0.05) << percent;
    EXPECT_NEAR(first_s, 2 + 3 * percent / 100.0, 0.1) << percent;
    EXPECT_NEAR(pitch_hz(2, 6), 441, 6) << percent;
    EXPECT_FALSE(music->refuses_speed());
  }
}

TEST_F(AudioPlayerTest, ATempoThatChangesOnTheWayIsHeardWithinTheBuffer) {
  const auto music = player();
  if (!make_time_stretch(1, kSampleRate)) GTEST_SKIP() << "built without SoundTouch";
  AudioPlayer::Wanted wanted{true, now_, seconds(0), 100};
  run(*music, wanted, 3);
  const double before_s = to_seconds(*music->position(now_));
  wanted.percent = 50;
  run(*music, wanted, 1);
  const double changed_s = to_seconds(*music->position(now_));
  run(*music, wanted, 4);
  EXPECT_NEAR(to_seconds(*music->position(now_)) - changed_s, 2, 0.05);
  wanted.percent = 100;
  run(*music, wanted, 1);
  const double back_s = to_seconds(*music->position(now_));
  run(*music, wanted, 2);
  EXPECT_NEAR(to_seconds(*music->position(now_)) - back_s, 2, 0.05);
  EXPECT_GT(back_s, before_s);
}

TEST_F(AudioPlayerTest, BehindItsEndTheTimeGoesOnInSilence) {
  const auto music = player();
  run(*music, {true, now_, seconds(19), 100}, 3);
  EXPECT_NEAR(to_seconds(*music->position(now_)), 22, 0.02);
  EXPECT_TRUE(music->over());
}

TEST_F(AudioPlayerTest, PlaysFlacAndMp3AndRefusesWhatIsNoMusic) {
  for (const auto& [name, format] : {std::pair{"tone.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16},
                                     {"tone.mp3", SF_FORMAT_MPEG | SF_FORMAT_MPEG_LAYER_III}}) {
    write(name, format);
    const auto music = player(name);
    run(*music, {true, now_, seconds(4), 100}, 3);
    EXPECT_NEAR(to_seconds(*music->position(now_)), 7, 0.02) << name;
    EXPECT_NEAR(pitch_hz(0.5, 2.5), 441, 2) << name;
  }
  std::ofstream(folder_.path() / "no.wav") << "no sound";
  const auto refused = AudioPlayer::open(folder_.path() / "no.wav", clocked_output);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("(a sound file is wanted: WAV, FLAC, MP3 ...)"), std::string::npos);
}

}  // namespace
}  // namespace footlight::app
