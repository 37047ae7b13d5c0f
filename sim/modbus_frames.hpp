// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/transport.hpp"

namespace footlight::sim {

/// The port's side of Modbus, as a library such as libmodbus has it.

/// Function code and data of a request. Functions 0x01, 0x03, 0x05, 0x06, 0x0F, 0x10; others are a programmer's error.
[[nodiscard]] std::vector<std::uint8_t> request_pdu(const drivers::ModbusRequest& request);
/// Bytes of the reply's function code and data when nothing goes wrong.
[[nodiscard]] std::size_t reply_pdu_size(const drivers::ModbusRequest& request);

/// Address, function code and data, check sum.
[[nodiscard]] std::vector<std::uint8_t> rtu_frame(std::uint8_t unit, std::span<const std::uint8_t> pdu);
/// Takes an RTU frame for the reply to a request, as libmodbus does: by unit, function and counts, for RTU has nothing
/// else to tell replies apart by. @return nothing when another unit has spoken, which is passed over
[[nodiscard]] std::optional<drivers::ModbusReply> rtu_reply(const drivers::ModbusRequest& request,
                                                            std::span<const std::uint8_t> frame);

/// Transaction, protocol, length, unit, function code and data.
[[nodiscard]] std::vector<std::uint8_t> tcp_frame(std::uint16_t transaction, std::uint8_t unit,
                                                  std::span<const std::uint8_t> pdu);
/// @return nothing when the frame belongs to another transaction
[[nodiscard]] std::optional<drivers::ModbusReply> tcp_reply(const drivers::ModbusRequest& request,
                                                            std::uint16_t transaction,
                                                            std::span<const std::uint8_t> frame);

}  // namespace footlight::sim
