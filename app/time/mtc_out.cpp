// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "app/live/seqlock.hpp"
#include "app/live/waiting.hpp"
#include "app/midi/midi_output.hpp"
#include "app/time/time_out.hpp"

namespace footlight::app {
namespace {

constexpr Duration kIdle = milliseconds(50);

class MtcOut final : public TimeOut {
 public:
  MtcOut(std::string name, std::unique_ptr<MidiOutput> output, const TimeRules& rules)
      : name_(std::move(name)), output_(std::move(output)), rules_(rules), waiting_(clock_), writer_(rules.rate) {
    thread_ = std::thread([this] { run(); });
  }
  ~MtcOut() override {
    stopping_.store(true);
    waiting_.wake();
    thread_.join();
  }

  void look(const DeskView& view, RunDesk& desk) override {
    const Duration age = run_ == nullptr ? Duration{} : run_->now() - view.show.at;
    time_.write(running_time(view.show, rules_, clock_.now() - age));
    known_.store(true);
    waiting_.wake();
    if (lost_.load() > 0 && !std::exchange(told_lost_, true)) {
      desk.tell({RunEvent::Kind::alarm, name_ + ": messages are lost: nobody takes them"});
    }
  }

 private:
  void run() noexcept {
    while (!stopping_.load()) {
      const Instant now = clock_.now();
      Instant next = now + kIdle;
      if (known_.load()) {
        const controller::RunningTime time = time_.read();
        for (auto message = writer_.take(time, now); !message.empty(); message = writer_.take(time, now)) {
          if (!output_->send(message)) ++lost_;
        }
        next = std::min(next, writer_.next_event(time));
      }
      waiting_.until(next);
    }
  }

  std::string name_;
  std::unique_ptr<MidiOutput> output_;
  TimeRules rules_;
  SteadyClock clock_;
  Waiting waiting_;
  controller::MtcWriter writer_;
  SeqLock<controller::RunningTime> time_;
  std::atomic<bool> known_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> lost_{0};
  bool told_lost_ = false;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<TimeOut>> open_mtc_out(const std::string& port, const TimeRules& rules) {
  auto output = open_midi_output(port);
  if (!output) return std::move(output).error();
  return std::unique_ptr<TimeOut>(std::make_unique<MtcOut>("mtc:" + port, std::move(output).value(), rules));
}

}  // namespace footlight::app
