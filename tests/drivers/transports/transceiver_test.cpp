// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/transceiver.hpp"

#include <gtest/gtest.h>

#include "drivers/transports/serial_stream.hpp"
#include "tests/drivers/transports/pseudo_terminal.hpp"

namespace footlight::drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// What happened on a line, in order: "speak", "4 bytes", "listen".
using Story = std::vector<std::string>;

class TellingTransceiver final : public Transceiver {
 public:
  TellingTransceiver(Story& story, bool& broken) : story_(story), broken_(broken) {}
  bool turn(bool speak) override {
    story_.emplace_back(speak ? "speak" : "listen");
    return !broken_;
  }

 private:
  Story& story_;
  bool& broken_;
};

class TellingDevice final : public SerialDevice {
 public:
  explicit TellingDevice(Story& story) : story_(story) {}
  std::optional<std::size_t> write_some(std::span<const std::uint8_t> bytes) override {
    story_.push_back(std::to_string(bytes.size()) + " bytes");
    return bytes.size();
  }
  std::optional<std::size_t> read_some(std::span<std::uint8_t> /*buffer*/) override { return 0; }
  [[nodiscard]] int poll_handle() const override { return -1; }

 private:
  Story& story_;
};

class TurnedLine : public ::testing::Test {
 protected:
  Story story_;
  bool broken_ = false;
  std::unique_ptr<TurnedDevice> device_ = std::make_unique<TurnedDevice>(
      std::make_unique<TellingDevice>(story_), std::make_unique<TellingTransceiver>(story_, broken_), SerialSettings{});
};

TEST_F(TurnedLine, SpeaksOnlyWhileItSends) {
  EXPECT_TRUE(device_->turned_by_us());
  EXPECT_EQ(device_->write_some(Bytes{1, 2, 3, 4}), 4U);
  EXPECT_EQ(story_, (Story{"speak", "4 bytes", "listen"}));
}

TEST_F(TurnedLine, ListensWhenItIsClosed) {
  device_.reset();
  EXPECT_EQ(story_, Story{"listen"});
}

TEST_F(TurnedLine, OneThatCannotBeTurnedSendsNothing) {
  broken_ = true;
  EXPECT_EQ(device_->write_some(Bytes{1}), std::nullopt);
  EXPECT_EQ(story_, Story{"speak"});
}

std::string refusal_of(LineDirection direction) {
  SerialLine line;
  line.direction = direction;
  line.direction_chip = "gpiochip99";
  const PseudoTerminal terminal;
  const auto opened = open_serial(terminal.path(), {.line = line});
  return opened ? "" : opened.error().message.substr(opened.error().message.find(": ") + 2);
}

TEST(Transceiver, AdaptersTurnByThemselves) { EXPECT_EQ(refusal_of(LineDirection::adapter), ""); }

TEST(Transceiver, APortThatCannotTurnSaysWhatCould) {
  EXPECT_EQ(refusal_of(LineDirection::kernel),
            "its kernel driver cannot turn an RS-485 line: Inappropriate ioctl for device (direction: rts or gpio, or "
            "adapter where the adapter does it by itself)");
  EXPECT_EQ(refusal_of(LineDirection::rts),
            "the line that turns it cannot be set: Inappropriate ioctl for device (direction: gpio, or adapter where "
            "the adapter does it by itself)");
  const std::string gpio = refusal_of(LineDirection::gpio);
  EXPECT_TRUE(gpio.starts_with("GPIO line 0 of \"gpiochip99\": ")) << gpio;
}

TEST(Transceiver, AwaitsWhatIsStillOnItsWay) {
  const PseudoTerminal terminal;
  await_sent(terminal.near(), milliseconds(2));  // a pseudo-terminal has no shift register: the time alone
  await_sent(-1, Duration{});                    // gone: at once
}

}  // namespace
}  // namespace footlight::drivers
