// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "drivers/transport.hpp"
#include "drivers/transports/serial_device.hpp"

namespace footlight::drivers {

// Modbus ports over libmodbus; each says so when the program was built without that library. They block inside `submit`
// for as long as the device takes, at most until the time-out, and so want a thread for each bus. `down` means that the
// wire or the connection is gone; the next `submit` opens it anew. What to do after an answer that has not come is the
// driver's affair: nothing is thrown away but by `discard`.

/// Bytes of request and reply on a serial line: address, PDU, CRC (Modbus over Serial Line V1.02).
[[nodiscard]] std::size_t rtu_request_bytes(const ModbusRequest& request);
[[nodiscard]] std::size_t rtu_reply_bytes(const ModbusRequest& request);
/// 3.5 characters, 1.75 ms above 19,200 Bd. @param bits_per_character 11, as the standard has it, or 10
[[nodiscard]] Duration rtu_silence(int bits_per_second, int bits_per_character = 11);
/// Silences, request, 5 ms turnaround and reply; of a broadcast request and one silence.
[[nodiscard]] Duration rtu_wire_time(const ModbusRequest& request, int bits_per_second, int bits_per_character = 11);

/// @param place as of open_serial_device
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<ModbusPort>> open_modbus_rtu(const std::string& place,
                                                                  const SerialSettings& settings);

/// One connection, to a device or a gateway. A request to unit 0 goes to each of `units` in turn without awaiting the
/// answers in between. The first `submit` connects, so that a host that is switched off delays neither the start nor
/// other buses: it is `down` until it answers.
/// Errors: ErrorKind::device for a program built without libmodbus.
[[nodiscard]] Result<std::unique_ptr<ModbusPort>> open_modbus_tcp(const std::string& host, int port,
                                                                  std::vector<std::uint8_t> units);

}  // namespace footlight::drivers
