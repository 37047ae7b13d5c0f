// SPDX-License-Identifier: Apache-2.0
#include "sim/can_bits.hpp"

#include <array>

#include "core/check.hpp"

namespace footlight::sim {
namespace {

constexpr unsigned kPolynomial = 0x4599;
constexpr int kHeaderBits = 19;  // start of frame, 11 of identifier, RTR, IDE, r0, 4 of length
constexpr int kCrcBits = 15;

constexpr std::array<std::uint16_t, 256> crc_table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned crc = i << 7U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc & 0x4000U) != 0 ? kPolynomial : 0U);
    table[i] = static_cast<std::uint16_t>(crc & 0x7FFFU);
  }
  return table;
}

/// How far a run of equal bits has come: (length - 1) * 2 + bit, length 1..5. A run of five has its stuff bit still to
/// come, which starts the next run.
struct Step {
  std::uint8_t run = 0;
  std::uint8_t stuffed = 0;
};

constexpr Step step(unsigned run, unsigned bit) {
  unsigned last = run & 1U;
  unsigned length = (run >> 1U) + 1;
  std::uint8_t stuffed = 0;
  if (length == 5) {  // the stuff bit is the complement and the first of a new run
    last ^= 1U;
    length = 1;
    stuffed = 1;
  }
  length = bit == last ? length + 1 : 1;
  return {static_cast<std::uint8_t>((length - 1) * 2 + bit), stuffed};
}

constexpr std::array<std::array<Step, 256>, 10> stuff_table() {
  std::array<std::array<Step, 256>, 10> table{};
  for (unsigned run = 0; run < 10; ++run) {
    for (unsigned byte = 0; byte < 256; ++byte) {
      Step all{static_cast<std::uint8_t>(run), 0};
      for (unsigned bit = 0; bit < 8; ++bit) {
        const Step one = step(all.run, (byte >> (7U - bit)) & 1U);
        all = {one.run, static_cast<std::uint8_t>(all.stuffed + one.stuffed)};
      }
      table[run][byte] = all;
    }
  }
  return table;
}

constexpr auto kCrc = crc_table();
constexpr auto kStuff = stuff_table();

std::uint16_t crc_step(std::uint16_t crc, unsigned byte) {
  return static_cast<std::uint16_t>(((crc << 8U) ^ kCrc[((crc >> 7U) ^ byte) & 0xFFU]) & 0x7FFFU);
}

/// The 19 bits before the data; the start of frame, RTR, IDE and r0 are dominant: 0.
std::uint32_t header(const drivers::CanFrame& frame) { return (std::uint32_t{frame.id} << 7U) | frame.length; }

}  // namespace

std::uint16_t can_crc(const drivers::CanFrame& frame) {
  FL_CHECK(frame.length <= 8 && frame.id <= 0x7FF);
  const std::uint32_t head = header(frame);  // leading zeros leave a CRC that starts with 0 as it is: 24 bits are 19
  std::uint16_t crc = 0;
  for (const unsigned shift : {16U, 8U, 0U}) crc = crc_step(crc, (head >> shift) & 0xFFU);
  for (int i = 0; i < frame.length; ++i) crc = crc_step(crc, frame.data[static_cast<std::size_t>(i)]);
  return crc;
}

int can_stuff_bits(const drivers::CanFrame& frame) {
  const std::uint16_t crc = can_crc(frame);
  const std::uint32_t head = header(frame);
  // 19 + 8 n + 15 bits: the first three alone, then whole bytes, the last seven alone.
  unsigned run = 0;  // a run of one 0: the start of frame
  int stuffed = 0;
  const auto bits = [&](unsigned value, int count) {
    for (int i = count - 1; i >= 0; --i) {
      const Step one = step(run, (value >> static_cast<unsigned>(i)) & 1U);
      run = one.run;
      stuffed += one.stuffed;
    }
  };
  const auto byte = [&](unsigned value) {
    const Step all = kStuff[run][value & 0xFFU];
    run = all.run;
    stuffed += all.stuffed;
  };
  bits(head >> 16U, 2);
  byte(head >> 8U);
  byte(head);
  for (int i = 0; i < frame.length; ++i) byte(frame.data[static_cast<std::size_t>(i)]);
  byte(crc >> 7U);
  bits(crc, 7);
  return run >> 1U == 4 ? stuffed + 1 : stuffed;  // a run of five at the very end is stuffed, too
}

int can_frame_bits(const drivers::CanFrame& frame) {
  return kHeaderBits + 8 * frame.length + kCrcBits + can_stuff_bits(frame) + kCanTailBits;
}

int can_worst_frame_bits(int length) {
  const int stuffable = kHeaderBits + 8 * length + kCrcBits;
  return stuffable + (stuffable - 1) / 4 + kCanTailBits;
}

}  // namespace footlight::sim
