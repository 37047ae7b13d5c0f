// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/modbus_port.hpp"

#include <gtest/gtest.h>

namespace footlight::drivers {
namespace {

ModbusRequest write_of(std::uint16_t registers, std::uint8_t unit = 7) {
  return {unit, 0x10, 0, registers, std::vector<std::uint16_t>(registers)};
}

TEST(ModbusTiming, CharactersHaveElevenBitsAndSilenceIsThreeAndAHalf) {
  EXPECT_EQ(rtu_silence(19'200), Duration(2'005'209));
  EXPECT_EQ(rtu_silence(9'600), Duration(4'010'417));
  EXPECT_EQ(rtu_silence(115'200), microseconds(1750)) << "fixed above 19,200 Bd";
}

TEST(ModbusTiming, WithoutParityACharacterIsABitShorter) {
  EXPECT_EQ(rtu_silence(9'600, 10), Duration(3'645'834));
  EXPECT_EQ(rtu_silence(115'200, 10), microseconds(1750));
  EXPECT_EQ(rtu_wire_time(write_of(3, 0), 100'000, 10), microseconds(1500 + 1750));
}

TEST(ModbusTiming, FramesHaveTheirLength) {
  EXPECT_EQ(rtu_request_bytes(write_of(17)), 43U);
  EXPECT_EQ(rtu_reply_bytes(write_of(17)), 8U);
  const ModbusRequest read{7, 0x03, 0x40, 6, {}};
  EXPECT_EQ(rtu_request_bytes(read), 8U);
  EXPECT_EQ(rtu_reply_bytes(read), 17U);
  const ModbusRequest single{7, 0x06, 0x40, 1, {9}};
  EXPECT_EQ(rtu_request_bytes(single), 8U);
  EXPECT_EQ(rtu_reply_bytes(single), 8U);
}

TEST(ModbusTiming, ABroadcastHasNoAnswer) {
  // 15 characters of 11 bits at 110,000 bit/s are 1.5 ms.
  EXPECT_EQ(rtu_wire_time(write_of(3, 0), 110'000), microseconds(1500 + 1750));
  EXPECT_EQ(rtu_wire_time(write_of(3, 7), 110'000), microseconds(1500 + 1750 + 5000 + 800 + 1750));
}

#if !FOOTLIGHT_WITH_libmodbus
TEST(ModbusPort, SaysThatItWasBuiltWithoutItsLibrary) {
  EXPECT_EQ(open_modbus_rtu("/dev/ttyS9", SerialSettings{}).error().message,
            "Modbus line \"/dev/ttyS9\": this program was built without libmodbus (install libmodbus-dev and build "
            "again)");
  EXPECT_EQ(open_modbus_tcp("marker", 502, {1}).error().message,
            "Modbus device \"marker:502\": this program was built without libmodbus (install libmodbus-dev and build "
            "again)");
}
#endif

}  // namespace
}  // namespace footlight::drivers
