// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live/node_board.hpp"
#include "app/readiness/bus_health.hpp"
#include "app/readiness/readiness.hpp"
#include "app/readiness/spare_swap.hpp"
#include "app/surfaces/run_desk.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// Tells readiness what a run knows, bars GO until it is armed, and takes the orders `ready`, `arm`, `disarm`,
/// `override`, `swap`. Borrows all.
class ReadinessSurface final : public Surface {
 public:
  /// @param board what every node confirms  @param health looks before this does
  /// @param arms by itself as soon as all is done, once: nobody is at the desk
  ReadinessSurface(Readiness& readiness, const Rig& rig, const NodeBoard& board, const BusHealth& health, RunDesk& desk,
                   bool arms);

  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] bool listens() const override { return false; }

 private:
  void add_orders(RunDesk& desk);
  void judge_buses();
  void judge_nodes(const DeskView& view);
  void judge_checks(std::size_t unproved, std::size_t unverified);
  void judge_time(const DeskView& view);
  Result<std::string> start_swap(const std::vector<std::string>& words);
  void follow_swap(RunDesk& desk);
  void keep_places(const DeskView& view, RunDesk& desk);

  Readiness& readiness_;
  const Rig& rig_;
  const NodeBoard& board_;
  const BusHealth& health_;
  std::string unfenced_;  ///< buses on which nothing refuses another controller
  bool arms_;
  std::size_t markers_ = 0;
  std::optional<SpareSwap> swap_;
  std::size_t swapped_ = 0;       ///< node of the rig
  std::uint32_t placed_for_ = 0;  ///< reset move, in a scope without people
};

}  // namespace footlight::app
