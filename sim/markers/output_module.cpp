// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/output_module.hpp"

#include <algorithm>
#include <utility>

namespace footlight::sim {
namespace {

constexpr std::uint16_t kNmt = 0x000;
constexpr std::uint16_t kSync = 0x080;
constexpr std::uint16_t kSdoRequest = 0x600;
constexpr std::uint16_t kHeartbeats = 0x700;
constexpr std::uint8_t kGenericAndCommunicationError = 0x11;
constexpr std::uint16_t kPduTooShort = 0x8210;           // CiA 301, table 26
constexpr std::uint16_t kUnexpectedSyncLength = 0x8240;  // the same
constexpr std::uint32_t kInvalidPdo = 0x80000000U;
constexpr std::uint32_t kActsAtOnce = 255;
constexpr std::uint32_t kLastSynchronous = 240;
constexpr std::uint32_t kFirstAsynchronous = 254;
constexpr std::uint32_t kMostMapped = 8;
/// A module whose heartbeats are off still looks whether the controller lives.
constexpr Duration kLook = milliseconds(1000);

}  // namespace

OutputModuleNode::OutputModuleNode(std::uint8_t id, OutputModule module, NodeModel& model, std::uint32_t serial)
    : id_(id), module_(std::move(module)), model_(model), serial_(serial), sdo_(id, *this) {
  power_on();
}

void OutputModuleNode::power_on() {
  entries_.clear();
  highest_sub_.clear();
  const auto put = [&](std::uint16_t index, int sub, std::uint32_t value, int bytes, bool writable) {
    const auto at = static_cast<std::uint8_t>(sub);
    entries_[{index, at}] = {value, bytes, writable};
    if (sub > 0) highest_sub_[index] = std::max(highest_sub_[index], at);
  };
  const int bytes = module_.bytes();
  put(0x1000, 0, 0x00020191, 4, false);
  put(0x1001, 0, 0, 1, false);
  put(0x1005, 0, 0x80, 4, true);
  put(0x1016, 1, 0, 4, true);
  put(0x1017, 0, 0, 2, true);
  put(0x1018, 1, module_.vendor.value_or(0x000000FF), 4, false);
  put(0x1018, 2, module_.product.value_or(0x00000020), 4, false);
  put(0x1018, 3, 0x00010000, 4, false);
  put(0x1018, 4, serial_, 4, false);
  put(0x1400, 1, 0x200U + id_, 4, true);
  put(0x1400, 2, kActsAtOnce, 1, true);
  put(0x1600, 0, static_cast<std::uint32_t>(bytes), 1, true);
  for (int sub = 1; sub <= static_cast<int>(kMostMapped); ++sub) {
    put(0x1600, sub, sub <= bytes ? 0x62000008U | (static_cast<std::uint32_t>(sub) << 8U) : 0, 4, true);
  }
  for (int byte = 1; byte <= bytes; ++byte) {
    put(0x6200, byte, 0, 1, true);
    put(0x6206, byte, 0xFF, 1, true);
    put(0x6207, byte, 0, 1, true);
  }
  for (const ObjectValue& object : module_.objects) {
    put(static_cast<std::uint16_t>(object.index), object.sub, 0, object.bytes, true);
  }
  nmt_ = NmtState::pre_operational;
  error_code_ = 0;
  controller_heard_.reset();
  sdo_.reset();
}

std::uint32_t OutputModuleNode::value_of(std::uint16_t index, std::uint8_t sub) const {
  const auto found = entries_.find({index, sub});
  return found == entries_.end() ? 0 : found->second.value;
}

/// Eight outputs as they are now, the lowest channel in bit 0.
std::uint8_t OutputModuleNode::output_byte(int byte) const {
  unsigned bits = 0;
  for (int bit = 0; bit < 8; ++bit) {
    const int channel = 8 * (byte - 1) + bit;
    if (channel < model_.channels() && model_.shown(channel) != 0) bits |= 1U << static_cast<unsigned>(bit);
  }
  return static_cast<std::uint8_t>(bits);
}

SdoAbort OutputModuleNode::read(std::uint16_t index, std::uint8_t sub, std::vector<std::uint8_t>& bytes) const {
  bytes.clear();
  const auto found = entries_.find({index, sub});
  const auto highest = highest_sub_.find(index);
  if (found == entries_.end()) {
    if (highest == highest_sub_.end()) {
      return entries_.contains({index, 0}) ? SdoAbort::no_sub_index : SdoAbort::no_object;
    }
    if (sub != 0) return SdoAbort::no_sub_index;
    bytes.push_back(highest->second);
    return SdoAbort::none;
  }
  const std::uint32_t value = index == 0x6200 ? output_byte(sub) : found->second.value;
  for (int i = 0; i < found->second.bytes; ++i) {
    bytes.push_back(static_cast<std::uint8_t>((value >> (8U * static_cast<unsigned>(i))) & 0xFFU));
  }
  return SdoAbort::none;
}

/// What CiA 301 does not allow now, though the object can be written.
SdoAbort OutputModuleNode::objection(Place place, std::uint32_t value) const {
  const auto [index, sub] = place;
  if (index == 0x1400 && sub == 1) {
    const bool was_valid = rpdo_valid();
    const bool stays_valid = (value & kInvalidPdo) == 0;
    const bool renames = ((value ^ value_of(0x1400, 1)) & 0x1FFFFFFFU) != 0;
    return was_valid && stays_valid && renames ? SdoAbort::value : SdoAbort::none;
  }
  if (index == 0x1400 && sub == 2) {
    return value > kLastSynchronous && value < kFirstAsynchronous ? SdoAbort::value : SdoAbort::none;
  }
  if (index != 0x1600) return SdoAbort::none;
  if (rpdo_valid()) return SdoAbort::state;
  if (sub == 0) {
    if (value > kMostMapped) return SdoAbort::too_long;
    for (std::uint32_t entry = 1; entry <= value; ++entry) {
      if (value_of(0x1600, static_cast<std::uint8_t>(entry)) == 0) return SdoAbort::not_mappable;
    }
    return SdoAbort::none;
  }
  if (value_of(0x1600, 0) != 0) return SdoAbort::state;
  const auto byte = static_cast<int>((value >> 8U) & 0xFFU);
  const bool is_output = value >> 16U == 0x6200 && (value & 0xFFU) == 8 && byte >= 1 && byte <= module_.bytes();
  return is_output || value == 0 ? SdoAbort::none : SdoAbort::not_mappable;
}

SdoAbort OutputModuleNode::write(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> bytes,
                                 Instant now) {
  std::vector<std::uint8_t> old;
  const SdoAbort there = read(index, sub, old);
  if (there != SdoAbort::none) return there;
  const auto entry = entries_.find({index, sub});
  if (entry == entries_.end() || !entry->second.writable) return SdoAbort::read_only;
  if (bytes.size() != old.size()) return SdoAbort::length;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint32_t{bytes[i]} << (8U * i);
  const SdoAbort objected = objection({index, sub}, value);
  if (objected != SdoAbort::none) return objected;
  entry->second.value = value;
  if (index == 0x6200) {
    set_output_bytes(sub, bytes);
    model_.take_staged(model_.shown_sequence(), now);
  }
  return SdoAbort::none;
}

void OutputModuleNode::set_output_bytes(int first, std::span<const std::uint8_t> bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      const int channel = 8 * (first - 1 + static_cast<int>(i)) + bit;
      if (channel >= model_.channels()) return;
      const LookIndex value = (bytes[i] >> static_cast<unsigned>(bit)) & 1U;
      model_.stage(channel, std::span(&value, 1));
    }
  }
}

