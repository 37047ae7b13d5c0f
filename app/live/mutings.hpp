// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "controller/cue_schedule.hpp"
#include "controller/rehearsal.hpp"
#include "core/plan.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Makes the lamps of sets of muted groups, beside the show, and keeps them. One thread calls.
class Mutings {
 public:
  /// Borrows everything.
  Mutings(const Show& show, const Plan& plan, const Rig& rig, controller::CueSchedule& schedule)
      : show_(show), plan_(plan), rig_(rig), schedule_(schedule) {}
  ~Mutings();
  Mutings(const Mutings&) = delete;
  Mutings& operator=(const Mutings&) = delete;

  /// @param muted as for build_muted; nothing where it is of a show with other groups, or no look is left for it
  void want(std::vector<bool> muted);
  /// Does not wait. @return once, when the lamps that are wanted are there: for the rehearsal
  std::optional<controller::Command> look();

 private:
  using Made = std::pair<std::vector<bool>, controller::MutedLamps>;

  const Show& show_;
  const Plan& plan_;
  const Rig& rig_;
  controller::CueSchedule& schedule_;
  std::map<std::vector<bool>, std::optional<std::size_t>> known_;  ///< first switch; none: there are too many sets
  std::future<Made> making_;
  std::optional<std::vector<bool>> wanted_;
};

}  // namespace footlight::app
