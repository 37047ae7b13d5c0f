// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/format.h>

#include "app/midi/midi_input.hpp"
#include "app/surfaces/show_timecode.hpp"
#include "app/time/time_source.hpp"
#include "controller/time/midi_clock.hpp"
#include "controller/time/mtc.hpp"

namespace footlight::app {
namespace {

constexpr double kLongestSong_quarters = 1e5;

/// Messages of a port, for one decoder or the other.
class MidiSource : public TimeSource {
 public:
  MidiSource(std::string name, std::unique_ptr<MidiInput> input) : name_(std::move(name)), input_(std::move(input)) {}
  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] int file() const override { return input_->poll_handle(); }

  TimeNews read(Instant /*now*/, const ShowState& /*show*/) override {
    TimeNews news;
    while (const auto message = input_->take()) take(*message, news);
    if (input_->closed() && !std::exchange(told_closed_, true)) news.alarms.push_back(name_ + ": the port is gone");
    return news;
  }

 protected:
  virtual void take(const MidiMessage& message, TimeNews& news) = 0;
  std::string name_;

 private:
  std::unique_ptr<MidiInput> input_;
  bool told_closed_ = false;
};

class MtcSource final : public MidiSource {
 public:
  MtcSource(const std::string& port, std::unique_ptr<MidiInput> input, const TimeRules& rules)
      : MidiSource("mtc " + port, std::move(input)), rules_(rules) {}

 private:
  void take(const MidiMessage& message, TimeNews& news) override {
    const auto fix = decoder_.take(message.view(), message.at);
    if (!fix) return;
    news.fixes.push_back({fix->at, in_show(fix->position, rules_)});
    const FrameRate rate = decoder_.last()->rate;
    if (rate == rules_.rate || std::exchange(told_rate_, true)) return;
    news.alarms.push_back(fmt::format("{}: {} frames a second, the show file says {}: it is followed as it is", name_,
                                      to_text(rate), to_text(rules_.rate)));
  }

  TimeRules rules_;
  controller::MtcDecoder decoder_;
  bool told_rate_ = false;
};

class MidiClockSource final : public MidiSource {
 public:
  MidiClockSource(const std::string& port, std::unique_ptr<MidiInput> input, const TempoMap& tempo)
      : MidiSource("midi-clock " + port, std::move(input)), tempo_(tempo) {}

 private:
  void take(const MidiMessage& message, TimeNews& news) override {
    const auto beat = decoder_.take(message.view(), message.at);
    // A count of the show is a quarter note of the song.
    if (beat && beat->quarters < kLongestSong_quarters) {
      news.fixes.push_back({beat->at, tempo_.at(1 + beat->quarters).time_since_epoch()});
    }
  }

  TempoMap tempo_;
  controller::MidiClockDecoder decoder_;
};

}  // namespace

Result<std::unique_ptr<TimeSource>> open_mtc(const std::string& port, const TimeRules& rules, const Clock& clock) {
  auto input = open_midi_input(port, clock);
  if (!input) return std::move(input).error();
  return std::unique_ptr<TimeSource>(std::make_unique<MtcSource>(port, std::move(input).value(), rules));
}

Result<std::unique_ptr<TimeSource>> open_midi_clock(const std::string& port, const TempoMap& tempo,
                                                    const Clock& clock) {
  auto input = open_midi_input(port, clock);
  if (!input) return std::move(input).error();
  return std::unique_ptr<TimeSource>(std::make_unique<MidiClockSource>(port, std::move(input).value(), tempo));
}

}  // namespace footlight::app