CanNode::Reaction OutputModuleNode::receive(const drivers::CanFrame& frame, Instant now) {
  if (frame.kind != drivers::CanFrame::Kind::classic || frame.length > 8) return Reaction::none;
  if (frame.id == kNmt) return manage(frame, now);
  if (frame.id == kHeartbeats + (value_of(0x1016, 1) >> 16U) && frame.id != kHeartbeats) {
    if (frame.length == 1) controller_heard_ = now;
    return Reaction::none;
  }
  if (frame.id == kSdoRequest + id_) {
    if (nmt_ == NmtState::stopped || frame.length != 8) return Reaction::none;
    const auto answer = sdo_.answer(std::span(frame.data).first<8>(), now);
    if (answer) sdo_answer_ = *answer;
    return answer ? Reaction::sdo : Reaction::none;
  }
  if (nmt_ != NmtState::operational) return Reaction::none;
  if (frame.id == kSync) {
    // Its SYNC has no counter (0x1019 is missing): one that brings data is not taken.
    if (frame.length != 0) {
      error_code_ = kUnexpectedSyncLength;
      return Reaction::emergency;
    }
    if (value_of(0x1400, 2) <= kLastSynchronous) model_.take_staged(model_.shown_sequence(), now);
    return Reaction::none;
  }
  if (rpdo_valid() && frame.id == (value_of(0x1400, 1) & 0x7FFU)) return take_pdo(frame, now);
  return Reaction::none;
}

