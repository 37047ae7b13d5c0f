// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/modbus_marker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr std::uint8_t kIllegalFunction = 1;
constexpr std::uint8_t kIllegalAddress = 2;
constexpr std::uint8_t kIllegalValue = 3;
constexpr std::uint8_t kFenced = 7;
constexpr int kLeadAfterHeartbeat = 2;
constexpr std::uint8_t kReadCoils = 0x01;
constexpr std::uint8_t kWriteCoil = 0x05;
constexpr std::uint8_t kWriteCoils = 0x0F;
constexpr std::uint8_t kRead = 0x03;
constexpr std::uint8_t kWriteOne = 0x06;
constexpr std::uint8_t kWriteSeveral = 0x10;
constexpr int kStatusRegisters = 6;
constexpr int kKeptRegisters = 8;
constexpr int kKeptAfterReaddress = 4;
constexpr int kMostRead = 125;
constexpr std::size_t kMostWritten = 123;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

void append(std::vector<std::uint8_t>& bytes, std::uint16_t word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
}

std::vector<std::uint8_t> exception(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | 0x80U), code};
}

bool possible(std::uint8_t sequence) { return sequence >= 1 && sequence <= kHighestSequence; }

}  // namespace

ModbusProfile footlight_profile() {
  ModbusProfile profile;
  profile.name = "footlight-marker";
  profile.look_register = 0x0000;
  profile.latch_register = 0x0020;
  profile.heartbeat_register = 0x0030;
  profile.status_register = 0x0040;
  profile.look_table_register = 0x0050;
  profile.unique_id_register = 0x0060;
  profile.identity_register = 0x0062;
  profile.identity_registers = 8;
  profile.identity_is_text = true;
  profile.identify_register = 0x006A;
  profile.readdress_register = 0x006C;
  profile.health = {{"battery", 0x0048, 1, "%", false},
                    {"supply", 0x0049, 0.001, "V", false},
                    {"temperature", 0x004A, 0.1, "C", true}};
  return profile;
}

std::vector<std::uint8_t> ModbusMarker::receive_rtu(std::span<const std::uint8_t> frame, Instant now) {
  model_.settle(now);
  if (frame.size() < 4) {
    ++dropped_;
    return {};
  }
  if (frame[0] != 0 && frame[0] != address_) return {};
  const auto body = frame.first(frame.size() - 2);
  const std::uint16_t check = crc16_modbus(body);
  if (frame[body.size()] != (check & 0xFFU) || frame[body.size() + 1] != (check >> 8U)) {
    ++dropped_;
    return {};
  }
  if (frame[0] == 0 && !profile_.has_broadcast) return {};
  const std::uint8_t own = address_;
  const auto pdu = answer(body.subspan(1), now);
  if (!profile_.restarts_for_address) address_ = next_address_;
  if (frame[0] == 0) return {};
  std::vector<std::uint8_t> reply;
  reply.reserve(pdu.size() + 3);
  reply.push_back(own);
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  const std::uint16_t reply_check = crc16_modbus(reply);
  reply.push_back(static_cast<std::uint8_t>(reply_check & 0xFFU));
  reply.push_back(static_cast<std::uint8_t>(reply_check >> 8U));
  return reply;
}

std::vector<std::uint8_t> ModbusMarker::receive_tcp(std::span<const std::uint8_t> frame, Instant now) {
  model_.settle(now);
  constexpr std::size_t kMbap = 7;
  if (frame.size() <= kMbap || word_at(frame, 2) != 0 || word_at(frame, 4) != frame.size() - 6 ||
      frame[6] != address_) {
    ++dropped_;
    return {};
  }
  const std::uint8_t own = address_;
  const auto pdu = answer(frame.subspan(kMbap), now);
  if (!profile_.restarts_for_address) address_ = next_address_;
  std::vector<std::uint8_t> reply{frame[0], frame[1], 0, 0};
  append(reply, static_cast<std::uint16_t>(pdu.size() + 1));
  reply.push_back(own);
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  return reply;
}

