// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "drivers/transports/gpio_line.hpp"

namespace footlight::app {

/// A GPIO line whose wire a test holds in its hand.
class FakeLine final : public drivers::GpioLine {
 public:
  struct Wire {
    bool level = false;
    std::deque<bool> edges{};
    bool gone = false;
    void go(bool to) {
      level = to;
      edges.push_back(to);
    }
  };
  explicit FakeLine(Wire& wire) : wire_(wire) {}

  Status<> set(bool on) override {
    if (wire_.gone) return device_error("gone");
    wire_.level = on;
    return Done{};
  }
  Result<bool> read() override {
    if (wire_.gone) return device_error("gone");
    return wire_.level;
  }
  Result<std::optional<bool>> take_edge() override {
    if (wire_.gone) return device_error("gone");
    if (wire_.edges.empty()) return std::optional<bool>{};
    const bool edge = wire_.edges.front();
    wire_.edges.pop_front();
    return std::optional<bool>(edge);
  }
  [[nodiscard]] int poll_handle() const override { return -1; }

 private:
  Wire& wire_;
};

}  // namespace footlight::app
