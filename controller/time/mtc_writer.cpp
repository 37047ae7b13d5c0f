// SPDX-License-Identifier: Apache-2.0
#include "controller/time/mtc_writer.hpp"

#include <algorithm>

#include "controller/time/mtc.hpp"
#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr std::int64_t kPieces = 8;
constexpr std::int64_t kMostLate = 16;  // quarter frames; more are a jump

Duration day_of(FrameRate rate) { return time_of({23, 59, 59, frames_counted(rate) - 1, rate}) + frame_time(rate); }

}  // namespace

Duration RunningTime::position_at(Instant now) const {
  return runs ? position + seconds(to_seconds(now - at) * rate) : position;
}

Duration MtcWriter::quarter_at(std::int64_t quarter) const {
  // Exact at every second, whatever a frame is rounded to.
  return Duration(quarter * (rate_ == FrameRate::fps2997_drop ? 1'001'000'000 : 1'000'000'000) /
                  (4 * frames_counted(rate_)));
}

std::span<const std::uint8_t> MtcWriter::place(Duration position) {
  placed_ = code_at(position, rate_);
  message_ = mtc_full_frame(*placed_);
  return message_;
}

std::span<const std::uint8_t> MtcWriter::take(const RunningTime& time, Instant now) {
  const Duration day = day_of(rate_);
  Duration position = time.position_at(now);
  while (position < Duration{}) position += day;
  if (!time.runs) {
    next_.reset();
    return placed_ == code_at(position, rate_) ? std::span<const std::uint8_t>{} : place(position);
  }
  FL_CHECK(time.rate > 0);
  const Duration late = next_ ? position - quarter_at(*next_) : Duration{};
  const Duration most = quarter_at(kMostLate);
  if (!next_ || late > most || late < -most) {
    // It begins, or is elsewhere: from the next pair of frames on.
    const Duration pair = quarter_at(kPieces);
    next_ = (position / pair + 1) * kPieces;
    return place(position);
  }
  if (late < Duration{}) return {};
  const std::int64_t quarter = (*next_)++;
  const auto data = mtc_quarter(code_of(quarter / kPieces * 2, rate_), static_cast<int>(quarter % kPieces));
  std::ranges::copy(data, message_.begin());
  placed_.reset();
  return std::span<const std::uint8_t>(message_).first(data.size());
}

Instant MtcWriter::next_event(const RunningTime& time) const {
  if (!time.runs || !next_) return kNever;
  const Duration day = day_of(rate_);
  Duration position = time.position;
  while (position < Duration{}) position += day;
  // A nanosecond later it is there for sure.
  return time.at + seconds(to_seconds(quarter_at(*next_) - position) / time.rate) + Duration(1);
}

}  // namespace footlight::controller
