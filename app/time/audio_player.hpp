// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/time/sound_output.hpp"
#include "app/time/time_stretch.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

struct sf_private_tag;

namespace footlight::app {

/// Music as the master of time: it begins and stops with the show, and from then on says where it is, by what has been
/// heard of it. Pure stepping. One thread.
class AudioPlayer {
 public:
  struct Wanted {
    bool plays = false;
    Instant at{};         ///< the file is to be at `position` then; the past: now
    Duration position{};  ///< of the file, at its own speed
    int percent = 100;    ///< of its speed
  };
  using MakeOutput = std::function<std::unique_ptr<SoundOutput>(int channels, int sample_rate)>;

  /// Errors: as open_sound_file.
  [[nodiscard]] static Result<std::unique_ptr<AudioPlayer>> open(const std::filesystem::path& file,
                                                                 const MakeOutput& make_output);
  ~AudioPlayer();

  /// Plays on until `now`. Wants to be called at least ten times a second.
  void step(Instant now, const Wanted& wanted);
  /// Of the file, as it is heard; nothing while it does not play.
  [[nodiscard]] std::optional<Duration> position(Instant now) const;
  /// A speed that is asked for and cannot be had: this program has no SoundTouch.
  [[nodiscard]] bool refuses_speed() const { return refuses_speed_; }
  [[nodiscard]] bool over() const { return over_; }

 private:
  struct CloseFile {
    void operator()(sf_private_tag* file) const;
  };
  /// What was written last: frame `written` of the output is frame `source` of the file.
  struct Mark {
    std::size_t written = 0;
    double source = 0;
    bool music = false;  ///< else silence before it
  };
  using File = std::unique_ptr<sf_private_tag, CloseFile>;

  AudioPlayer(File file, int channels, int sample_rate, std::unique_ptr<SoundOutput> output);
  void begin(Instant now, const Wanted& wanted);
  void fill(Instant now, int percent);
  std::size_t read(std::vector<float>& frames, std::size_t count);
  void write(std::span<const float> frames, Instant now, bool music);
  void forget(Instant now);

  File file_;
  std::size_t channels_;
  int sample_rate_;
  std::unique_ptr<SoundOutput> output_;
  std::unique_ptr<TimeStretch> stretch_;
  bool plays_ = false;
  bool stretches_ = false;
  bool refuses_speed_ = false;
  bool over_ = false;
  double read_ = 0;          ///< frame of the file that is read next
  std::size_t silence_ = 0;  ///< frames of it that come first
  std::size_t written_ = 0;  ///< frames, since it began to play
  std::deque<Mark> marks_;
};

}  // namespace footlight::app
