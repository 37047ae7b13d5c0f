// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr std::array<std::uint16_t, 256> ccitt_table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned crc = i << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    table[i] = static_cast<std::uint16_t>(crc);
  }
  return table;
}

template <class Word>
constexpr std::array<Word, 256> reflected_table(Word polynomial) {
  std::array<Word, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    Word crc = static_cast<Word>(i);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<Word>(static_cast<Word>(crc >> 1U) ^ ((crc & 1U) != 0 ? polynomial : Word{0}));
    }
    table[i] = crc;
  }
  return table;
}

constexpr auto kCcitt = ccitt_table();
constexpr auto kModbus = reflected_table<std::uint16_t>(0xA001);
constexpr auto kIeee = reflected_table<std::uint32_t>(0xEDB88320U);

}  // namespace

std::uint16_t crc16_ccitt(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>((crc << 8U) ^ kCcitt[((crc >> 8U) ^ byte) & 0xFFU]);
  }
  return crc;
}

std::uint16_t crc16_modbus(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>((crc >> 8U) ^ kModbus[(crc ^ byte) & 0xFFU]);
  }
  return crc;
}

std::uint32_t crc32_ieee(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) crc = (crc >> 8U) ^ kIeee[(crc ^ byte) & 0xFFU];
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace footlight::sim
