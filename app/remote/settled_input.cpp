// SPDX-License-Identifier: Apache-2.0
#include "app/remote/settled_input.hpp"

namespace footlight::app {

Result<bool> SettledInput::step(Instant now) {
  bool was_worse = false;
  while (true) {
    const auto edge = line_->take_edge();
    if (!edge) return edge.error();
    const std::optional<bool>& after = edge.value();
    if (!after) break;
    was_worse = was_worse || *after == worse_;
  }
  const auto level = line_->read();
  if (!level) return level.error();
  if (was_worse || *level == worse_) {
    level_ = worse_;
    better_since_.reset();
  }
  if (*level == worse_) return level_;
  if (!better_since_) better_since_ = now;
  if (now - *better_since_ >= kRest) level_ = !worse_;
  return level_;
}

}  // namespace footlight::app
