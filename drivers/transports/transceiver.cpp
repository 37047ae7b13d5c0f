// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/transceiver.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <thread>
#include <utility>

#include <linux/serial.h>
#include <sys/ioctl.h>

#include "core/clock.hpp"
#include "drivers/transports/gpio_line.hpp"

namespace footlight::drivers {
namespace {

constexpr Duration kWakeUp = microseconds(300);  // a sleep may end so much late
constexpr Duration kAskAgain = microseconds(50);
constexpr Duration kGiveUp = milliseconds(100);
constexpr unsigned kShiftRegisterEmpty = 0x01;  // TIOCSER_TEMT, which no header for programs has

std::string reason() { return std::generic_category().message(errno); }

class RtsTransceiver final : public Transceiver {
 public:
  RtsTransceiver(int file, bool inverted) : file_(file), inverted_(inverted) {}
  bool turn(bool speak) override {
    const int line = TIOCM_RTS;
    return ::ioctl(file_, speak != inverted_ ? TIOCMBIS : TIOCMBIC, &line) == 0;
  }

 private:
  int file_;
  bool inverted_;
};

class GpioTransceiver final : public Transceiver {
 public:
  GpioTransceiver(std::unique_ptr<GpioLine> line, bool inverted) : line_(std::move(line)), inverted_(inverted) {}
  bool turn(bool speak) override { return bool(line_->set(speak != inverted_)); }

 private:
  std::unique_ptr<GpioLine> line_;
  bool inverted_;
};

Status<> let_kernel_turn(int file, bool inverted) {
  struct serial_rs485 mode {};
  mode.flags = SER_RS485_ENABLED | (inverted ? SER_RS485_RTS_AFTER_SEND : SER_RS485_RTS_ON_SEND);
  if (::ioctl(file, TIOCSRS485, &mode) == 0) return Done{};
  return device_error("its kernel driver cannot turn an RS-485 line: " + reason() +
                      " (direction: rts or gpio, or adapter where the adapter does it by itself)");
}

}  // namespace

Result<std::unique_ptr<Transceiver>> make_transceiver(int file, const SerialLine& line) {
  std::unique_ptr<Transceiver> made;
  switch (line.direction) {
    case LineDirection::adapter:
      return made;
    case LineDirection::kernel: {
      const auto set = let_kernel_turn(file, line.direction_inverted);
      if (!set) return set.error();
      return made;
    }
    case LineDirection::rts:
      made = std::make_unique<RtsTransceiver>(file, line.direction_inverted);
      break;
    case LineDirection::gpio: {
      auto gpio = open_gpio(line.direction_chip, static_cast<unsigned>(line.direction_offset), {});
      if (!gpio) return gpio.error();
      made = std::make_unique<GpioTransceiver>(std::move(gpio).value(), line.direction_inverted);
      break;
    }
  }
  if (made->turn(false)) return made;
  return device_error("the line that turns it cannot be set: " + reason() +
                      " (direction: gpio, or adapter where the adapter does it by itself)");
}

void await_sent(int file, Duration written) {
  const SteadyClock clock;
  const Instant until = clock.now() + written + kGiveUp;
  if (written > kWakeUp) std::this_thread::sleep_for(written - kWakeUp);
  while (clock.now() < until) {
    int queued = 0;
    unsigned state = 0;
    if (::ioctl(file, TIOCOUTQ, &queued) != 0) return;  // gone
    const bool empty =
        ::ioctl(file, TIOCSERGETLSR, &state) == 0 ? (state & kShiftRegisterEmpty) != 0 : clock.now() >= until - kGiveUp;
    if (queued == 0 && empty) return;
    std::this_thread::sleep_for(kAskAgain);
  }
}

TurnedDevice::TurnedDevice(std::unique_ptr<SerialDevice> device, std::unique_ptr<Transceiver> transceiver,
                           SerialSettings settings)
    : device_(std::move(device)), transceiver_(std::move(transceiver)), settings_(std::move(settings)) {}

TurnedDevice::~TurnedDevice() { transceiver_->turn(false); }

std::optional<std::size_t> TurnedDevice::write_some(std::span<const std::uint8_t> bytes) {
  if (!transceiver_->turn(true)) return std::nullopt;
  const auto taken = device_->write_some(bytes);
  listen(settings_.time_of(taken.value_or(0)));
  return taken;
}

// Where these fail, the next write of our own says so.
void TurnedDevice::speak() { transceiver_->turn(true); }

void TurnedDevice::listen(Duration written) {
  await_sent(poll_handle(), written);
  transceiver_->turn(false);
}

}  // namespace footlight::drivers
