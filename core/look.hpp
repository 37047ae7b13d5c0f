// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/index.hpp"

namespace footlight {

/// 8-bit sRGB.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend auto operator<=>(const Colour&, const Colour&) = default;
};

/// "#RRGGBB"
[[nodiscard]] std::string to_text(Colour colour);
[[nodiscard]] std::optional<Colour> parse_colour(std::string_view text);

/// What a lamp does with its colour. Numbers are those of the wire (docs/wire-protocol.md, "Look table").
/// Nothing flashes above 3 Hz: blink 1 Hz, double_blink two flashes each 1.2 s, pulse a sine of 2 s.
enum class Effect : std::uint8_t { steady = 0, blink = 1, pulse = 2, double_blink = 3, count_down = 4 };

[[nodiscard]] std::string_view to_text(Effect effect);
[[nodiscard]] std::optional<Effect> effect_from(std::string_view text);

/// One entry of the look table that markers know by its index.
struct Look {
  Colour colour;
  Effect effect = Effect::steady;
  std::uint8_t brightness = 255;  ///< 0 is dark

  friend auto operator<=>(const Look&, const Look&) = default;
};

inline constexpr LookIndex kDark = 0;  ///< always entry 0
inline constexpr LookIndex kNoGuidance =
    255;  ///< dim steady amber, always entry 255, used for nothing else (docs/looks.md)
[[nodiscard]] inline Look no_guidance_look() { return {{255, 191, 0}, Effect::steady, 40}; }

}  // namespace footlight
