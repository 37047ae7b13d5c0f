// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/transport.hpp"

namespace footlight::sim {

/// Bits from the CRC delimiter to the end of frame: delimiter, acknowledge slot, its delimiter, seven of EOF. Not
/// stuffed.
inline constexpr int kCanTailBits = 10;
inline constexpr int kCanInterframeBits = 3;

/// CRC-15 of a data frame, from start of frame to the last data bit, unstuffed (ISO 11898-1, polynomial 0x4599).
[[nodiscard]] std::uint16_t can_crc(const drivers::CanFrame& frame);
/// Stuff bits that a frame really needs: one after each five equal bits from start of frame to the end of the CRC,
/// stuff bits counting as well. O(length), by table.
[[nodiscard]] int can_stuff_bits(const drivers::CanFrame& frame);
/// Bits of a data frame on the wire, start of frame to end of frame, without the inter-frame space.
[[nodiscard]] int can_frame_bits(const drivers::CanFrame& frame);
/// The same at worst stuffing: 8 n + 44 + floor((8 n + 33) / 4) for n bytes (Tindell, Burns, Wellings 1995).
[[nodiscard]] int can_worst_frame_bits(int length);

}  // namespace footlight::sim
