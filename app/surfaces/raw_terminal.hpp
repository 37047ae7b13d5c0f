// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace footlight::app {

/// Keys come one by one and are not echoed, while this lives; Ctrl-Z and Ctrl-S stop nothing. The terminal is as it was
/// again whatever ends the program: its end, a signal, an abort; only SIGKILL leaves it (`stty sane`).
class RawTerminal {
 public:
  /// One at a time. Where stdin is no terminal nothing happens.
  RawTerminal();
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// Whether there are keys.
  [[nodiscard]] static bool there();
};

/// For what ends the program past every destructor. A signal handler may call it; again and again is harmless.
void restore_terminal() noexcept;

}  // namespace footlight::app
