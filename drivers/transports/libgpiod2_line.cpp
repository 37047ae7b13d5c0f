// SPDX-License-Identifier: Apache-2.0
// Version 2 of libgpiod; version 1 has another interface (libgpiod_line.cpp).
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <gpiod.h>

#include "core/check.hpp"
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {
namespace {

constexpr const char* kConsumer = "footlight";

/// The library's objects have a function each that frees them.
template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Free<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Free<gpiod_chip_info_free>>;
using LineSettings = std::unique_ptr<gpiod_line_settings, Free<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Free<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Free<gpiod_request_config_free>>;
using LineRequest = std::unique_ptr<gpiod_line_request, Free<gpiod_line_request_release>>;
using EventBuffer = std::unique_ptr<gpiod_edge_event_buffer, Free<gpiod_edge_event_buffer_free>>;

class Libgpiod2Line final : public GpioLine {
 public:
  Libgpiod2Line(LineRequest request, unsigned offset, bool input, std::string name)
      : request_(std::move(request)),
        events_(gpiod_edge_event_buffer_new(1)),
        offset_(offset),
        input_(input),
        name_(std::move(name)) {
    FL_CHECK(events_ != nullptr);
  }

  Status<> set(bool on) override {
    FL_CHECK(!input_);
    const auto value = on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(request_.get(), offset_, value) != 0) return failed("not set");
    return Done{};
  }
  Result<bool> read() override {
    FL_CHECK(input_);
    const auto value = gpiod_line_request_get_value(request_.get(), offset_);
    if (value == GPIOD_LINE_VALUE_ERROR) return failed("not read");
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }
  Result<std::optional<bool>> take_edge() override {
    FL_CHECK(input_);
    const int waiting = gpiod_line_request_wait_edge_events(request_.get(), 0);
    if (waiting == 0) return std::optional<bool>{};
    if (waiting < 0 || gpiod_line_request_read_edge_events(request_.get(), events_.get(), 1) < 1) {
      return failed("its edges are not read");
    }
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(events_.get(), 0);
    return std::optional<bool>(gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE);
  }
  [[nodiscard]] int poll_handle() const override { return input_ ? gpiod_line_request_get_fd(request_.get()) : -1; }

 private:
  [[nodiscard]] Error failed(const std::string& what) const {
    return device_error(name_ + ": " + what + ": " + std::generic_category().message(errno));
  }

  LineRequest request_;
  EventBuffer events_;
  unsigned offset_;
  bool input_;
  std::string name_;
};

/// By path, by name or by label, as version 1 did it.
Chip open_chip(const std::string& chip) {
  if (chip.find('/') != std::string::npos) return Chip(gpiod_chip_open(chip.c_str()));
  if (Chip named(gpiod_chip_open(("/dev/" + chip).c_str())); named) return named;
  const int reason = errno;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", none)) {
    if (!gpiod_is_gpiochip_device(entry.path().c_str())) continue;
    Chip candidate(gpiod_chip_open(entry.path().c_str()));
    if (!candidate) continue;
    const ChipInfo info(gpiod_chip_get_info(candidate.get()));
    if (info && chip == gpiod_chip_info_get_label(info.get())) return candidate;
  }
  errno = reason;
  return nullptr;
}

LineRequest request_line(gpiod_chip* chip, unsigned offset, const GpioSettings& settings) {
  const LineSettings line(gpiod_line_settings_new());
  const LineConfig config(gpiod_line_config_new());
  const RequestConfig request(gpiod_request_config_new());
  if (!line || !config || !request) return nullptr;
  gpiod_line_settings_set_active_low(line.get(), settings.active_low);
  if (settings.direction == GpioSettings::Direction::input) {
    gpiod_line_settings_set_direction(line.get(), GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_edge_detection(line.get(), GPIOD_LINE_EDGE_BOTH);
    constexpr std::array kBias{GPIOD_LINE_BIAS_AS_IS, GPIOD_LINE_BIAS_PULL_UP, GPIOD_LINE_BIAS_PULL_DOWN};
    gpiod_line_settings_set_bias(line.get(), kBias.at(static_cast<std::size_t>(settings.bias)));
  } else {
    gpiod_line_settings_set_direction(line.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(line.get(), GPIOD_LINE_VALUE_INACTIVE);
  }
  gpiod_request_config_set_consumer(request.get(), kConsumer);
  if (gpiod_line_config_add_line_settings(config.get(), &offset, 1, line.get()) != 0) return nullptr;
  return LineRequest(gpiod_chip_request_lines(chip, request.get(), config.get()));
}

}  // namespace

Result<std::unique_ptr<GpioLine>> open_gpio(const std::string& chip, unsigned offset, const GpioSettings& settings) {
  const std::string name = "GPIO line " + std::to_string(offset) + " of \"" + chip + "\"";
  const Chip owner = open_chip(chip);
  if (!owner) {
    return device_error(name + ": no such chip: " + std::generic_category().message(errno) +
                        " (one that `gpiodetect` lists)");
  }
  const ChipInfo info(gpiod_chip_get_info(owner.get()));
  const std::size_t lines = info ? gpiod_chip_info_get_num_lines(info.get()) : 0;
  if (offset >= lines) return device_error(name + ": no such line (0.." + std::to_string(lines - 1) + ")");
  LineRequest request = request_line(owner.get(), offset, settings);
  if (!request) {
    return device_error(name + ": not given to us: " + std::generic_category().message(errno) +
                        " (a line that nobody uses, see `gpioinfo`)");
  }
  const bool input = settings.direction == GpioSettings::Direction::input;
  return std::unique_ptr<GpioLine>(std::make_unique<Libgpiod2Line>(std::move(request), offset, input, name));
}

Result<GpioChip> read_gpio_chip(const std::string& path) {
  const Chip chip(gpiod_chip_open(path.c_str()));
  const ChipInfo info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
  if (!info) {
    return device_error("GPIO chip \"" + path + "\": not opened: " + std::generic_category().message(errno) +
                        " (membership of the group gpio)");
  }
  return GpioChip{gpiod_chip_info_get_name(info.get()), gpiod_chip_info_get_label(info.get()),
                  static_cast<unsigned>(gpiod_chip_info_get_num_lines(info.get()))};
}

}  // namespace footlight::drivers
