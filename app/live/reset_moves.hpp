// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "controller/cue_schedule.hpp"
#include "controller/rehearsal.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// What a way is, for people: "reset: 12 people walk, at most 5.1 m, ...".
[[nodiscard]] std::string way_text(const Plan& way);

/// Plans the ways back that a rehearsal asks for, beside the show, one at a time, and keeps them: a loop asks for the
/// same one again and again. One thread calls.
class ResetMoves {
 public:
  /// A valid plan of two sections: people stand for the count-in, then walk; or why there is none. Called by another
  /// thread; to be given up when `abandoned`.
  using PlanWay = std::function<Result<Plan>(Instant from, Instant to, const std::atomic<bool>& abandoned)>;

  /// Borrows everything. @param plan_way empty: there never is a way
  ResetMoves(const Show& show, const Rig& rig, controller::CueSchedule& schedule, PlanWay plan_way);
  ~ResetMoves();
  ResetMoves(const ResetMoves&) = delete;
  ResetMoves& operator=(const ResetMoves&) = delete;

  struct News {
    controller::Command command;        ///< for the rehearsal
    std::string text;                   ///< for people
    std::shared_ptr<const Plan> way{};  ///< where everybody walks; null: there is none
  };
  /// Does not wait. @param asked what the rehearsal asks for now @return once for each answer
  std::optional<News> look(const controller::Rehearsal::Reset& asked);

 private:
  using Key = std::pair<Instant, Instant>;
  struct Made {
    Result<controller::ResetMove> move;
    std::string text;
    std::shared_ptr<const Plan> way{};
  };
  struct Known {
    std::optional<std::size_t> first;  ///< none: there is no way
    std::string text;
    std::shared_ptr<const Plan> way{};
  };
  void plan(const Key& key);
  [[nodiscard]] Known keep(Made made);

  const Show& show_;
  const Rig& rig_;
  controller::CueSchedule& schedule_;
  PlanWay plan_way_;
  std::map<Key, Known> known_;
  std::optional<Key> planning_;
  std::future<Made> made_;
  std::atomic<bool> abandoned_{false};
  std::uint32_t answered_ = 0;
};

}  // namespace footlight::app
