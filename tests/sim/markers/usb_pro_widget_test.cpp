// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/usb_pro_widget.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace footlight::sim {
namespace {

using Octets = std::vector<std::uint8_t>;

/// A line of tests/data/wire/dmx.txt.
Octets golden(const std::string& name) {
  std::ifstream file(std::string(FOOTLIGHT_TEST_DATA) + "/wire/dmx.txt");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(name + ": ")) continue;
    std::istringstream text(line.substr(name.size() + 2));
    Octets bytes;
    for (std::string byte; text >> byte;) bytes.push_back(static_cast<std::uint8_t>(std::stoul(byte, nullptr, 16)));
    return bytes;
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(UsbProWidget, TakesAPacketInAnyPieces) {
  UsbProWidget widget;
  for (const std::uint8_t byte : golden("packet")) EXPECT_TRUE(widget.receive(Octets{byte}).empty());
  EXPECT_EQ(widget.packets(), 1U);
  EXPECT_EQ(widget.sent(), 24U);
  EXPECT_EQ(widget.slots()[0], 255);
  EXPECT_EQ(widget.slots()[4], 128);
}

TEST(UsbProWidget, TellsItsSerialNumberAndItsParameters) {
  UsbProWidget widget;
  EXPECT_EQ(widget.receive(golden("ask-serial")), golden("serial"));
  EXPECT_EQ(widget.receive(golden("ask-parameters")), golden("parameters"));
}

TEST(UsbProWidget, IgnoresWhatItDoesNotKnowAndWhatIsWrong) {
  UsbProWidget widget;
  Octets no_end = golden("packet");
  no_end.back() = 0;
  EXPECT_TRUE(widget.receive(no_end).empty());
  EXPECT_TRUE(widget.receive(Octets{0x7E, 77, 0, 0, 0xE7}).empty());
  Octets other_start_code = golden("packet");
  other_start_code[4] = 0xCC;  // RDM
  widget.receive(other_start_code);
  widget.receive(Octets{0x7E, 6, 2, 0, 0, 255, 0xE7});  // fewer than 24 slots
  widget.receive(Octets{0x7E, 6, 0xFF, 0xFF});          // longer than any message
  EXPECT_EQ(widget.packets(), 0U);
  widget.receive(golden("packet"));
  EXPECT_EQ(widget.packets(), 1U) << "in step again";
}

TEST(UsbProWidget, AnyBytesAreHarmless) {
  EXPECT_TRUE(rc::check([](const Octets& bytes) {
    UsbProWidget widget;
    widget.receive(bytes);
    RC_ASSERT(widget.sent() <= UsbProWidget::kSlots);
  }));
}

}  // namespace
}  // namespace footlight::sim
