// SPDX-License-Identifier: Apache-2.0
#include "core/look.hpp"

#include <array>
#include <charconv>
#include <cstdio>

namespace footlight {
namespace {

constexpr std::array<std::string_view, 5> kEffectNames{"steady", "blink", "pulse", "double-blink", "count-down"};

}  // namespace

std::string to_text(Colour colour) {
  char text[8];
  (void)std::snprintf(text, sizeof text, "#%02X%02X%02X", colour.red, colour.green, colour.blue);
  return text;
}

std::optional<Colour> parse_colour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, value, 16);
  if (error != std::errc{} || end != text.data() + 7) return std::nullopt;
  return Colour{static_cast<std::uint8_t>(value >> 16U), static_cast<std::uint8_t>((value >> 8U) & 0xFFU),
                static_cast<std::uint8_t>(value & 0xFFU)};
}

std::string_view to_text(Effect effect) { return kEffectNames.at(static_cast<std::size_t>(effect)); }

std::optional<Effect> effect_from(std::string_view text) {
  for (std::size_t i = 0; i < kEffectNames.size(); ++i) {
    if (kEffectNames[i] == text) return static_cast<Effect>(i);
  }
  return std::nullopt;
}

}  // namespace footlight
