// SPDX-License-Identifier: Apache-2.0
#include "drivers/driver.hpp"

namespace footlight::drivers {

std::string_view to_text(Task task) {
  switch (task) {
    case Task::probe:
      return "probe";
    case Task::identify:
      return "identify";
    case Task::set_address:
      return "set-address";
    case Task::health:
      return "health";
    case Task::clock:
      return "clock";
    case Task::patch:
      return "patch";
  }
  return "probe";
}

std::string_view Driver::refusal(Task /*task*/) const { return "this marker language has no such command"; }

}  // namespace footlight::drivers
