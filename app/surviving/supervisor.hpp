// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace footlight::app {

/// How a program that is watched over has ended.
struct ChildEnd {
  bool by_signal = false;
  int number = 0;  ///< of the signal, or the exit status
};

/// Whether a program that has ended so is begun again: not what ends by its own will (0, wrong input, a refused plan,
/// an interruption), nor a device that was not right at the end; but one that was begun again and finds its ports busy.
/// @param ready it had said that it was  @param again it had been begun again
[[nodiscard]] bool begins_again(const ChildEnd& end, bool ready, bool again);

/// How long to wait before: nothing, unless it keeps dying young. @param young deaths in a row within `kYoung`
[[nodiscard]] Duration rest_before(int young);
inline constexpr Duration kYoung = milliseconds(1000);

/// Runs a program as a child and begins it again when it dies, with `--resume`, at once. The child has our stdin,
/// stdout and stderr; the terminal is as it was before each beginning. SIGTERM and SIGINT go on to the child and end
/// both. A child that says nothing as a watchdog wants it (`Notifier`) for `silence` is killed and begun again.
/// @param program path of its file  @param arguments its name first, without `--supervised`
/// @param note a line for people
/// @return the exit status of the last child; 128 + its signal where it was ended by the one that we passed on
[[nodiscard]] int supervise(const std::string& program, std::vector<std::string> arguments, Duration silence,
                            const std::function<void(const std::string&)>& note);

/// Our own command line, without `--supervised`; empty where the kernel does not tell.
[[nodiscard]] std::vector<std::string> own_arguments();

}  // namespace footlight::app
