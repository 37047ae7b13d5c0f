// SPDX-License-Identifier: Apache-2.0
#include "sim/trace.hpp"

#include <ostream>

namespace footlight::sim {

void Trace::line(Instant at, std::string_view bus, char direction, std::string_view hex, std::string_view note) {
  const auto nanoseconds = at.time_since_epoch().count();
  const auto rest = nanoseconds % 1000 < 0 ? -(nanoseconds % 1000) : nanoseconds % 1000;
  buffer_.clear();
  if (nanoseconds < 0 && nanoseconds > -1000) buffer_ += '-';
  buffer_ += std::to_string(nanoseconds / 1000);
  buffer_ += '.';
  buffer_ += static_cast<char>('0' + rest / 100);
  buffer_ += static_cast<char>('0' + rest / 10 % 10);
  buffer_ += static_cast<char>('0' + rest % 10);
  buffer_.append(" ").append(bus).append(" ") += direction;
  buffer_.append(" ").append(hex.empty() ? "-" : hex);
  if (!note.empty()) buffer_.append(" ").append(note);
  buffer_ += '\n';
  out_->write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  text.reserve(bytes.size() * 2);
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0xFU];
  }
  return text;
}

}  // namespace footlight::sim
