// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace footlight::hardware {

/// A chip of gpio-sim with eight lines, gone with this object. What a wire does to an input is its `pull`; what an
/// output does to a wire is its `value`.
class GpioChip {
 public:
  GpioChip();
  ~GpioChip();
  GpioChip(const GpioChip&) = delete;
  GpioChip& operator=(const GpioChip&) = delete;

  static constexpr unsigned kLines = 8;
  [[nodiscard]] const std::string& name() const { return name_; }
  void pull(unsigned line, bool up) const;
  [[nodiscard]] bool value(unsigned line) const;

 private:
  std::string name_;    ///< gpiochip0
  std::string folder_;  ///< of the chip's lines in sysfs
};

}  // namespace footlight::hardware