CanNode::Reaction OutputModuleNode::manage(const drivers::CanFrame& frame, Instant now) {
  const NmtReset reset = take_nmt(frame, id_, nmt_);
  if (reset == NmtReset::none) return Reaction::none;
  if (reset == NmtReset::node) model_.power_on(now);
  power_on();
  return Reaction::boot_up;
}

CanNode::Reaction OutputModuleNode::take_pdo(const drivers::CanFrame& frame, Instant now) {
  const std::uint32_t mapped = value_of(0x1600, 0);
  const bool was_wrong = error_code_ != 0;
  error_code_ = frame.length < mapped ? kPduTooShort : std::uint16_t{0};
  entries_[{0x1001, 0}].value = error_code_ != 0 ? kGenericAndCommunicationError : 0;
  if (error_code_ != 0) return Reaction::emergency;
  for (std::uint8_t entry = 1; entry <= mapped; ++entry) {
    const auto byte = static_cast<int>((value_of(0x1600, entry) >> 8U) & 0xFFU);
    set_output_bytes(byte, std::span(frame.data).subspan(entry - 1U, 1));
  }
  if (value_of(0x1400, 2) > kLastSynchronous) model_.take_staged(model_.shown_sequence(), now);
  return was_wrong ? Reaction::emergency : Reaction::none;
}

/// CiA 401: each output whose bit of the error mode is set goes to the bit of its error value, the others stay. CiA
/// 301, 0x1029, as it comes: the module goes to pre-operational.
void OutputModuleNode::fall_back(Instant now) {
  for (int byte = 1; byte <= module_.bytes(); ++byte) {
    const auto sub = static_cast<std::uint8_t>(byte);
    const std::uint32_t changes = value_of(0x6206, sub);
    const std::uint32_t value = (output_byte(byte) & ~changes) | (value_of(0x6207, sub) & changes);
    const auto bits = static_cast<std::uint8_t>(value & 0xFFU);
    set_output_bytes(byte, std::span(&bits, 1));
  }
  model_.take_staged(model_.shown_sequence(), now);
  if (nmt_ == NmtState::operational) nmt_ = NmtState::pre_operational;
}

Duration OutputModuleNode::beat(Instant now) {
  const Duration silence = milliseconds(value_of(0x1016, 1) & 0xFFFFU);
  if (controller_heard_ && silence.count() > 0 && now - *controller_heard_ > silence) {
    controller_heard_.reset();
    fall_back(now);
  }
  const Duration period = milliseconds(value_of(0x1017, 0));
  return period.count() > 0 ? period : kLook;
}

drivers::CanFrame OutputModuleNode::heartbeat() const {
  if (value_of(0x1017, 0) == 0) return {};
  return {static_cast<std::uint16_t>(kHeartbeats + id_), 1, {static_cast<std::uint8_t>(nmt_)}};
}

drivers::CanFrame OutputModuleNode::boot_up() const { return {static_cast<std::uint16_t>(kHeartbeats + id_), 1, {}}; }

drivers::CanFrame OutputModuleNode::emergency() const {
  return {static_cast<std::uint16_t>(0x080 + id_),
          8,
          {static_cast<std::uint8_t>(error_code_ & 0xFFU), static_cast<std::uint8_t>(error_code_ >> 8U),
           static_cast<std::uint8_t>(value_of(0x1001, 0))}};
}

}  // namespace footlight::sim
