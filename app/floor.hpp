// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/look.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "core/time.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {

/// What one lamp or wearable began to show.
struct LampChange {
  Instant at;
  MarkerPlace place;
  LookIndex index = kDark;
  Look look;
};

/// What every lamp of a simulated rig shows, and what has changed since it was looked at last. Borrows show and rig.
class Floor {
 public:
  Floor(const Show& show, const Rig& rig);

  /// @return what has changed since the last call, in the order of the rig. O(lamps)
  const std::vector<LampChange>& look_at(const sim::SimulatedRig& simulated, Instant now);

  /// One line: {"t": 1.25, "node": ..., "channel": ..., "cell": ..., "look": ..., "colour": ..., ...}
  [[nodiscard]] std::string json(const LampChange& change) const;
  /// All of it in one line, the looks of each node.
  [[nodiscard]] std::string json(Instant now) const;
  /// The floor as the audience sees it from above, upstage at the top: two rows of cells in a line of half blocks, in
  /// 24-bit colours; a cell without a lamp is a shade. @param most_columns what does not fit is cut off at the sides
  [[nodiscard]] std::string picture(Instant now, int most_columns) const;

 private:
  struct Lamp {
    MarkerPlace place;
    LookIndex index = kDark;
    Look look;
  };
  [[nodiscard]] Colour seen(CellIndex cell, Instant now) const;

  const Show& show_;
  const Rig& rig_;
  std::vector<Lamp> lamps_;
  std::vector<std::int32_t> lamp_of_cell_;  ///< in lamps_, -1: none
  std::vector<LampChange> changes_;
};

/// Brightness of a lamp's effect at a time, 0..1 (docs/wire-protocol.md, section 1).
[[nodiscard]] double effect_level(Effect effect, Instant now);

}  // namespace footlight::app
