// SPDX-License-Identifier: Apache-2.0
#include "core/timecode.hpp"

#include <array>
#include <cstdio>

#include "core/check.hpp"

namespace footlight {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kDropped = 1'001'000'000;  // ns of 30 frames of 29.97
constexpr std::int64_t kFramesOfTenMinutes = 17'982;
constexpr std::int64_t kFramesOfAMinute = 1'798;
constexpr int kHours = 24;

}  // namespace

std::string_view to_text(FrameRate rate) {
  constexpr std::array<std::string_view, kFrameRates> kNames{"24", "25", "29.97 drop-frame", "30"};
  return kNames.at(static_cast<std::size_t>(rate));
}

int frames_counted(FrameRate rate) {
  constexpr std::array<int, kFrameRates> kFrames{24, 25, 30, 30};
  return kFrames.at(static_cast<std::size_t>(rate));
}

Duration frame_time(FrameRate rate) {
  return Duration((rate == FrameRate::fps2997_drop ? kDropped : kSecond) / frames_counted(rate));
}

bool valid(const Timecode& code) {
  const bool in_range = code.hours >= 0 && code.hours < kHours && code.minutes >= 0 && code.minutes < 60 &&
                        code.seconds >= 0 && code.seconds < 60 && code.frames >= 0 &&
                        code.frames < frames_counted(code.rate);
  const bool dropped =
      code.rate == FrameRate::fps2997_drop && code.minutes % 10 != 0 && code.seconds == 0 && code.frames < 2;
  return in_range && !dropped;
}

std::int64_t frame_number(const Timecode& code) {
  const std::int64_t minutes = std::int64_t{60} * code.hours + code.minutes;
  const std::int64_t frames = (minutes * 60 + code.seconds) * frames_counted(code.rate) + code.frames;
  return code.rate == FrameRate::fps2997_drop ? frames - 2 * (minutes - minutes / 10) : frames;
}

Timecode code_of(std::int64_t frame, FrameRate rate) {
  FL_CHECK(frame >= 0);
  if (rate == FrameRate::fps2997_drop) {
    // Two numbers more for every minute that has begun since the last tenth one.
    const std::int64_t tens = frame / kFramesOfTenMinutes;
    const std::int64_t rest = frame % kFramesOfTenMinutes;
    frame += 18 * tens + (rest < 1'800 ? 0 : 2 * (1 + (rest - 1'800) / kFramesOfAMinute));
  }
  const int counted = frames_counted(rate);
  const std::int64_t time_s = frame / counted;
  return {static_cast<int>(time_s / 3600 % kHours), static_cast<int>(time_s / 60 % 60), static_cast<int>(time_s % 60),
          static_cast<int>(frame % counted), rate};
}

Duration time_of(const Timecode& code) {
  const bool drop = code.rate == FrameRate::fps2997_drop;
  return Duration(frame_number(code) * (drop ? kDropped : kSecond) / frames_counted(code.rate));
}

Timecode code_at(Duration time, FrameRate rate) {
  const bool drop = rate == FrameRate::fps2997_drop;
  // `time_of` rounds down: what lies in the nanosecond of a frame is that frame.
  const std::int64_t frame = ((time.count() + 1) * frames_counted(rate) - 1) / (drop ? kDropped : kSecond);
  return code_of(frame, rate);
}

std::string to_text(const Timecode& code) {
  std::array<char, 48> text{};
  (void)std::snprintf(text.data(), text.size(), "%02d:%02d:%02d%c%02d", code.hours, code.minutes, code.seconds,
                      code.rate == FrameRate::fps2997_drop ? ';' : ':', code.frames);
  return text.data();
}

std::optional<Timecode> parse_timecode(std::string_view text, FrameRate rate) {
  if (text.size() != 11) return std::nullopt;
  std::array<int, 4> parts{};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (i % 3 == 2) {
      if (c != ':' && !(i == 8 && (c == ';' || c == '.' || c == ','))) return std::nullopt;
      continue;
    }
    if (c < '0' || c > '9') return std::nullopt;
    parts[i / 3] = parts[i / 3] * 10 + (c - '0');
  }
  const Timecode code{parts[0], parts[1], parts[2], parts[3], rate};
  return valid(code) ? std::optional(code) : std::nullopt;
}

}  // namespace footlight
