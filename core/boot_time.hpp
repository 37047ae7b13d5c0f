// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/time.hpp"

namespace footlight {

/// Time since the machine was started, that in which it slept included: beside a steady clock it tells of the sleep,
/// and nothing is timed by it.
[[nodiscard]] Duration boot_time();

}  // namespace footlight
