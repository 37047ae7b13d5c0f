// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/time.hpp"

namespace footlight {

/// The machine's monotonic clock since it was started: the same for every program on it, and one that is started later
/// reads on. Steps of the wall clock do not move it; it stands while the machine is suspended.
[[nodiscard]] Duration machine_time();

/// Another text after every start of the machine: times of `machine_time` compare only where it is equal. Empty where
/// the machine does not tell.
[[nodiscard]] std::string machine_start();

}  // namespace footlight
