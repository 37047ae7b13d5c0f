// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <ltc.h>

#include "core/rng.hpp"
#include "core/timecode.hpp"

namespace footlight::tests {

/// A tape with timecode, as somebody plays it: pieces one after the other.
struct TapePiece {
  enum class Kind { plays, silent, garbage };
  Kind kind = Kind::plays;
  double lasts_s = 0;       ///< by the clock
  double speed = 1;         ///< at its beginning
  double speed_at_end = 1;  ///< changes evenly
  double jumps_s = 0;       ///< of the position, when it begins
};

struct Tape {
  FrameRate rate = FrameRate::fps25;
  double begins_s = 0;  ///< position, since 00:00:00:00
  std::vector<TapePiece> pieces;
};

/// Calls `frame` for every frame that begins, with clock time, its number and its speed; `other` for 10 ms of what is
/// no timecode.
inline void play(const Tape& tape, const std::function<void(double at_s, std::int64_t number, double speed)>& frame,
                 const std::function<void(double at_s, bool garbage)>& other) {
  double at_s = 0;
  double position_s = tape.begins_s;
  const double frame_s = to_seconds(frame_time(tape.rate));
  for (const TapePiece& piece : tape.pieces) {
    position_s += piece.jumps_s;
    const double end_s = at_s + piece.lasts_s;
    while (at_s < end_s - 1e-9) {
      const double left = (end_s - at_s) / piece.lasts_s;
      const double speed = piece.speed_at_end + (piece.speed - piece.speed_at_end) * left;
      if (piece.kind != TapePiece::Kind::plays) {
        const double step_s = std::min(0.01, end_s - at_s);
        other(at_s, piece.kind == TapePiece::Kind::garbage);
        at_s += step_s;
        position_s += step_s * speed;
        continue;
      }
      const auto number = static_cast<std::int64_t>(std::llround(position_s / frame_s));
      frame(at_s, number, speed);
      at_s += frame_s / speed;
      position_s = (static_cast<double>(number) + 1) * frame_s;
    }
  }
}

/// The sound of a tape by libltc's encoder, with white noise of that amplitude over it.
inline std::vector<float> sound_of(const Tape& tape, int sample_rate, double noise, std::uint64_t seed) {
  Rng rng(seed);
  const int counted = frames_counted(tape.rate);
  LTCEncoder* encoder = ltc_encoder_create(sample_rate, counted, counted == 25 ? LTC_TV_625_50 : LTC_TV_525_60, 0);
  ltc_encoder_set_buffersize(encoder, sample_rate, 4.0);
  std::vector<float> sound;
  const auto fill = [&](double until_s, float amplitude) {
    while (static_cast<double>(sound.size()) < until_s * sample_rate)
      sound.push_back(amplitude * static_cast<float>(2 * rng.uniform() - 1));
  };
  play(
      tape,
      [&](double at_s, std::int64_t number, double speed) {
        const Timecode code = code_of(number, tape.rate);
        SMPTETimecode smpte{};
        smpte.hours = static_cast<unsigned char>(code.hours);
        smpte.mins = static_cast<unsigned char>(code.minutes);
        smpte.secs = static_cast<unsigned char>(code.seconds);
        smpte.frame = static_cast<unsigned char>(code.frames);
        ltc_encoder_set_timecode(encoder, &smpte);
        if (tape.rate == FrameRate::fps2997_drop) {
          LTCFrame raw;
          ltc_encoder_get_frame(encoder, &raw);
          raw.dfbit = 1;
          ltc_encoder_set_frame(encoder, &raw);
        }
        fill(at_s, 0);
        // The encoder knows whole rates: 29.97 is 30 a little slower.
        const double slower = to_seconds(frame_time(tape.rate)) * counted / speed;
        for (int byte = 0; byte < 10; ++byte) ltc_encoder_encode_byte(encoder, byte, slower);
        ltcsnd_sample_t* buffer = nullptr;
        const int count = ltc_encoder_get_bufferptr(encoder, &buffer, 1);
        for (int i = 0; i < count; ++i) sound.push_back(0.5F * static_cast<float>(buffer[i] - 128) / 90.0F);
      },
      [&](double at_s, bool garbage) { fill(at_s + 0.01, garbage ? 0.8F : 0); });
  ltc_encoder_free(encoder);
  if (noise > 0) {
    for (float& sample : sound) sample += static_cast<float>(noise * (2 * rng.uniform() - 1));
  }
  return sound;
}

}  // namespace footlight::tests
