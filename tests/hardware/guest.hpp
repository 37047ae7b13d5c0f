// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "core/time.hpp"

namespace footlight::hardware {

/// Runs a command of the shell, which must succeed.
/// @return what it wrote; a failure is a failure of the test
std::string run(const std::string& command);

/// Waits for something that comes by itself. Guests are slow: the limit is there to end a test that fails, no promise.
/// @return what `condition` said last
bool eventually(const std::function<bool()>& condition, Duration limit = seconds(10));

/// The monotonic clock of the guest.
[[nodiscard]] Instant guest_now();

/// Pulls a device out of the guest and puts one in, by QEMU's control channel (QMP), which ends inside the guest. The
/// names are those of tests/hardware/boot: sja0, sja1, ftdi0, ftdi1. After `unplug` the device is gone; after `plug`
/// wait for what it brings about.
void unplug(const std::string& device);
/// @param arguments as QMP's device_add wants them: R"("driver":"usb-serial","chardev":"ftdia","id":"ftdi0")"
void plug(const std::string& arguments);

}  // namespace footlight::hardware
