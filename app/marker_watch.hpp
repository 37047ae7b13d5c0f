// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "controller/bus_loop.hpp"
#include "controller/cue_schedule.hpp"
#include "core/rig.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {

/// Looks at every lamp of a simulated rig again and again and judges what it shows. Lamps of dead nodes and unused
/// channels are left out. Borrows everything.
class MarkerWatch {
 public:
  static constexpr Duration kSample = milliseconds(20);

  /// @param latch_ahead a look may be lit so long before its instant
  MarkerWatch(const Rig& rig, const controller::CueSchedule& schedule, const sim::SimulatedRig& simulated,
              Duration latch_ahead);

  /// To be called every kSample.
  void sample(Instant now, const controller::BusTarget& target);

  [[nodiscard]] std::uint64_t markers() const { return markers_.size(); }
  /// Share of marker-time that showed the planned look; 1 before the first sample.
  [[nodiscard]] double right_share() const;
  /// Times that a marker was seen to begin to show a look that is neither its planned one, nor the one before, nor
  /// NO-GUIDANCE, and that it does not keep in HOLD. A lamp without power shows nothing and is not wrong.
  [[nodiscard]] std::uint64_t wrong() const { return wrong_; }
  /// Marker-time in which that was so.
  [[nodiscard]] double wrong_s() const;

  /// Whether the lamp shows that look now: by its index, or by the number that its device has for it.
  [[nodiscard]] bool shows(NodeIndex node, std::size_t channel, LookIndex look) const;

  template <class Visit>
  void for_markers(Visit visit) const {
    for (const Marker& marker : markers_) visit(marker.node, marker.channel);
  }

 private:
  struct Marker {
    NodeIndex node;
    std::size_t channel = 0;
    LookIndex before = kDark;  ///< what was planned before its last change
    bool wrong = false;
  };
  void follow(std::size_t k);
  [[nodiscard]] bool may_show(const Marker& marker) const;

  const Rig& rig_;
  const controller::CueSchedule& schedule_;
  const sim::SimulatedRig& simulated_;
  Duration latch_ahead_;
  Look no_guidance_look_ = no_guidance_look();
  std::vector<Marker> markers_;
  std::size_t current_ = 0;
  std::size_t ahead_ = 0;  ///< a switch that may be lit already; `current_` when there is none
  std::uint64_t samples_ = 0;
  std::uint64_t right_ = 0;
  std::uint64_t wrong_ = 0;
  std::uint64_t wrong_samples_ = 0;
};

}  // namespace footlight::app
