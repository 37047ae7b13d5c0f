// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "core/timecode.hpp"

namespace footlight::controller {

/// Linear timecode (SMPTE 12M) out of sound, by libltc: any speed that it can follow, forwards and backwards.
///
/// LTC does not say its rate; drop-frame says that it is 29.97. Else the rate is learned from the last frame of a
/// second, when two seconds have ended alike. Until then it is taken for `rate`, or, where frames last as
/// those of another rate do, for that. 29.97 without drop-frame is taken for 30 at 99.9 %
/// of its speed.
class LtcDecoder {
 public:
  /// @param sample_rate Hz, 8,000 to 192,000  @param rate what is expected
  LtcDecoder(int sample_rate, FrameRate rate);
  ~LtcDecoder();
  LtcDecoder(const LtcDecoder&) = delete;
  LtcDecoder& operator=(const LtcDecoder&) = delete;

  /// @param samples mono, -1 to 1; the next ones  @param began when sample 0 of the stream sounded
  /// @param fix called for each whole frame, in order: where the source was when it ended
  void take(std::span<const float> samples, Instant began, const std::function<void(const TimeFix&)>& fix);
  /// Nothing is known any more of what came before: the sound has a gap. Samples are counted on.
  void restart();
  [[nodiscard]] long long samples() const { return taken_; }
  [[nodiscard]] FrameRate rate() const { return rate_; }
  /// The source itself has told its rate.
  [[nodiscard]] bool knows_rate() const { return knows_rate_; }

 private:
  struct State;
  void learn(const Timecode& code, bool drop, bool follows);
  void guess(long long frame_samples);

  std::unique_ptr<State> state_;
  int sample_rate_;
  FrameRate rate_;
  bool knows_rate_ = false;
  std::optional<FrameRate> seen_;  ///< at the end of the last second
  long long taken_ = 0;            ///< samples
  long long heard_ = 0;            ///< of them, when the last frame came or the library began anew
  long long last_end_ = 0;         ///< sample at which the last frame ended
  long long last_length_ = 0;
  std::optional<Timecode> last_;
};

}  // namespace footlight::controller
