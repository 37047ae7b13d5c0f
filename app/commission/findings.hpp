// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "app/commission/lamps.hpp"

namespace footlight::app {

/// Lamps `first`..`last` of a node (counted among its lamps, channels of wearables left out) that hang in another order
/// than the rig says.
struct TurnedLamps {
  NodeIndex node;
  int first = 0;
  int last = 0;
  bool reversed = true;  ///< the last where the first should be; else moved on around the ring
  int by = 0;            ///< not reversed: each lamp is where the rig has the one that comes so many later
  friend bool operator==(const TurnedLamps&, const TurnedLamps&) = default;
};

/// How the floor differs from the rig. Every lamp that is not where the rig says stands in exactly one of the lists,
/// pairs and segments that stand for several lamps included.
struct Findings {
  std::size_t right = 0;                               ///< lamps where the rig says
  std::vector<std::pair<NodeIndex, NodeIndex>> nodes;  ///< exchanged as a whole: addresses, or plugs
  std::vector<TurnedLamps> turned;
  std::vector<std::pair<std::size_t, std::size_t>> exchanged;  ///< each is where the rig has the other
  std::vector<std::pair<std::size_t, CellIndex>> moved;        ///< on another cell than the rig says
  std::vector<std::pair<std::size_t, CellIndex>> unassigned;   ///< the rig did not know where
  std::vector<std::size_t> dead;                               ///< not seen, and no light on their cell
  std::vector<std::size_t> unreadable;                         ///< a light is on their cell and cannot be read
  std::vector<std::size_t> nowhere;                            ///< never assigned and not seen

  [[nodiscard]] bool clean() const {
    return nodes.empty() && turned.empty() && exchanged.empty() && moved.empty() && unassigned.empty() &&
           dead.empty() && unreadable.empty();
  }
  friend bool operator==(const Findings&, const Findings&) = default;
};

/// Compares where lamps were seen with where the rig has them. Several small causes are told as one large one where
/// that explains all lamps concerned that were seen: nodes exchanged before segments turned, those before single
/// exchanges. A segment has at least three lamps.
/// @param seen for each of `lamps`; no cell twice  @param unread cells with a light of nobody, ascending
/// Complexity: O(lamps x 32^2) for nodes that are wrong, O(lamps log lamps) else
[[nodiscard]] Findings compare(const Rig& rig, const std::vector<FloorLamp>& lamps,
                               const std::vector<std::optional<CellIndex>>& seen,
                               const std::vector<CellIndex>& unread = {});

}  // namespace footlight::app
