// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/push_button.hpp"

namespace footlight::drivers {

PushButton::Event PushButton::take(bool down, Instant now) {
  if (down) {
    at_rest_since_.reset();
    const bool first = !restless_since_;
    if (first) restless_since_ = now;
    if (stuck_) return Event::none;
    if (first) return Event::pressed;
  } else {
    if (!at_rest_since_) at_rest_since_ = now;
    if (now - *at_rest_since_ >= lockout_) restless_since_.reset();
    if (stuck_ && now - *at_rest_since_ >= stuck_after_) {
      stuck_ = false;
      return Event::freed;
    }
  }
  if (stuck_ || !restless_since_ || now - *restless_since_ <= stuck_after_) return Event::none;
  stuck_ = true;
  return Event::stuck;
}

Result<PushButton::Event> ButtonInput::step(Instant now) {
  while (true) {
    const auto edge = line_->take_edge();
    if (!edge) return edge.error();
    const std::optional<bool>& down_after = edge.value();
    if (!down_after) break;
    if (const auto event = button_.take(*down_after, now); event != PushButton::Event::none) return event;
  }
  const auto down = line_->read();
  if (!down) return down.error();
  return button_.take(*down, now);
}

}  // namespace footlight::drivers
