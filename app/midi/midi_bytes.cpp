// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_bytes.hpp"

namespace footlight::app {
namespace {

constexpr std::uint8_t kExclusive = 0xF0;
constexpr std::uint8_t kEndOfExclusive = 0xF7;
constexpr std::uint8_t kFirstRealTime = 0xF8;

/// With the status byte; 0: a status that is not defined, or one that has another end.
std::size_t size_of_message(std::uint8_t status) {
  switch (status & 0xF0U) {
    case 0xC0:
    case 0xD0:
      return 2;
    case 0xF0:
      break;
    default:
      return 3;
  }
  switch (status) {
    case 0xF1:
    case 0xF3:
      return 2;
    case 0xF2:
      return 3;
    case 0xF6:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

std::span<const std::uint8_t> MidiBytes::begin(std::uint8_t status) noexcept {
  if (size_ > 0 && (bytes_[0] == kExclusive || (size_ > 1 && size_ < wanted_))) ++lost_;
  too_long_ = false;
  bytes_[0] = status;
  wanted_ = size_of_message(status);
  size_ = wanted_ > 0 || status == kExclusive ? 1 : 0;
  if (wanted_ != 1) return {};
  size_ = 0;
  return {bytes_.data(), 1};
}

std::span<const std::uint8_t> MidiBytes::take(std::uint8_t byte) noexcept {
  if (byte >= kFirstRealTime) {
    real_time_ = byte;
    return {&real_time_, 1};
  }
  const bool exclusive = size_ > 0 && bytes_[0] == kExclusive;
  if (byte == kEndOfExclusive && exclusive) {
    const std::size_t size = size_ + 1;
    size_ = 0;
    if (too_long_ || size > bytes_.size()) {
      ++lost_;
      return {};
    }
    bytes_[size - 1] = byte;
    return {bytes_.data(), size};
  }
  if (byte >= 0x80) return begin(byte);
  if (size_ == 0) return {};  // data of nothing
  if (size_ == bytes_.size()) {
    too_long_ = true;
    return {};
  }
  bytes_[size_++] = byte;
  if (exclusive || size_ < wanted_) return {};
  const std::size_t size = size_;
  size_ = bytes_[0] < kExclusive ? 1 : 0;  // running status
  return {bytes_.data(), size};
}

}  // namespace footlight::app
