// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/live/cue_thread.hpp"
#include "core/file_descriptor.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// The messages of sd_notify(3), to systemd or to our own supervisor: the address is in $NOTIFY_SOCKET, how often to
/// say that one lives follows from $WATCHDOG_USEC. Where nobody has asked for them nothing happens.
class Notifier {
 public:
  Notifier();
  [[nodiscard]] bool wanted() const { return socket_.get() >= 0; }
  /// Half of the time after which the watchdog takes us for dead; none: there is no watchdog.
  [[nodiscard]] std::optional<Duration> period() const { return period_; }
  /// Does not block; a message that is not taken is lost.
  void say(std::string_view message) const noexcept;

 private:
  FileDescriptor socket_;
  std::string address_;  ///< as $NOTIFY_SOCKET has it
  std::optional<Duration> period_;
};

/// Says that the run is ready when the roll call is over, and that it lives only while the cue thread does: what it has
/// published has to be newer each time. One thread, which waits for no other one.
class Watchdog {
 public:
  /// Some fifty times a second. @param state what the cue thread has published last
  void beat(const ShowState& state, bool roll_called);
  /// The run ends: that the cue thread says nothing from here on is no sign of death. Any thread, after the last
  /// `beat`.
  void end() const noexcept { notifier_.say("STOPPING=1"); }

 private:
  Notifier notifier_;
  bool ready_told_ = false;
  std::optional<Instant> lived_at_;  ///< when the cue thread had said the last thing that was passed on
};

}  // namespace footlight::app
