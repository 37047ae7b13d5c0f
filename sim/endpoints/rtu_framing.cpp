// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/rtu_framing.hpp"

#include <algorithm>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr std::size_t kCheckSum = 2;
constexpr std::size_t kLongest = 256;

bool check_sum_fits(std::span<const std::uint8_t> frame) {
  const std::uint16_t check = crc16_modbus(frame.first(frame.size() - kCheckSum));
  return frame[frame.size() - 2] == (check & 0xFFU) && frame[frame.size() - 1] == (check >> 8U);
}

}  // namespace

std::size_t rtu_request_size(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return 0;
  switch (bytes[1]) {
    case 0x01:
    case 0x02:
    case 0x03:
    case 0x04:
    case 0x05:
    case 0x06:
    case 0x08:
      return 8;
    case 0x07:
    case 0x0B:
    case 0x0C:
    case 0x11:
      return 4;
    case 0x0F:
    case 0x10:
      return bytes.size() < 7 ? 0 : 9 + std::size_t{bytes[6]};
    case 0x16:
      return 10;
    case 0x17:
      return bytes.size() < 11 ? 0 : 13 + std::size_t{bytes[10]};
    default:
      return 0;
  }
}

void RtuFraming::take(std::span<const std::uint8_t> bytes, Instant now) {
  if (bytes.empty()) return;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  last_ = now;
}

std::optional<std::vector<std::uint8_t>> RtuFraming::next(Instant now) {
  if (bytes_.empty()) return std::nullopt;
  std::size_t size = rtu_request_size(bytes_);
  if (size == 0 || size > bytes_.size() || !check_sum_fits(std::span(bytes_).first(size))) {
    if (now < silence_at() && bytes_.size() < kLongest) return std::nullopt;
    size = std::min(bytes_.size(), kLongest);
  }
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(size);
  std::vector<std::uint8_t> frame(bytes_.begin(), end);
  bytes_.erase(bytes_.begin(), end);
  return frame;
}

}  // namespace footlight::sim
