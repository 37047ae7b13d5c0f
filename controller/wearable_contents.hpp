// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "controller/crowd.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// What every wearable tells besides its look, from switch to switch: where the next walk leads, how far, and when it
/// begins. A function of show time alone.
struct WearableContents {
  struct Worn {
    NodeIndex node;
    int channel = 0;
    PerformerIndex performer;
  };
  std::vector<Worn> worn;                         ///< in the order of the rig
  std::vector<drivers::WearableContent> table{};  ///< switches x worn

  [[nodiscard]] const drivers::WearableContent& at(std::size_t k, std::size_t w) const {
    return table[k * worn.size() + w];
  }
};

/// The wearables of a rig.
[[nodiscard]] std::vector<WearableContents::Worn> worn_in(const Rig& rig);

/// What a wearable tells while its performer does that: the walk that is announced, else the one under way, else
/// nothing. Direction and distance are those from cell to cell, straight. O(log marks)
[[nodiscard]] drivers::WearableContent content_of(const Doing& doing, const std::vector<Mark>& track, const Grid& grid,
                                                  const TempoMap& tempo);

}  // namespace footlight::controller
