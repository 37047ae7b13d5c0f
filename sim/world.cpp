// SPDX-License-Identifier: Apache-2.0
#include "sim/world.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::sim {

void World::schedule(Instant at, Actor& actor, std::uint64_t token) {
  FL_CHECK(at >= now());
  events_.push_back({at, order_++, &actor, token});
  std::push_heap(events_.begin(), events_.end(), later);
}

void World::advance_to(Instant instant) {
  while (!events_.empty() && events_.front().at <= instant) {
    std::pop_heap(events_.begin(), events_.end(), later);
    const Event event = events_.back();
    events_.pop_back();
    clock_.advance_to(event.at);
    event.actor->act(event.token);
  }
  clock_.advance_to(instant);
}

}  // namespace footlight::sim
