// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/sdo_client.hpp"

#include <algorithm>

namespace footlight::drivers::canopen {
namespace {

constexpr std::uint16_t kRequest = 0x600;
constexpr std::uint16_t kAnswer = 0x580;
constexpr std::uint8_t kAbort = 0x80;
constexpr std::uint8_t kToggle = 0x10;
constexpr std::size_t kExpedited = 4;
constexpr std::size_t kSegment = 7;
constexpr std::size_t kLongest = 1024;  // of what we ask for; a node that sends without end is cut off

constexpr std::uint32_t kToggleNotAlternated = 0x05030000;
constexpr std::uint32_t kTimedOut = 0x05040000;
constexpr std::uint32_t kCommandUnknown = 0x05040001;
constexpr std::uint32_t kOutOfMemory = 0x05040005;

}  // namespace

CanFrame SdoClient::request(std::uint8_t command) const {
  return {static_cast<std::uint16_t>(kRequest + node_),
          8,
          {command, static_cast<std::uint8_t>(place_.index & 0xFFU), static_cast<std::uint8_t>(place_.index >> 8U),
           place_.sub}};
}

void SdoClient::begin(std::uint8_t node, ObjectPlace place) {
  state_ = State::waiting;
  node_ = node;
  place_ = place;
  in_segments_ = false;
  toggle_ = 0;
  sent_ = 0;
  data_.clear();
  abort_code_ = 0;
}

CanFrame SdoClient::read(std::uint8_t node, ObjectPlace place) {
  begin(node, place);
  writes_ = false;
  return request(0x40);
}

CanFrame SdoClient::write(std::uint8_t node, ObjectPlace place, std::span<const std::uint8_t> bytes) {
  begin(node, place);
  writes_ = true;
  data_.assign(bytes.begin(), bytes.end());
  if (!data_.empty() && data_.size() <= kExpedited) {
    CanFrame frame = request(static_cast<std::uint8_t>(0x23U | ((kExpedited - data_.size()) << 2U)));
    std::copy(data_.begin(), data_.end(), frame.data.begin() + 4);
    return frame;
  }
  CanFrame frame = request(0x21);
  for (unsigned i = 0; i < 4; ++i) frame.data.at(4 + i) = static_cast<std::uint8_t>((data_.size() >> (8U * i)) & 0xFFU);
  return frame;
}

CanFrame SdoClient::abort(std::uint32_t code) {
  state_ = State::aborted;
  abort_code_ = code;
  CanFrame frame = request(kAbort);
  for (unsigned i = 0; i < 4; ++i) frame.data.at(4 + i) = static_cast<std::uint8_t>((code >> (8U * i)) & 0xFFU);
  return frame;
}

CanFrame SdoClient::give_up() { return abort(kTimedOut); }

std::optional<CanFrame> SdoClient::take(const CanFrame& frame) {
  const bool ours = frame.kind == CanFrame::Kind::classic && frame.id == kAnswer + node_ && frame.length == 8;
  if (state_ != State::waiting || !ours) return std::nullopt;
  // An answer that names another object belongs to a transfer that is over.
  const bool names_ours =
      frame.data[1] == (place_.index & 0xFFU) && frame.data[2] == place_.index >> 8U && frame.data[3] == place_.sub;
  if (frame.data[0] == kAbort) {
    if (!names_ours) return std::nullopt;
    state_ = State::aborted;
    abort_code_ = 0;
    for (unsigned i = 0; i < 4; ++i) abort_code_ |= std::uint32_t{frame.data.at(4 + i)} << (8U * i);
    return std::nullopt;
  }
  if (in_segments_) return writes_ ? take_write_segment(frame) : take_read_segment(frame);
  return names_ours ? take_first(frame) : std::nullopt;
}

std::optional<CanFrame> SdoClient::take_first(const CanFrame& frame) {
  const std::uint8_t command = frame.data[0];
  if (writes_) {
    if (command != 0x60) return abort(kCommandUnknown);
    if (!data_.empty() && data_.size() <= kExpedited) {
      state_ = State::done;
      return std::nullopt;
    }
    in_segments_ = true;
    return next_write_segment();
  }
  if (command >> 5U != 2) return abort(kCommandUnknown);
  const bool expedited = (command & 0x02U) != 0;
  if (expedited) {
    const std::size_t unused = (command & 0x01U) != 0 ? (command >> 2U) & 3U : 0U;
    data_.assign(frame.data.begin() + 4, frame.data.begin() + 8 - static_cast<std::ptrdiff_t>(unused));
    state_ = State::done;
    return std::nullopt;
  }
  in_segments_ = true;
  CanFrame segment = request(0x60);
  std::fill(segment.data.begin() + 1, segment.data.begin() + 8, std::uint8_t{0});
  return segment;
}

std::optional<CanFrame> SdoClient::take_read_segment(const CanFrame& frame) {
  const std::uint8_t command = frame.data[0];
  if (command >> 5U != 0) return abort(kCommandUnknown);
  if ((command & kToggle) != toggle_) return abort(kToggleNotAlternated);
  const std::size_t size = kSegment - ((command >> 1U) & 7U);
  if (data_.size() + size > kLongest) return abort(kOutOfMemory);
  data_.insert(data_.end(), frame.data.begin() + 1, frame.data.begin() + 1 + static_cast<std::ptrdiff_t>(size));
  if ((command & 1U) != 0) {
    state_ = State::done;
    return std::nullopt;
  }
  toggle_ ^= kToggle;
  CanFrame segment = request(static_cast<std::uint8_t>(0x60U | toggle_));
  std::fill(segment.data.begin() + 1, segment.data.begin() + 8, std::uint8_t{0});
  return segment;
}

std::optional<CanFrame> SdoClient::take_write_segment(const CanFrame& frame) {
  if (frame.data[0] >> 5U != 1) return abort(kCommandUnknown);
  if ((frame.data[0] & kToggle) != toggle_) return abort(kToggleNotAlternated);
  if (sent_ >= data_.size()) {
    state_ = State::done;
    return std::nullopt;
  }
  toggle_ ^= kToggle;
  return next_write_segment();
}

CanFrame SdoClient::next_write_segment() {
  const std::size_t size = std::min(kSegment, data_.size() - sent_);
  const bool last = sent_ + size == data_.size();
  CanFrame segment = request(static_cast<std::uint8_t>(toggle_ | ((kSegment - size) << 1U) | (last ? 1U : 0U)));
  std::fill(segment.data.begin() + 1, segment.data.begin() + 8, std::uint8_t{0});
  std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(sent_), size, segment.data.begin() + 1);
  sent_ += size;
  return segment;
}

}  // namespace footlight::drivers::canopen
