// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <system_error>
#include <utility>

#include <gpiod.h>

#include "core/check.hpp"
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {
namespace {

constexpr const char* kConsumer = "footlight";

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its lines
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

class LibgpiodLine final : public GpioLine {
 public:
  LibgpiodLine(Chip chip, gpiod_line* line, GpioDirection direction, std::string name)
      : chip_(std::move(chip)), line_(line), direction_(direction), name_(std::move(name)) {}

  Status<> set(bool on) override {
    FL_CHECK(direction_ == GpioDirection::output);
    if (gpiod_line_set_value(line_, on ? 1 : 0) != 0) return failed("not set");
    return Done{};
  }
  Result<bool> read() override {
    FL_CHECK(direction_ == GpioDirection::input);
    const int value = gpiod_line_get_value(line_);
    if (value < 0) return failed("not read");
    return value == 1;
  }

 private:
  [[nodiscard]] Error failed(const std::string& what) const {
    return device_error(name_ + ": " + what + ": " + std::generic_category().message(errno));
  }

  Chip chip_;
  gpiod_line* line_;  ///< owned by the chip
  GpioDirection direction_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset, GpioDirection direction) {
  const std::string name = "GPIO line " + std::to_string(offset) + " of \"" + chip + "\"";
  Chip owner(gpiod_chip_open_lookup(chip.c_str()));
  if (!owner) {
    return device_error(name + ": no such chip: " + std::generic_category().message(errno) +
                        " (one that `gpiodetect` lists)");
  }
  gpiod_line* line = gpiod_chip_get_line(owner.get(), offset);
  if (line == nullptr) {
    return device_error(name + ": no such line (0.." + std::to_string(gpiod_chip_num_lines(owner.get()) - 1) + ")");
  }
  const int result = direction == GpioDirection::input ? gpiod_line_request_input(line, kConsumer)
                                                       : gpiod_line_request_output(line, kConsumer, 0);
  if (result != 0) {
    return device_error(name + ": not given to us: " + std::generic_category().message(errno) +
                        " (a line that nobody uses, see `gpioinfo`)");
  }
  return std::unique_ptr<GpioLine>(std::make_unique<LibgpiodLine>(std::move(owner), line, direction, name));
}

}  // namespace footlight::drivers
