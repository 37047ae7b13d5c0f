// SPDX-License-Identifier: Apache-2.0
#include "controller/go_guard.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kStuck = milliseconds(5000);

bool within(Instant last, Instant now, Duration least) { return last != Instant::min() && now - last < least; }

}  // namespace

GoGuard::Verdict GoGuard::press(GoSource source, std::uint8_t number, Instant now) noexcept {
  const std::size_t which = number % kMostGoInputs;
  const std::uint64_t bit = std::uint64_t{1} << which;
  Input& input = inputs_[which];
  const bool goes_on = within(input.last, now, least_);
  if (!goes_on) input.first = now;
  input.last = now;
  if (goes_on && now - input.first > kStuck) off_ |= bit;
  if ((off_ & bit) != 0) return Verdict::switched_off;
  if (source == GoSource::keyboard && goes_on) return Verdict::held;
  if (within(taken_, now, least_)) return Verdict::too_soon;
  taken_ = now;
  return Verdict::taken;
}

void GoGuard::acknowledge() noexcept { off_ = 0; }

}  // namespace footlight::controller
