// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {

std::vector<std::string> gpio_chip_paths(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code none;  // a folder that is not there has no chips
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path().string());
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace footlight::drivers
