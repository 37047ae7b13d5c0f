// SPDX-License-Identifier: Apache-2.0
#include "app/marker_watch.hpp"

#include <algorithm>

#include "drivers/registry.hpp"

namespace footlight::app {

MarkerWatch::MarkerWatch(const Rig& rig, const controller::CueSchedule& schedule, const sim::SimulatedRig& simulated,
                         Duration latch_ahead)
    : rig_(rig), schedule_(schedule), simulated_(simulated), latch_ahead_(latch_ahead) {
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    const auto node = NodeIndex::of(n);
    if (std::ranges::binary_search(simulated.dead(), node)) continue;
    for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
      if (rig.nodes[n].channels[c].kind != Channel::Kind::unused) markers_.push_back({node, c, kDark, false});
    }
  }
}

void MarkerWatch::sample(Instant now, const controller::BusTarget& target) {
  follow(target.current);
  ahead_ = target.next_at != kNever && target.next_at - now <= latch_ahead_ ? target.next : current_;
  for (Marker& marker : markers_) {
    const bool right = shows(marker.node, marker.channel, schedule_.looks_of(current_, marker.node)[marker.channel]);
    ++samples_;
    right_ += right ? 1 : 0;
    const bool wrong = !right && !may_show(marker);
    wrong_ += wrong && !marker.wrong ? 1 : 0;
    wrong_samples_ += wrong ? 1 : 0;
    marker.wrong = wrong;
  }
}

void MarkerWatch::follow(std::size_t k) {
  while (current_ < k) {
    for (Marker& marker : markers_) {
      const LookIndex old = schedule_.looks_of(current_, marker.node)[marker.channel];
      if (old != schedule_.looks_of(current_ + 1, marker.node)[marker.channel]) marker.before = old;
    }
    ++current_;
  }
}

bool MarkerWatch::shows(NodeIndex node, std::size_t channel, LookIndex look) const {
  const Look& meant = look == kNoGuidance ? no_guidance_look_ : schedule_.looks()[look];
  const Bus& bus = rig_.buses[rig_.nodes[node.at()].bus.at()];
  if (bus.kind == BusKind::dmx) {
    return drivers::levels_show(bus, meant, simulated_.levels(node, static_cast<int>(channel)));
  }
  return simulated_.shown(node, static_cast<int>(channel)) == drivers::shown_for(bus, look, meant);
}

bool MarkerWatch::may_show(const Marker& marker) const {
  return shows(marker.node, marker.channel, marker.before) || shows(marker.node, marker.channel, kNoGuidance) ||
         !simulated_.powered(marker.node) ||
         shows(marker.node, marker.channel, schedule_.looks_of(ahead_, marker.node)[marker.channel]) ||
         simulated_.holds(marker.node);
}

double MarkerWatch::right_share() const {
  return samples_ == 0 ? 1 : static_cast<double>(right_) / static_cast<double>(samples_);
}

double MarkerWatch::wrong_s() const { return static_cast<double>(wrong_samples_) * to_seconds(kSample); }

}  // namespace footlight::app
