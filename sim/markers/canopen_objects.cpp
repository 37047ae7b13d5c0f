// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/canopen_objects.hpp"

#include <array>
#include <string_view>

namespace footlight::sim {
namespace {

constexpr std::string_view kName = "Footlight marker";
constexpr std::uint32_t kDeviceType = 0x00020191;
constexpr std::uint32_t kProduct = 0x464C4D4B;
constexpr std::uint32_t kRevision = 0x00010001;
constexpr std::uint32_t kHeartbeatMs = 1000;
constexpr std::uint32_t kController = 127;
constexpr int kLastTableEntry = 254;
constexpr std::uint32_t kLooksPerPdo = 8;

constexpr std::uint16_t kColours = 0x2100;
constexpr std::uint16_t kEffects = 0x2101;
constexpr std::uint16_t kStatus = 0x2102;
constexpr std::uint16_t kChannels = 0x2103;
constexpr std::uint16_t kIdentify = 0x2104;
constexpr std::uint16_t kKept = 0x2105;
constexpr std::uint16_t kEpoch = 0x2106;
constexpr std::uint16_t kOutputs = 0x6200;
/// Sizes in bytes of 0x2102:1..5.
constexpr std::array<int, 5> kStatusBytes{1, 1, 2, 2, 2};

/// As PDO mapping entries are written: index, sub-index, bits.
constexpr std::uint32_t mapped(std::uint32_t index, std::uint32_t sub, std::uint32_t bits) {
  return (index << 16U) | (sub << 8U) | bits;
}

std::uint32_t number_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) number |= std::uint32_t{bytes[i]} << (8U * i);
  return number;
}

std::uint8_t byte_of(std::uint32_t number, unsigned which) {
  return static_cast<std::uint8_t>((number >> (8U * which)) & 0xFFU);
}

}  // namespace

SdoAbort CanopenObjects::read(std::uint16_t index, std::uint8_t sub, std::vector<std::uint8_t>& bytes) const {
  bytes.clear();
  if (index == 0x1008) {
    if (sub != 0) return SdoAbort::no_sub_index;
    bytes.assign(kName.begin(), kName.end());
    return SdoAbort::none;
  }
  const Value value = index < 0x1400 ? communication(index, sub) : index < 0x2000 ? pdo(index, sub) : own(index, sub);
  if (value.abort != SdoAbort::none) return value.abort;
  for (int i = 0; i < value.bytes; ++i) bytes.push_back(byte_of(value.number, static_cast<unsigned>(i)));
  return SdoAbort::none;
}

CanopenObjects::Value CanopenObjects::communication(std::uint16_t index, std::uint8_t sub) const {
  const auto plain = [&](std::uint32_t number, int bytes) {
    return sub == 0 ? Value{SdoAbort::none, number, bytes} : Value{SdoAbort::no_sub_index};
  };
  const auto list = [&](std::span<const std::uint32_t> numbers) {
    if (sub == 0) return Value{SdoAbort::none, static_cast<std::uint32_t>(numbers.size()), 1};
    return sub <= numbers.size() ? Value{SdoAbort::none, numbers[sub - 1U], 4} : Value{SdoAbort::no_sub_index};
  };
  switch (index) {
    case 0x1000:
      return plain(kDeviceType, 4);
    case 0x1001:
      return plain(counters_.error_register, 1);
    case 0x1005:
      return plain(0x080, 4);
    case 0x1014:
      return plain(0x080U + id_, 4);
    case 0x1016:
      return list(std::array{(kController << 16U) | kHeartbeatMs});
    case 0x1017:
      return plain(kHeartbeatMs, 2);
    case 0x1018:
      return list(std::array<std::uint32_t, 4>{0, kProduct, kRevision, serial_});
    case 0x1019:
      return plain(kHighestSequence, 1);
    case 0x1200:
      return list(std::array<std::uint32_t, 2>{0x600U + id_, 0x580U + id_});
    default:
      return Value{SdoAbort::no_object};
  }
}