bool ModbusMarker::knows(std::uint8_t function) const {
  switch (function) {
    case kReadCoils:
    case kWriteCoil:
      return profile_.coils;
    case kWriteCoils:
      return profile_.coils && !profile_.writes_one_by_one;
    case kWriteSeveral:
      return !profile_.writes_one_by_one;
    default:
      return function == kRead || function == kWriteOne;
  }
}

std::vector<std::uint8_t> ModbusMarker::answer(std::span<const std::uint8_t> request, Instant now) {
  const std::uint8_t function = request[0];
  if (!knows(function)) return exception(function, kIllegalFunction);
  if (request.size() < 5) return exception(function, kIllegalValue);
  if (function == kRead) return read(request, now);
  if (function == kReadCoils) return read_coils(request);
  if (function == kWriteCoil || function == kWriteCoils) return write_coils(request, now);
  const int first = word_at(request, 1);
  Words values;
  if (function == kWriteOne) {
    if (request.size() != 5) return exception(function, kIllegalValue);
    values.push_back(word_at(request, 3));
  } else {
    const std::size_t count = word_at(request, 3);
    if (count < 1 || count > kMostWritten || request.size() != 6 + 2 * count || request[5] != 2 * count) {
      return exception(function, kIllegalValue);
    }
    for (std::size_t i = 0; i < count; ++i) values.push_back(word_at(request, 6 + 2 * i));
  }
  if (const std::uint8_t code = write(first, values, now); code != 0) return exception(function, code);
  return {request.begin(), request.begin() + 5};
}

std::vector<std::uint8_t> ModbusMarker::read_coils(std::span<const std::uint8_t> request) const {
  const int first = word_at(request, 1) - profile_.look_register;
  const int count = word_at(request, 3);
  if (request.size() != 5 || count < 1) return exception(kReadCoils, kIllegalValue);
  if (first < 0 || first + count > model_.channels()) return exception(kReadCoils, kIllegalAddress);
  std::vector<std::uint8_t> reply(2 + static_cast<std::size_t>((count + 7) / 8));
  reply[0] = kReadCoils;
  reply[1] = static_cast<std::uint8_t>(reply.size() - 2);
  for (int i = 0; i < count; ++i) {
    auto& byte = reply[2 + static_cast<std::size_t>(i / 8)];
    if (model_.shown(first + i) != 0) byte = static_cast<std::uint8_t>(byte | (1U << static_cast<unsigned>(i % 8)));
  }
  return reply;
}

std::vector<std::uint8_t> ModbusMarker::write_coils(std::span<const std::uint8_t> request, Instant now) {
  const std::uint8_t function = request[0];
  const int first = word_at(request, 1) - profile_.look_register;
  std::vector<LookIndex> values;
  if (function == kWriteCoil) {
    const std::uint16_t value = word_at(request, 3);
    if (request.size() != 5 || (value != 0 && value != 0xFF00)) return exception(function, kIllegalValue);
    values.push_back(value != 0 ? 1 : 0);
  } else {
    const std::size_t count = word_at(request, 3);
    const std::size_t bytes = (count + 7) / 8;
    if (count < 1 || request.size() != 6 + bytes || request[5] != bytes) return exception(function, kIllegalValue);
    for (std::size_t i = 0; i < count; ++i) values.push_back((request[6 + i / 8] >> (i % 8)) & 1U);
  }
  if (first < 0 || first + static_cast<int>(values.size()) > model_.channels()) {
    return exception(function, kIllegalAddress);
  }
  model_.stage(first, values);
  if (!profile_.latch_register) model_.take_staged(model_.shown_sequence(), now);
  return {request.begin(), request.begin() + 5};
}

