// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/usb_pro_widget.hpp"

#include <algorithm>

namespace footlight::sim {
namespace {

constexpr std::uint8_t kStartOfMessage = 0x7E;
constexpr std::uint8_t kEndOfMessage = 0xE7;
constexpr std::size_t kHead = 4;
constexpr std::size_t kFewestSlots = 24;

enum Label : std::uint8_t { kGetParameters = 3, kSendPacket = 6, kGetSerialNumber = 10 };

std::vector<std::uint8_t> message(std::uint8_t label, const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> out{kStartOfMessage, label, static_cast<std::uint8_t>(data.size() & 0xFFU),
                                static_cast<std::uint8_t>(data.size() >> 8U)};
  out.insert(out.end(), data.begin(), data.end());
  out.push_back(kEndOfMessage);
  return out;
}

}  // namespace

std::vector<std::uint8_t> UsbProWidget::receive(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> answer;
  for (const std::uint8_t byte : bytes) {
    if (message_.empty() && byte != kStartOfMessage) continue;
    message_.push_back(byte);
    if (message_.size() < kHead) continue;
    const std::size_t length = message_[2] | (std::size_t{message_[3]} << 8U);
    if (length > kLongestData) {
      message_.clear();
      continue;
    }
    if (message_.size() < kHead + length + 1) continue;
    if (byte == kEndOfMessage) obey(answer);
    message_.clear();
  }
  return answer;
}

void UsbProWidget::obey(std::vector<std::uint8_t>& answer) {
  const std::span<const std::uint8_t> data(message_.data() + kHead, message_.size() - kHead - 1);
  const auto say = [&](std::uint8_t label, const std::vector<std::uint8_t>& content) {
    const auto bytes = message(label, content);
    answer.insert(answer.end(), bytes.begin(), bytes.end());
  };
  switch (message_[1]) {
    case kSendPacket:
      // Start code 0 is dimmer data; packets of another one are not for lamps.
      if (data.size() < kFewestSlots + 1 || data.size() > kSlots + 1 || data[0] != 0) return;
      sent_ = data.size() - 1;
      std::copy(data.begin() + 1, data.end(), slots_.begin());
      ++packets_;
      return;
    case kGetParameters: {
      if (data.size() != 2) return;
      // Firmware 1.4, break of 9 and mark of 1 (10.67 us each), 40 packets a second, then what a user has stored.
      std::vector<std::uint8_t> parameters{4, 1, 9, 1, 40};
      parameters.resize(5 + std::min<std::size_t>(508, data[0] | (std::size_t{data[1]} << 8U)));
      say(kGetParameters, parameters);
      return;
    }
    case kGetSerialNumber:
      if (data.empty()) say(kGetSerialNumber, {0x78, 0x56, 0x34, 0x12});  // 12345678
      return;
    default:
      return;
  }
}

}  // namespace footlight::sim
