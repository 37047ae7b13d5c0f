// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "planner/schedule/pace.hpp"

namespace footlight::planner {

inline constexpr CellIndex kNoGoal{0xFFFFFFFFU};

/// One step of everybody from cells to cells.
struct SnapTask {
  const Ways* ways = nullptr;
  std::span<const CellIndex> now;  ///< where the slots are; distinct
  std::span<const CellIndex> own;  ///< the slots' own cells at the next instant; distinct
  std::span<const Wanted> wanted;  ///< at the next instant
  std::span<const Wanted> onward;  ///< at the instant after that; empty at the end
  double longest_m = 0;            ///< from now to the next instant
  double onward_m = 0;             ///< from the next instant to the one after
  std::span<const char> hold;      ///< one flag a slot: stays where it is; empty: nobody has to
  /// Where the slots must be at the next exact formation, and how far from there they may be at the next instant so
  /// that they can; kNoGoal, or all empty: there is none.
  std::span<const CellIndex> goal = {};
  double goal_m = 0;
  std::span<const char> slow = {};  ///< one flag a slot: walks no further than `slow_m`; empty: nobody has to
  double slow_m = 0;
};

/// Where the slots are next: whoever can reach the own cell stands on it; everybody else goes toward what is wanted as
/// far as walking allows and takes the best free cell near that point (cells of the picture whose owner is late are
/// preferred a little). All results are distinct, can be stood on and are at most `longest_m` away on a free straight
/// way; where that cannot be had beside all the owners, some owners give way, too. O(people on the way x cells near)
[[nodiscard]] std::vector<CellIndex> snap(const SnapTask& task);

/// The same step asked for several times, for other people who hold or are slow: what does not change is kept, so that
/// a later answer takes little more than what it changes; equally cheap places may be given to others than by `snap`.
class Snap {
 public:
  /// @param task its lists must live as long as this; `hold` and `slow` are not looked at
  explicit Snap(const SnapTask& task);
  ~Snap();
  Snap(const Snap&) = delete;
  Snap& operator=(const Snap&) = delete;

  /// @param hold, slow one flag a slot; empty: nobody has to
  [[nodiscard]] std::vector<CellIndex> cells(std::span<const char> hold, std::span<const char> slow);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace footlight::planner