std::vector<std::uint8_t> ModbusMarker::read(std::span<const std::uint8_t> request, Instant now) const {
  const int first = word_at(request, 1);
  const int count = word_at(request, 3);
  if (request.size() != 5 || count < 1 || count > kMostRead) return exception(kRead, kIllegalValue);
  std::vector<std::uint8_t> reply{kRead, static_cast<std::uint8_t>(2 * count)};
  for (int number = first; number < first + count; ++number) {
    const auto word = holds(number, now);
    if (!word) return exception(kRead, kIllegalAddress);
    append(reply, *word);
  }
  return reply;
}

std::optional<std::uint16_t> ModbusMarker::holds(int number, Instant now) const {
  const auto within = [&](const std::optional<int>& first, int count) {
    return first && number >= *first && number < *first + count;
  };
  if (within(profile_.status_register, kStatusRegisters)) {
    const auto uptime = std::chrono::duration_cast<std::chrono::seconds>(now - model_.powered_on_at());
    const std::array<std::uint16_t, kStatusRegisters> status{
        static_cast<std::uint16_t>((model_.shown_sequence() << 8U) | model_.pending_sequence()),
        model_.crc(),
        static_cast<std::uint16_t>(model_.state()),
        model_.boots(),
        static_cast<std::uint16_t>(uptime.count()),
        dropped_};
    return status[static_cast<std::size_t>(number - *profile_.status_register)];
  }
  if (within(profile_.unique_id_register, 2)) {
    const bool high = (number == *profile_.unique_id_register) != profile_.low_word_first;
    return static_cast<std::uint16_t>(high ? unique_id_ >> 16U : unique_id_ & 0xFFFFU);
  }
  if (within(profile_.identity_register, profile_.identity_registers)) {
    const auto at = static_cast<std::size_t>(number - *profile_.identity_register);
    if (!profile_.identity_is_text) return static_cast<std::uint16_t>(0xF000U + at);
    std::string text = profile_.name;
    text.resize(2 * static_cast<std::size_t>(profile_.identity_registers));
    return word_at(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 2 * at);
  }
  if (within(profile_.address_register, 1)) return next_address_;
  if (within(kept_register(), kKeptRegisters)) return kept_word(number - *kept_register());
  if (auto word = health_word(number)) return word;
  return look_word(number);
}

/// Our own marker has it behind the registers of its address.
std::optional<int> ModbusMarker::kept_register() const {
  if (!profile_.proves_looks() || !profile_.readdress_register) return std::nullopt;
  return *profile_.readdress_register + kKeptAfterReaddress;
}

std::uint16_t ModbusMarker::kept_word(int place) const {
  if (place > 3) return 0;
  const std::uint32_t check = place < 2 ? model_.plan_check() : model_.patch_check();
  const bool high = (place % 2 == 0) != profile_.low_word_first;
  return static_cast<std::uint16_t>(high ? check >> 16U : check & 0xFFFFU);
}

std::uint8_t ModbusMarker::write_kept(bool patch, const Words& values) {
  if (values.size() != 2) return kIllegalValue;
  const std::uint32_t high = values[profile_.low_word_first ? 1 : 0];
  const std::uint32_t low = values[profile_.low_word_first ? 0 : 1];
  patch ? model_.keep_patch((high << 16U) | low) : model_.keep_plan((high << 16U) | low);
  return 0;
}

std::optional<std::uint16_t> ModbusMarker::look_word(int number) const {
  const int offset = number - profile_.look_register - (profile_.has_preload_sequence ? 1 : 0);
  if (!profile_.readable_looks || profile_.coils || offset < 0 || offset >= look_registers()) return std::nullopt;
  if (profile_.looks_per_register == 1) return model_.shown(offset);
  const auto second = 2 * offset + 1 < model_.channels() ? model_.shown(2 * offset + 1) : LookIndex{0};
  return static_cast<std::uint16_t>((model_.shown(2 * offset) << 8U) | second);
}

