// SPDX-License-Identifier: Apache-2.0
#include "controller/time/ltc.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <ltc.h>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr int kQueue = 64;  // frames that wait
constexpr std::size_t kAtOnce = 1024;
constexpr long long kFramesToRestart = 10;
constexpr double kSameRate = 0.06;
constexpr double kOtherRate = 0.015;

}  // namespace

struct LtcDecoder::State {
  explicit State(int samples_per_frame) : decoder(ltc_decoder_create(samples_per_frame, kQueue)) {
    FL_CHECK(decoder != nullptr);
  }
  ~State() { ltc_decoder_free(decoder); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  LTCDecoder* decoder;
};

LtcDecoder::LtcDecoder(int sample_rate, FrameRate rate) : sample_rate_(sample_rate), rate_(rate) {
  FL_CHECK(sample_rate >= 8'000 && sample_rate <= 192'000);
  restart();
}

LtcDecoder::~LtcDecoder() = default;

void LtcDecoder::restart() {
  state_ = std::make_unique<State>(sample_rate_ / frames_counted(rate_));
  last_.reset();
}

void LtcDecoder::learn(const Timecode& code, bool drop, bool follows) {
  std::optional<FrameRate> told;
  if (drop) told = FrameRate::fps2997_drop;
  if (!drop && code.frames >= 25) told = FrameRate::fps30;
  const bool next_second = follows && code.frames == 0 && code.seconds == (last_->seconds + 1) % 60;
  if (!drop && next_second && (last_->frames == 23 || last_->frames == 24)) {
    // A frame that got lost there would tell something else: twice the same, or nothing.
    const FrameRate seen = last_->frames == 23 ? FrameRate::fps24 : FrameRate::fps25;
    if (seen == seen_) told = seen;
    seen_ = seen;
  }
  if (!told) return;
  rate_ = *told;
  knows_rate_ = true;
}

void LtcDecoder::guess(long long frame_samples) {
  if (knows_rate_ || frame_samples <= 0) return;
  const double fps = static_cast<double>(sample_rate_) / static_cast<double>(frame_samples);
  const auto off = [&](FrameRate rate) { return std::abs(fps / frames_counted(rate) - 1); };
  if (off(rate_) <= kSameRate) return;
  for (const FrameRate rate : {FrameRate::fps24, FrameRate::fps25, FrameRate::fps30}) {
    if (off(rate) <= kOtherRate) rate_ = rate;
  }
}

void LtcDecoder::take(std::span<const float> samples, Instant began, const std::function<void(const TimeFix&)>& fix) {
  while (!samples.empty()) {
    std::array<float, kAtOnce> piece{};
    const std::size_t count = std::min(samples.size(), piece.size());
    // What is no number would become one by a conversion that is not defined.
    std::transform(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count), piece.begin(),
                   [](float sample) { return std::isfinite(sample) ? std::clamp(sample, -1.0F, 1.0F) : 0.0F; });
    ltc_decoder_write_float(state_->decoder, piece.data(), count, taken_);
    taken_ += static_cast<long long>(count);
    samples = samples.subspan(count);
    // The library learns how long a bit lasts from what it hears: after a second of hiss it may take timecode for
    // silence and would never come back.
    if (taken_ - heard_ > kFramesToRestart * sample_rate_ / frames_counted(rate_)) {
      restart();
      heard_ = taken_;
    }
    LTCFrameExt frame;
    while (ltc_decoder_read(state_->decoder, &frame) != 0) {
      const LTCFrame& ltc = frame.ltc;
      heard_ = taken_;
      const auto two = [](unsigned tens, unsigned units) { return static_cast<int>(tens * 10 + units); };
      Timecode code{two(ltc.hours_tens, ltc.hours_units), two(ltc.mins_tens, ltc.mins_units),
                    two(ltc.secs_tens, ltc.secs_units), two(ltc.frame_tens, ltc.frame_units), FrameRate::fps30};
      const long long length = frame.off_end - frame.off_start + 1;
      // Through a gap the decoder may take a frame for longer than it is.
      const bool follows = last_ && 2 * (frame.off_end - last_end_) < 3 * last_length_ && 2 * length < 3 * last_length_;
      if (valid(code)) {
        guess(length);
        learn(code, ltc.dfbit != 0, follows && frame.reverse == 0);
      }
      code.rate = rate_;
      last_.reset();
      if (!valid(code)) continue;
      last_ = code;
      // A frame is known when it is over: then the source is at its other end.
      last_end_ = std::max<long long>(frame.off_start, frame.off_end) + 1;
      last_length_ = std::max(length, 1LL);
      const Duration position = time_of(code) + (frame.reverse != 0 ? Duration{} : frame_time(rate_));
      fix({began + seconds(static_cast<double>(last_end_) / sample_rate_), position});
    }
  }
}

}  // namespace footlight::controller
