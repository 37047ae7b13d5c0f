// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/transport.hpp"

namespace footlight::drivers {

/// One of tests/data/wire/*.txt: "name: hex bytes" or "name: 080#11", a name may stand on several lines.
class Golden {
 public:
  explicit Golden(const std::string& file) {
    std::ifstream stream(std::string(FOOTLIGHT_TEST_DATA) + "/wire/" + file);
    EXPECT_TRUE(stream) << file;
    for (std::string line; std::getline(stream, line);) {
      const auto colon = line.find(": ");
      if (line.starts_with('#') || colon == std::string::npos) continue;
      lines_[line.substr(0, colon)].push_back(line.substr(colon + 2));
    }
  }

  [[nodiscard]] std::vector<std::uint8_t> bytes(const std::string& name) const {
    std::vector<std::uint8_t> bytes;
    if (!lines_.contains(name)) ADD_FAILURE() << name << " is not in the file";
    std::istringstream text(lines_.contains(name) ? lines_.at(name).front() : "");
    for (std::string byte; text >> byte;) bytes.push_back(static_cast<std::uint8_t>(std::stoul(byte, nullptr, 16)));
    return bytes;
  }

  [[nodiscard]] std::vector<CanFrame> frames(const std::string& name) const {
    std::vector<CanFrame> frames;
    if (!lines_.contains(name)) ADD_FAILURE() << name << " is not in the file";
    for (const std::string& line : lines_.contains(name) ? lines_.at(name) : std::vector<std::string>{}) {
      CanFrame frame;
      frame.id = static_cast<std::uint16_t>(std::stoul(line.substr(0, 3), nullptr, 16));
      for (std::size_t at = 4; at < line.size(); at += 2) {
        frame.data.at(frame.length++) = static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16));
      }
      frames.push_back(frame);
    }
    return frames;
  }

 private:
  std::map<std::string, std::vector<std::string>> lines_;
};

}  // namespace footlight::drivers