std::optional<std::uint16_t> ModbusMarker::health_word(int number) const {
  for (const HealthRegister& entry : profile_.health) {
    if (entry.number != number) continue;
    double value = 0;
    if (entry.name == "battery") value = model_.health.battery_percent;
    if (entry.name == "supply") value = model_.health.supply_mv / 1000.0;
    if (entry.name == "temperature") value = model_.health.temperature_c;
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(std::lround(value / entry.scale)));
  }
  return std::nullopt;
}

std::uint8_t ModbusMarker::write(int first, const Words& values, Instant now) {
  if (profile_.latch_register == first) return write_latch(values, now);
  if (profile_.heartbeat_register == first) {
    if (values.size() != 2) return kIllegalValue;
    model_.heartbeat(now);
    return 0;
  }
  if (profile_.has_preload_sequence && profile_.heartbeat_register &&
      *profile_.heartbeat_register + kLeadAfterHeartbeat == first) {
    return write_lead(values, now);
  }
  if (profile_.look_table_register == first) return write_look(values);
  if (profile_.identify_register == first) {
    if (values.size() != 1 || values[0] > 1) return kIllegalValue;
    model_.identify(values[0] != 0, now);
    return 0;
  }
  if (const auto kept = kept_register(); kept && (first == *kept || first == *kept + 2)) {
    return write_kept(first != *kept, values);
  }
  if (profile_.address_register == first) return values.size() == 1 ? write_address(values[0]) : kIllegalValue;
  if (profile_.readdress_register == first) return write_readdress(values);
  if (const auto code = write_state(first, values)) return *code;
  if (profile_.coils) return kIllegalAddress;
  const int offset = first - profile_.look_register;
  if (profile_.has_preload_sequence) return offset == 0 ? write_preload(values, now) : kIllegalAddress;
  if (offset < 0 || offset >= look_registers()) return kIllegalAddress;
  return write_bare_looks(offset, values, now);
}

std::uint8_t ModbusMarker::write_lead(const Words& values, Instant now) {
  if (values.size() != 3 || values[2] > 0xFF) return kIllegalValue;
  const std::uint32_t high = values[profile_.low_word_first ? 1 : 0];
  const std::uint32_t low = values[profile_.low_word_first ? 0 : 1];
  return model_.lead((high << 16U) | low, static_cast<std::uint8_t>(values[2]), now) ? std::uint8_t{0} : kFenced;
}

std::uint8_t ModbusMarker::write_address(std::uint16_t address) {
  if (address < 1 || address > 247) return kIllegalValue;
  next_address_ = static_cast<std::uint8_t>(address);
  return 0;
}

std::uint8_t ModbusMarker::write_readdress(const Words& values) {
  if (values.size() != 4 || values[3] != (values[2] ^ 0x5A5A)) return kIllegalValue;
  const std::uint32_t high = values[profile_.low_word_first ? 1 : 0];
  const std::uint32_t low = values[profile_.low_word_first ? 0 : 1];
  if (((high << 16U) | low) != unique_id_) return kIllegalValue;  // somebody else is meant
  return write_address(values[2]);
}

/// A register of the device's own table of states; nothing where there is none.
std::optional<std::uint8_t> ModbusMarker::write_state(int first, const Words& values) {
  if (!profile_.states) return std::nullopt;
  const StateTable& states = *profile_.states;
  const int from = first - states.first_register;
  if (from < 0 || from >= states.count * states.stride) return std::nullopt;
  const auto index = static_cast<std::uint8_t>(from / states.stride + 1);
  const auto with = [](const auto& codes, int value) {
    return std::find_if(codes.begin(), codes.end(), [&](const auto& code) { return code.value == value; });
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int offset = from % states.stride + static_cast<int>(i);
    Look look = model_.look(index);
    if (states.effect_offset == offset) {
      const auto code = with(states.effects, values[i]);
      if (code == states.effects.end()) return kIllegalValue;
      look.effect = code->effect;
    } else if (states.colour_offset == offset) {
      const auto code = with(states.colours, values[i]);
      if (code == states.colours.end()) return kIllegalValue;
      look.colour = code->colour;
    } else if (states.brightness_offset == offset) {
      const auto code = with(states.brightnesses, values[i]);
      if (code == states.brightnesses.end()) return kIllegalValue;
      look.brightness = static_cast<std::uint8_t>(code->brightness);
    }
    model_.set_look(index, look);
  }
  return 0;
}

