// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/dmx_usb_pro/dmx_frames.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.hpp"

namespace footlight::drivers::dmx {
namespace {

constexpr std::uint8_t kStart = 0x7E;
constexpr std::uint8_t kEnd = 0xE7;
constexpr std::uint8_t kOutputOnly = 6;
constexpr std::uint8_t kNullStartCode = 0;
constexpr Duration kBreakAndMark = microseconds(92 + 12);
constexpr Duration kSlotTime = microseconds(44);  // 11 bits of 4 us

constexpr Duration kBlink = milliseconds(1000);
constexpr Duration kPulse = milliseconds(2000);
constexpr Duration kDoubleBlink = milliseconds(1200);
constexpr Duration kFlash = milliseconds(200);

std::uint8_t scaled(int level, double share) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(level * share), 0L, 255L));
}

}  // namespace

std::vector<std::uint8_t> output(std::span<const std::uint8_t> slots) {
  FL_CHECK(slots.size() >= kFewestSlots && slots.size() <= kSlots);
  const std::size_t length = slots.size() + 1;
  std::vector<std::uint8_t> message{kStart, kOutputOnly, static_cast<std::uint8_t>(length & 0xFFU),
                                    static_cast<std::uint8_t>(length >> 8U), kNullStartCode};
  message.insert(message.end(), slots.begin(), slots.end());
  message.push_back(kEnd);
  return message;
}

Duration packet_time(int slots) { return kBreakAndMark + (slots + 1) * kSlotTime; }

double share_of(Effect effect, Instant now) {
  const Duration since = now.time_since_epoch();
  switch (effect) {
    case Effect::steady:
      return 1;
    case Effect::blink:
    case Effect::count_down:
      return since % kBlink < kBlink / 2 ? 1 : 0;
    case Effect::pulse: {
      const double turn = static_cast<double>((since % kPulse).count()) / static_cast<double>(kPulse.count());
      return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * turn);
    }
    case Effect::double_blink: {
      const Duration at = since % kDoubleBlink;
      return at < kFlash || (at >= 2 * kFlash && at < 3 * kFlash) ? 1 : 0;
    }
  }
  return 1;
}

Look shown(const DmxFixture& fixture, const Look& look) {
  const bool coloured = std::ranges::any_of(fixture.slots, [](DmxSlot slot) {
    return slot == DmxSlot::red || slot == DmxSlot::green || slot == DmxSlot::blue;
  });
  if (coloured) return look;
  const std::uint8_t white = std::max({look.colour.red, look.colour.green, look.colour.blue});
  return {{white, white, white}, look.effect, look.brightness};
}

std::vector<std::uint8_t> levels(const DmxFixture& fixture, const Look& look, double share) {
  const bool has_dimmer = std::ranges::find(fixture.slots, DmxSlot::dimmer) != fixture.slots.end();
  const double light = look.brightness / 255.0 * share;
  const double colour_share = has_dimmer ? 1 : light;
  int red = look.colour.red;
  int green = look.colour.green;
  int blue = look.colour.blue;
  const bool coloured = std::ranges::any_of(fixture.slots, [](DmxSlot slot) {
    return slot == DmxSlot::red || slot == DmxSlot::green || slot == DmxSlot::blue;
  });
  const int brightest = std::max({red, green, blue});
  // White takes over what all three have in common; a lamp without colours is as bright as the brightest.
  const bool has_white = std::ranges::find(fixture.slots, DmxSlot::white) != fixture.slots.end();
  const int white = !has_white ? 0 : coloured ? std::min({red, green, blue}) : brightest;
  if (coloured) {
    red -= white;
    green -= white;
    blue -= white;
  }
  std::vector<std::uint8_t> out;
  for (const DmxSlot slot : fixture.slots) {
    switch (slot) {
      case DmxSlot::dimmer:
        out.push_back(scaled(coloured || has_white ? (brightest > 0 ? 255 : 0) : brightest, light));
        break;
      case DmxSlot::red:
        out.push_back(scaled(red, colour_share));
        break;
      case DmxSlot::green:
        out.push_back(scaled(green, colour_share));
        break;
      case DmxSlot::blue:
        out.push_back(scaled(blue, colour_share));
        break;
      case DmxSlot::white:
        out.push_back(scaled(white, colour_share));
        break;
      case DmxSlot::amber:
      case DmxSlot::zero:
        out.push_back(0);
        break;
      case DmxSlot::full:
        out.push_back(255);
        break;
    }
  }
  return out;
}

bool may_show(const DmxFixture& fixture, const Look& look, std::span<const std::uint8_t> levels) {
  const std::vector<std::uint8_t> full = dmx::levels(fixture, look, 1);
  if (std::ranges::equal(full, levels)) return true;
  if (look.effect == Effect::steady) return false;
  const std::vector<std::uint8_t> dark = dmx::levels(fixture, look, 0);
  if (look.effect != Effect::pulse) return std::ranges::equal(dark, levels);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i] < dark[i] || levels[i] > full[i]) return false;
  }
  return levels.size() == full.size();
}

}  // namespace footlight::drivers::dmx
