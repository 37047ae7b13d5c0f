// SPDX-License-Identifier: Apache-2.0
// Version 1 of libgpiod; version 2 has another interface (libgpiod2_line.cpp).
#include <cerrno>
#include <ctime>
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
  LibgpiodLine(Chip chip, gpiod_line* line, bool input, std::string name)
      : chip_(std::move(chip)), line_(line), input_(input), name_(std::move(name)) {}

  Status<> set(bool on) override {
    FL_CHECK(!input_);
    if (gpiod_line_set_value(line_, on ? 1 : 0) != 0) return failed("not set");
    return Done{};
  }
  Result<bool> read() override {
    FL_CHECK(input_);
    const int value = gpiod_line_get_value(line_);
    if (value < 0) return failed("not read");
    return value == 1;
  }
  Result<std::optional<bool>> take_edge() override {
    FL_CHECK(input_);
    const timespec at_once{};
    const int waiting = gpiod_line_event_wait(line_, &at_once);
    if (waiting == 0) return std::optional<bool>{};
    gpiod_line_event event{};
    if (waiting < 0 || gpiod_line_event_read(line_, &event) != 0) return failed("its edges are not read");
    return std::optional<bool>(event.event_type == GPIOD_LINE_EVENT_RISING_EDGE);
  }
  [[nodiscard]] int poll_handle() const override { return input_ ? gpiod_line_event_get_fd(line_) : -1; }

 private:
  [[nodiscard]] Error failed(const std::string& what) const {
    return device_error(name_ + ": " + what + ": " + std::generic_category().message(errno));
  }

  Chip chip_;
  gpiod_line* line_;  ///< owned by the chip
  bool input_;
  std::string name_;
};

int flags_of(const GpioSettings& settings) {
  int flags = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (settings.bias == GpioSettings::Bias::pull_up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (settings.bias == GpioSettings::Bias::pull_down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

}  // namespace

Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset, const GpioSettings& settings) {
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
  const bool input = settings.direction == GpioSettings::Direction::input;
  const int flags = flags_of(settings);
  const int result = input ? gpiod_line_request_both_edges_events_flags(line, kConsumer, flags)
                           : gpiod_line_request_output_flags(line, kConsumer, flags, 0);
  if (result != 0) {
    return device_error(name + ": not given to us: " + std::generic_category().message(errno) +
                        " (a line that nobody uses, see `gpioinfo`)");
  }
  return std::unique_ptr<GpioLine>(std::make_unique<LibgpiodLine>(std::move(owner), line, input, name));
}

Result<GpioChip> read_gpio_chip(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()));
  if (!chip) {
    return device_error("GPIO chip \"" + path + "\": not opened: " + std::generic_category().message(errno) +
                        " (membership of the group gpio)");
  }
  return GpioChip{gpiod_chip_name(chip.get()), gpiod_chip_label(chip.get()), gpiod_chip_num_lines(chip.get())};
}

}  // namespace footlight::drivers