std::uint8_t ModbusMarker::write_preload(const Words& values, Instant now) {
  const auto count = static_cast<int>(values.size()) - 1;
  const auto sequence = static_cast<std::uint8_t>(values[0] & 0xFFU);
  const auto plan = static_cast<std::uint8_t>(values[0] >> 8U);
  if (count < 1 || count > look_registers() || !possible(sequence)) return kIllegalValue;
  if (model_.fenced(plan, now)) return kFenced;
  model_.preload(sequence, plan, 0, looks_in(std::span(values).subspan(1), 0));
  if (!profile_.latch_register) model_.latch(sequence, plan, now);
  return 0;
}

std::uint8_t ModbusMarker::write_bare_looks(int offset, const Words& values, Instant now) {
  if (static_cast<int>(values.size()) > look_registers() - offset) return kIllegalValue;
  for (const LookIndex look : looks_in(values, offset * profile_.looks_per_register)) {
    if (!can_show(look)) return kIllegalValue;
  }
  const int first_channel = offset * profile_.looks_per_register;
  model_.stage(first_channel, looks_in(values, first_channel));
  if (!profile_.latch_register) model_.take_staged(model_.shown_sequence(), now);
  return 0;
}

/// Whether the device has something under that number.
bool ModbusMarker::can_show(LookIndex look) const {
  if (profile_.states) return look <= profile_.states->count;
  return profile_.palette.empty() || std::any_of(profile_.palette.begin(), profile_.palette.end(),
                                                 [&](const PaletteEntry& entry) { return entry.value == look; });
}

std::uint8_t ModbusMarker::write_latch(const Words& values, Instant now) {
  const auto sequence = static_cast<std::uint8_t>(values[0] & 0xFFU);
  const auto plan = static_cast<std::uint8_t>(values[0] >> 8U);
  if (!possible(sequence)) return kIllegalValue;
  if (!profile_.has_preload_sequence) {
    if (values.size() != 1) return kIllegalValue;
    model_.take_staged(sequence, now);
    return 0;
  }
  if (values.size() != 3 || values[1] != (values[0] ^ 0x5A5A) || values[2] != (values[0] ^ 0xA5A5)) {
    return kIllegalValue;
  }
  if (model_.fenced(plan, now)) return kFenced;
  model_.latch(sequence, plan, now);
  return 0;
}

std::uint8_t ModbusMarker::write_look(const Words& values) {
  if (values.size() != 4 || values[0] > 0xFF || values[3] > static_cast<std::uint16_t>(Effect::count_down)) {
    return kIllegalValue;
  }
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); };
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); };
  const Look look{
      {high(values[1]), low(values[1]), high(values[2])}, static_cast<Effect>(low(values[3])), low(values[2])};
  return model_.set_look(low(values[0]), look) ? std::uint8_t{0} : kIllegalValue;
}

std::vector<LookIndex> ModbusMarker::looks_in(std::span<const std::uint16_t> values, int first_channel) const {
  std::vector<LookIndex> looks;
  for (const std::uint16_t value : values) {
    if (profile_.looks_per_register == 2) looks.push_back(static_cast<LookIndex>(value >> 8U));
    looks.push_back(static_cast<LookIndex>(value & 0xFFU));
  }
  const auto room = static_cast<std::size_t>(model_.channels() - first_channel);
  looks.resize(std::min(looks.size(), room));  // the unused last byte
  return looks;
}

int ModbusMarker::look_registers() const {
  return profile_.looks_per_register == 2 ? (model_.channels() + 1) / 2 : model_.channels();
}

}  // namespace footlight::sim
