// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/modbus/marker_registers.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers::modbus {
namespace {

constexpr std::uint16_t kCoilOn = 0xFF00;  // of function 0x05

std::uint16_t word(unsigned high, unsigned low) { return static_cast<std::uint16_t>((high << 8U) | low); }

Requests write(const ModbusProfile& profile, std::uint8_t unit, int first, std::vector<std::uint16_t> values,
               bool coils = false) {
  const auto number = static_cast<std::uint16_t>(first);
  if (!profile.writes_one_by_one) {
    const auto count = static_cast<std::uint16_t>(values.size());
    return {{unit, coils ? kWriteCoils : kWriteRegisters, number, count, std::move(values)}};
  }
  Requests requests;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = coils && values[i] != 0 ? kCoilOn : values[i];
    requests.push_back({unit, coils ? kWriteCoil : kWriteRegister, static_cast<std::uint16_t>(number + i), 1, {value}});
  }
  return requests;
}

std::pair<std::uint16_t, std::uint16_t> words_of(const ModbusProfile& profile, std::uint32_t value) {
  const auto high = static_cast<std::uint16_t>(value >> 16U);
  const auto low = static_cast<std::uint16_t>(value & 0xFFFFU);
  return profile.low_word_first ? std::pair(low, high) : std::pair(high, low);
}

/// The light of a lamp, 0..255 a colour.
std::array<int, 3> light_of(const Look& look) {
  const auto part = [&](std::uint8_t colour) { return colour * look.brightness / 255; };
  return {part(look.colour.red), part(look.colour.green), part(look.colour.blue)};
}

long distance(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  long sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += long{a[i] - b[i]} * (a[i] - b[i]);
  return sum;
}

bool is_dark(const Look& look) { return light_of(look) == std::array<int, 3>{}; }

constexpr long kOtherEffect = 3L * 255 * 255 + 1;  // more than any two colours differ

/// The code whose `distance_to` is least; the first of equals.
template <class Code, class Distance>
const Code& nearest(const std::vector<Code>& codes, Distance distance_to) {
  FL_CHECK(!codes.empty());
  return *std::min_element(codes.begin(), codes.end(),
                           [&](const Code& a, const Code& b) { return distance_to(a) < distance_to(b); });
}

const PaletteEntry& nearest_entry(const ModbusProfile& profile, const Look& look, bool dark) {
  const auto wanted = dark ? std::array<int, 3>{} : light_of(look);
  return nearest(profile.palette, [&](const PaletteEntry& entry) {
    long sum = distance(wanted, light_of(entry.look));
    if (!dark && entry.look.effect != look.effect) sum += kOtherEffect;
    if (is_dark(entry.look) != dark) sum += 4 * kOtherEffect;
    return sum;
  });
}

const EffectCode& nearest_effect(const StateTable& states, const Look& look) {
  return nearest(states.effects, [&](const EffectCode& code) {
    return code.effect == look.effect ? 0 : code.effect == Effect::steady ? 1 : 2;
  });
}

const ColourCode& nearest_colour(const StateTable& states, const Look& look) {
  return nearest(states.colours,
                 [&](const ColourCode& code) { return distance(light_of({look.colour}), light_of({code.colour})); });
}

const BrightnessCode& nearest_brightness(const StateTable& states, const Look& look) {
  return nearest(states.brightnesses,
                 [&](const BrightnessCode& code) { return std::abs(code.brightness - int{look.brightness}); });
}

}  // namespace

LookIndex value_of(const ModbusProfile& profile, LookIndex index, const Look& look) {
  if (!profile.shows_own_numbers()) return index;
  const bool dark = index == kDark || is_dark(look);
  if (profile.palette.empty()) return dark ? LookIndex{0} : LookIndex{1};
  return static_cast<LookIndex>(nearest_entry(profile, look, dark).value);
}

Look nearest_look(const ModbusProfile& profile, const Look& look) {
  const bool dark = is_dark(look);
  if (!profile.palette.empty()) return nearest_entry(profile, look, dark).look;
  if (dark) return look;
  if (profile.coils) return Look{{255, 255, 255}, Effect::steady, 255};
  if (!profile.states) return look;
  const StateTable& states = *profile.states;
  Look shown{{255, 255, 255}, Effect::steady, 255};
  if (states.effect_offset) shown.effect = nearest_effect(states, look).effect;
  if (states.colour_offset) shown.colour = nearest_colour(states, look).colour;
  if (states.brightness_offset)
    shown.brightness = static_cast<std::uint8_t>(nearest_brightness(states, look).brightness);
  return shown;
}

Requests preload(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte, Sequence sequence,
                 std::span<const LookIndex> values) {
  FL_CHECK(!values.empty() && values.size() <= kChannelsPerNode);
  std::vector<std::uint16_t> words;
  if (profile.has_preload_sequence) words.push_back(word(plan_byte, sequence));
  if (profile.coils || profile.looks_per_register == 1) {
    words.insert(words.end(), values.begin(), values.end());
  } else {
    for (std::size_t i = 0; i < values.size(); i += 2) {
      words.push_back(word(values[i], i + 1 < values.size() ? values[i + 1] : 0U));
    }
  }
  return write(profile, unit, profile.look_register, std::move(words), profile.coils);
}

Requests latch(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte, Sequence sequence) {
  FL_CHECK(profile.latch_register.has_value());
  if (!profile.has_preload_sequence) return write(profile, unit, profile.latch_register.value(), {sequence});
  const std::uint16_t first = word(plan_byte, sequence);
  return write(profile, unit, profile.latch_register.value(),
               {first, static_cast<std::uint16_t>(0x5A5AU ^ first), static_cast<std::uint16_t>(0xA5A5U ^ first)});
}

