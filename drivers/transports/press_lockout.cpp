// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {

bool PressLockout::take(bool pressed, Instant now) {
  if (pressed) {
    at_rest_since_.reset();
    const bool first = !locked_;
    locked_ = true;
    return first;
  }
  if (!at_rest_since_) at_rest_since_ = now;
  if (now - *at_rest_since_ >= lockout_) locked_ = false;
  return false;
}

}  // namespace footlight::drivers