CanopenObjects::Value CanopenObjects::pdo(std::uint16_t index, std::uint8_t sub) const {
  const bool receives = (index & ~3U) == 0x1400 || (index & ~3U) == 0x1600;
  if (!receives && index != 0x1800 && index != 0x1A00) return Value{SdoAbort::no_object};
  const std::uint32_t number = index & 3U;
  if (index < 0x1600 || index == 0x1800) {  // identifier and transmission type
    const std::uint32_t identifier = (receives ? 0x200U + 0x100U * number : 0x180U) + id_;
    if (sub == 0) return {SdoAbort::none, 2, 1};
    if (sub == 1) return {SdoAbort::none, identifier, 4};
    if (sub == 2) return {SdoAbort::none, receives ? 0U : 1U, 1};
    return Value{SdoAbort::no_sub_index};
  }
  const std::uint32_t entries = receives ? kLooksPerPdo : kStatusBytes.size();
  if (sub == 0) return {SdoAbort::none, entries, 1};
  if (sub > entries) return Value{SdoAbort::no_sub_index};
  const std::uint32_t entry = receives
                                  ? mapped(kOutputs, kLooksPerPdo * number + sub, 8)
                                  : mapped(kStatus, sub, 8U * static_cast<std::uint32_t>(kStatusBytes.at(sub - 1U)));
  return {SdoAbort::none, entry, 4};
}

CanopenObjects::Value CanopenObjects::status(std::uint8_t sub) const {
  if (sub == 0) return {SdoAbort::none, kStatusBytes.size(), 1};
  if (sub > kStatusBytes.size()) return Value{SdoAbort::no_sub_index};
  const std::array<std::uint32_t, 5> values{model_.shown_sequence(), static_cast<std::uint32_t>(model_.state()),
                                            model_.crc(), model_.boots(), counters_.errors};
  return {SdoAbort::none, values.at(sub - 1U), kStatusBytes.at(sub - 1U)};
}

CanopenObjects::Value CanopenObjects::own(std::uint16_t index, std::uint8_t sub) const {
  switch (index) {
    case kColours:
    case kEffects: {
      if (sub == 0) return {SdoAbort::none, kLastTableEntry, 1};
      if (sub > kLastTableEntry) return Value{SdoAbort::no_sub_index};
      const Look& look = model_.look(sub);
      if (index == kEffects)
        return {SdoAbort::none, (std::uint32_t{look.brightness} << 8U) | static_cast<std::uint32_t>(look.effect), 2};
      return {SdoAbort::none,
              (std::uint32_t{look.colour.red} << 16U) | (std::uint32_t{look.colour.green} << 8U) | look.colour.blue, 4};
    }
    case kStatus:
      return status(sub);
    case kChannels:
      return sub == 0 ? Value{SdoAbort::none, static_cast<std::uint32_t>(model_.channels()), 1}
                      : Value{SdoAbort::no_sub_index};
    case kIdentify:
      return sub == 0 ? Value{SdoAbort::none, 0, 1} : Value{SdoAbort::no_sub_index};
    case kKept:
      if (sub == 0) return {SdoAbort::none, 2, 1};
      if (sub > 2) return Value{SdoAbort::no_sub_index};
      return {SdoAbort::none, sub == 1 ? model_.plan_check() : model_.patch_check(), 4};
    case kEpoch:
      return sub == 0 ? Value{SdoAbort::none, model_.last_epoch(), 4} : Value{SdoAbort::no_sub_index};
    case kOutputs:
      if (sub == 0) return {SdoAbort::none, static_cast<std::uint32_t>(model_.channels()), 1};
      if (sub > model_.channels()) return Value{SdoAbort::no_sub_index};
      return {SdoAbort::none, model_.shown(sub - 1), 1};
    default:
      return Value{SdoAbort::no_object};
  }
}

SdoAbort CanopenObjects::write(std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> bytes,
                               Instant now) {
  std::vector<std::uint8_t> old;
  const SdoAbort there = read(index, sub, old);
  if (there != SdoAbort::none) return there;
  const bool is_array = index == kColours || index == kEffects || index == kOutputs || index == kKept;
  if (index != kIdentify && (!is_array || sub == 0)) return SdoAbort::read_only;
  if (bytes.size() != old.size()) return SdoAbort::length;
  const std::uint32_t number = number_of(bytes);
  bool possible = true;
  if (index == kColours) {
    possible = byte_of(number, 3) == 0 &&
               model_.set_colour(sub, Colour{byte_of(number, 2), byte_of(number, 1), byte_of(number, 0)});
  } else if (index == kEffects) {
    possible = model_.set_effect(sub, byte_of(number, 0), byte_of(number, 1));
  } else if (index == kIdentify) {
    possible = number <= 1;
    if (possible) model_.identify(number == 1, now);
  } else if (index == kKept) {
    sub == 1 ? model_.keep_plan(number) : model_.keep_patch(number);
  } else {
    model_.stage(sub - 1, bytes);
  }
  return possible ? SdoAbort::none : SdoAbort::value;
}

}  // namespace footlight::sim
