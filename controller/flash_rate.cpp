// SPDX-License-Identifier: Apache-2.0
#include "controller/flash_rate.hpp"

#include <algorithm>

namespace footlight::controller {
namespace {

constexpr double kSecond_s = 1.0;
constexpr double kFlashApart_s = 0.4;   // of a double blink
constexpr double kDarkBetween_s = 0.2;  // its two flashes
constexpr double kDarkBlink_s = 0.5;
constexpr double kJustBefore_s = 1e-9;

/// Most times that an effect lights up within so long, at most a second, wherever it is in its rhythm
/// (docs/wire-protocol.md, "Effects").
int flashes_in(const Look& look, double time_s) {
  if (look.brightness == 0 || time_s <= 0 || look.effect == Effect::steady) return 0;
  return look.effect == Effect::double_blink && time_s > kFlashApart_s ? 2 : 1;
}

/// The same from its beginning on, which may fall into a flash and light it up.
int flashes_from_begin(const Look& look, double time_s) {
  if (look.brightness == 0) return 0;
  const bool again = (look.effect == Effect::double_blink && time_s > kDarkBetween_s) ||
                     ((look.effect == Effect::blink || look.effect == Effect::count_down) && time_s > kDarkBlink_s);
  return again ? 2 : 1;
}

}  // namespace

int most_flashes(std::span<const LampStretch> stretches, int percent) {
  const double scale = 100.0 / percent;
  const auto begins_s = [&](std::size_t k) { return to_seconds(stretches[k].from) * scale; };
  const auto ends_s = [&](std::size_t k) {
    return k + 1 < stretches.size() ? begins_s(k + 1) : begins_s(k) + 2 * kSecond_s;
  };
  /// In the second that begins at `from_s`, within stretch `first`.
  const auto flashes_from = [&](std::size_t first, double from_s) {
    int flashes = 0;
    for (std::size_t k = first; k < stretches.size() && begins_s(k) < from_s + kSecond_s; ++k) {
      const double inside_s = std::min(ends_s(k), from_s + kSecond_s) - std::max(begins_s(k), from_s);
      const Look& look = stretches[k].look;
      flashes += std::max(begins_s(k) >= from_s ? flashes_from_begin(look, inside_s) : 0, flashes_in(look, inside_s));
    }
    return flashes;
  };
  int most = 0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    // With a stretch's beginning, with its last flash, with its last two.
    most = std::max(most, flashes_from(k, begins_s(k)));
    for (const double before_s : {kJustBefore_s, kFlashApart_s + 2 * kJustBefore_s}) {
      if (ends_s(k) - before_s > begins_s(k)) most = std::max(most, flashes_from(k, ends_s(k) - before_s));
    }
  }
  return most;
}

}  // namespace footlight::controller
