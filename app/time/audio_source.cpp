// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/live/cue_thread.hpp"
#include "app/live/spsc_ring.hpp"
#include "app/live/waiting.hpp"
#include "app/time/audio_player.hpp"
#include "app/time/time_source.hpp"

namespace footlight::app {
namespace {

constexpr Duration kStep = milliseconds(10);
constexpr Duration kTell = milliseconds(30);

/// Music that begins and stops with the show. A thread of its own feeds the output: whoever asks may be slow.
class AudioSource final : public TimeSource {
 public:
  AudioSource(std::string name, std::unique_ptr<AudioPlayer> player, std::string note, const TimeRules& rules,
              const Clock& clock)
      : name_(std::move(name)), player_(std::move(player)), note_(std::move(note)), rules_(rules), clock_(clock) {
    thread_ = std::thread([this] { run(); });
  }
  ~AudioSource() override {
    stopping_.store(true);
    thread_.join();
  }
  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] bool goes_with_the_show() const override { return true; }

  TimeNews read(Instant /*now*/, const ShowState& show) override {
    using Phase = controller::Rehearsal::Phase;
    AudioPlayer::Wanted wanted;
    wanted.plays = show.phase == Phase::counts_in || show.phase == Phase::runs;
    wanted.at = show.phase == Phase::counts_in ? show.goes_at : show.at;
    wanted.position = show.position.time_since_epoch() + rules_.start;
    wanted.percent = show.wanted_percent;
    {
      const std::lock_guard lock(mutex_);
      wanted_ = wanted;
    }
    TimeNews news;
    while (const auto fix = fixes_.pop()) news.fixes.push_back(*fix);
    if (!note_.empty()) news.notes.push_back(std::exchange(note_, {}));
    if (refuses_.load() && !std::exchange(told_, true)) {
      news.alarms.push_back(name_ + ": the music stays at 100 %: this program was built without SoundTouch");
    }
    return news;
  }

 private:
  void run() {
    const Waiting waiting(clock_);
    Instant told{};
    for (Instant next = clock_.now(); !stopping_.load(); next += kStep) {
      AudioPlayer::Wanted wanted;
      {
        const std::lock_guard lock(mutex_);
        wanted = wanted_;
      }
      const Instant now = clock_.now();
      player_->step(now, wanted);
      refuses_.store(player_->refuses_speed());
      const auto position = player_->position(now);
      if (position && now - told >= kTell) {
        told = now;
        (void)fixes_.push({now, *position - rules_.start});
      }
      next = std::max(next, now - kStep);
      waiting.until(next + kStep);
    }
  }

  std::string name_;
  std::unique_ptr<AudioPlayer> player_;
  std::string note_;
  TimeRules rules_;
  const Clock& clock_;
  std::mutex mutex_;
  AudioPlayer::Wanted wanted_;
  SpscRing<TimeFix, 64> fixes_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> refuses_{false};
  bool told_ = false;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<TimeSource>> open_audio(const std::string& what, const std::filesystem::path& folder,
                                               const TimeRules& rules, const Clock& clock) {
  std::string note;
  const std::string name = "audio " + what;
  auto player = AudioPlayer::open(folder / what, [&](int channels, int sample_rate) {
    auto output = open_alsa_output("default", channels, sample_rate);
    if (output) return std::move(output).value();
    note = name + ": nobody hears it, its time is the machine's: " + output.error().message;
    return clocked_output(channels, sample_rate);
  });
  if (!player) return std::move(player).error();
  return std::unique_ptr<TimeSource>(
      std::make_unique<AudioSource>(name, std::move(player).value(), note, rules, clock));
}

}  // namespace footlight::app
