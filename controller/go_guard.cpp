// SPDX-License-Identifier: Apache-2.0
#include "controller/go_guard.hpp"

namespace footlight::controller {
namespace {

constexpr Duration kStuck = milliseconds(5000);

bool within(Instant last, Instant now, Duration least) { return last != Instant::min() && now - last < least; }

}  // namespace

GoGuard::Verdict GoGuard::press(GoSource source, Instant now) noexcept {
  Input& input = inputs_[static_cast<std::size_t>(source)];
  const bool goes_on = within(input.last, now, least_);
  if (!goes_on) input.first = now;
  input.last = now;
  if (goes_on && now - input.first > kStuck) input.off = true;
  if (input.off) return Verdict::switched_off;
  if (source == GoSource::keyboard && goes_on) return Verdict::held;
  if (within(taken_, now, least_)) return Verdict::too_soon;
  taken_ = now;
  return Verdict::taken;
}

void GoGuard::acknowledge() noexcept {
  for (Input& input : inputs_) input.off = false;
}

}  // namespace footlight::controller
