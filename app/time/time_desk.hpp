// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "app/surfaces/run_desk.hpp"
#include "app/time/clock_watch.hpp"
#include "app/time/time_source.hpp"
#include "core/boot_time.hpp"
#include "core/clock.hpp"

namespace footlight::app {

/// Clocks of the machine besides the one that shows go by (ClockWatch).
struct OtherClocks {
  std::function<Duration()> boot = boot_time;
  std::function<Duration()> wall = wall_time;
};

/// The desk's place for a source of time: hands what it says to the cue thread, tells what came of it, and holds the
/// show when the machine has slept.
class TimeDesk final : public Surface {
 public:
  /// Borrows show and clock. @param source null: the machine's own clock; its times are by `clock`
  TimeDesk(const Show& show, std::unique_ptr<TimeSource> source, const Clock& clock, OtherClocks others = {});

  /// Before the run. @param run the clock of its answers and views
  void use(const Clock& run);
  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] int file() const override { return source_ ? source_->file() : -1; }
  [[nodiscard]] bool listens() const override { return false; }
  [[nodiscard]] std::string name() const { return source_ ? source_->name() : "internal"; }

 private:
  void watch(Instant now, RunDesk& desk);
  void tell_alarms(const DeskView& view, RunDesk& desk);
  [[nodiscard]] std::string text_of(const controller::Chase::View& view) const;

  const Show& show_;
  std::unique_ptr<TimeSource> source_;
  const Clock& clock_;
  OtherClocks others_;
  Duration run_ahead_{};  ///< the run's clock less ours
  ClockWatch watch_;
  std::uint32_t alarms_ = 0;
};

}  // namespace footlight::app
