// SPDX-License-Identifier: Apache-2.0
#include "tests/hardware/gpio_chip.hpp"

#include <fstream>

#include "tests/hardware/guest.hpp"

namespace footlight::hardware {
namespace {

constexpr const char* kConfig = "/sys/kernel/config/gpio-sim/footlight";

std::string word_in(const std::string& file) {
  std::string word;
  std::ifstream(file) >> word;
  return word;
}

}  // namespace

GpioChip::GpioChip() {
  const std::string config = kConfig;
  run("mkdir -p " + config + "/bank && echo " + std::to_string(kLines) + " > " + config +
      "/bank/num_lines && echo 1 > " + config + "/live");
  name_ = word_in(config + "/bank/chip_name");
  folder_ = "/sys/devices/platform/" + word_in(config + "/dev_name") + "/" + name_;
  eventually([&] { return std::ifstream("/dev/" + name_).good(); });
}

GpioChip::~GpioChip() {
  const std::string config = kConfig;
  run("echo 0 > " + config + "/live; rmdir " + config + "/bank " + config);
}

void GpioChip::pull(unsigned line, bool up) const {
  std::ofstream(folder_ + "/sim_gpio" + std::to_string(line) + "/pull") << (up ? "pull-up" : "pull-down") << std::flush;
}

bool GpioChip::value(unsigned line) const {
  return word_in(folder_ + "/sim_gpio" + std::to_string(line) + "/value") == "1";
}

}  // namespace footlight::hardware
