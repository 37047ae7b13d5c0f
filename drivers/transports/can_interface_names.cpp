// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <net/if_arp.h>

#include "drivers/transports/can_interface.hpp"

namespace footlight::drivers {

std::vector<std::string> can_interface_names(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code none;  // a folder that is not there has no interfaces
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::ifstream file(entry.path() / "type");
    int type = 0;
    if (file >> type && type == ARPHRD_CAN) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace footlight::drivers