Requests heartbeat(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t show_time_ms) {
  FL_CHECK(profile.heartbeat_register.has_value());
  const auto [first, second] = words_of(profile, show_time_ms);
  return write(profile, unit, profile.heartbeat_register.value(), {first, second});
}

Requests lead(const ModbusProfile& profile, std::uint8_t unit, std::uint8_t plan_byte, std::uint32_t epoch) {
  FL_CHECK(profile.heartbeat_register.has_value());
  const auto [first, second] = words_of(profile, epoch);
  return write(profile, unit, profile.heartbeat_register.value() + kLeadAfterHeartbeat, {first, second, plan_byte});
}

std::optional<int> kept_register(const ModbusProfile& profile) {
  if (!profile.proves_looks() || !profile.readdress_register) return std::nullopt;
  return *profile.readdress_register + kKeptAfterReaddress;
}

Requests plan_check(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t check) {
  const auto [first, second] = words_of(profile, check);
  return write(profile, unit, kept_register(profile).value(), {first, second});
}

Requests patch_check(const ModbusProfile& profile, std::uint8_t unit, std::uint32_t check) {
  const auto [first, second] = words_of(profile, check);
  return write(profile, unit, kept_register(profile).value() + 2, {first, second});
}

ModbusRequest kept_request(const ModbusProfile& profile, std::uint8_t unit) {
  return {unit, kReadRegisters, static_cast<std::uint16_t>(kept_register(profile).value()), kKeptRegisters, {}};
}

std::optional<KeptChecks> decode_kept(const ModbusProfile& profile, std::span<const std::uint16_t> registers) {
  if (registers.size() != kKeptRegisters) return std::nullopt;
  const auto word = [&](std::size_t at) {
    const std::uint32_t high = registers[at + (profile.low_word_first ? 1 : 0)];
    return (high << 16U) | registers[at + (profile.low_word_first ? 0 : 1)];
  };
  return KeptChecks{word(0), word(2)};
}

ModbusRequest status_request(const ModbusProfile& profile, std::uint8_t unit, std::uint16_t count) {
  FL_CHECK(profile.status_register.has_value());
  FL_CHECK(count >= 1 && count <= kStatusRegisters);
  return {unit, kReadRegisters, static_cast<std::uint16_t>(profile.status_register.value()), count, {}};
}

ModbusRequest looks_request(const ModbusProfile& profile, std::uint8_t unit, int channels) {
  FL_CHECK(profile.readable_looks);
  const int first = profile.look_register + (profile.has_preload_sequence ? 1 : 0);
  const int count = profile.coils || profile.looks_per_register == 1 ? channels : (channels + 1) / 2;
  return {unit,
          profile.coils ? kReadCoils : kReadRegisters,
          static_cast<std::uint16_t>(first),
          static_cast<std::uint16_t>(count),
          {}};
}

std::optional<std::vector<LookIndex>> decode_looks(const ModbusProfile& profile, int channels,
                                                   std::span<const std::uint16_t> registers) {
  const auto wanted = static_cast<std::size_t>(channels);
  std::vector<LookIndex> values;
  for (const std::uint16_t value : registers) {
    if (!profile.coils && profile.looks_per_register == 2) {
      values.push_back(static_cast<LookIndex>(value >> 8U));
    } else if (value > 0xFF) {
      return std::nullopt;
    }
    values.push_back(static_cast<LookIndex>(value & 0xFFU));
  }
  if (values.size() < wanted || values.size() > wanted + 1) return std::nullopt;
  values.resize(wanted);
  return values;
}

Requests look_entry(const ModbusProfile& profile, std::uint8_t unit, LookIndex index, const Look& look) {
  if (profile.look_table_register) {
    return write(profile, unit, profile.look_table_register.value(),
                 {index, word(look.colour.red, look.colour.green), word(look.colour.blue, look.brightness),
                  static_cast<std::uint16_t>(look.effect)});
  }
  if (!profile.states || index == kDark || index > profile.states->count) return {};
  const StateTable& states = *profile.states;
  const int first = states.first_register + (index - 1) * states.stride;
  std::vector<std::pair<int, std::uint16_t>> writes;
  const auto put = [&](const std::optional<int>& offset, int value) {
    writes.emplace_back(offset.value(), static_cast<std::uint16_t>(value));
  };
  if (states.effect_offset) put(states.effect_offset, nearest_effect(states, look).value);
  if (states.colour_offset) put(states.colour_offset, nearest_colour(states, look).value);
  if (states.brightness_offset) put(states.brightness_offset, nearest_brightness(states, look).value);
  std::sort(writes.begin(), writes.end());
  Requests requests;  // neighbours go in one request
  for (std::size_t i = 0; i < writes.size();) {
    std::vector<std::uint16_t> values{writes[i].second};
    const int offset = writes[i].first;
    while (++i < writes.size() && writes[i].first == offset + static_cast<int>(values.size())) {
      values.push_back(writes[i].second);
    }
    for (ModbusRequest& request : write(profile, unit, first + offset, std::move(values))) {
      requests.push_back(std::move(request));
    }
  }
  return requests;
}

std::optional<NodeStatus> decode_status(std::span<const std::uint16_t> registers) {
  if (registers.size() < kNeededStatusRegisters || registers.size() > kStatusRegisters) return std::nullopt;
  return NodeStatus{static_cast<Sequence>(registers[0] >> 8U), static_cast<Sequence>(registers[0] & 0xFFU),
                    registers[1], static_cast<std::uint8_t>(registers[2] & 0xFFU), registers[3]};
}

}  // namespace footlight::drivers::modbus
