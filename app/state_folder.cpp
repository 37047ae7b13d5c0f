// SPDX-License-Identifier: Apache-2.0
#include "app/state_folder.hpp"

#include "app/environment.hpp"

namespace footlight::app {

std::filesystem::path state_folder(const std::string& chosen) {
  if (!chosen.empty()) return chosen;
  if (const std::string state = environment("STATE_DIRECTORY"); !state.empty()) return state;
  if (const std::string state = environment("XDG_STATE_HOME"); !state.empty()) {
    return std::filesystem::path(state) / "footlight";
  }
  const std::string home = environment("HOME");
  return std::filesystem::path(home.empty() ? "/tmp" : home) / ".local" / "state" / "footlight";
}

}  // namespace footlight::app
