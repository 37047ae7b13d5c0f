// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "app/live/live_run.hpp"
#include "core/plan.hpp"
#include "planner/freeze.hpp"

namespace footlight::app {

/// Knows at every moment of a run what a freeze would do: the whole show is judged beside it, once for each tempo, and
/// each reset move as soon as it is planned. One thread calls.
class FreezeWatch {
 public:
  /// Borrows the plan, and reads it when it is asked. @param waits show times at which the show waits for GO
  FreezeWatch(const Plan& plan, std::vector<Instant> waits) : plan_(plan), waits_(std::move(waits)) {}
  ~FreezeWatch();
  FreezeWatch(const FreezeWatch&) = delete;
  FreezeWatch& operator=(const FreezeWatch&) = delete;

  /// The plan has other contents.
  void plan_taken(std::vector<Instant> waits);
  /// What a freeze now would do: in the show, or in the reset move that is under way. Does not wait: `known` is false
  /// until it has been judged for this tempo, or a faster one, at which people come further in the time that they take
  /// to stop.
  [[nodiscard]] FreezeView look(const DeskView& view);

 private:
  struct Judged {
    std::uint32_t plan = 0;
    int percent = 0;
    std::shared_ptr<const Plan> way{};  ///< null: the show
    planner::FreezeJudgement what{};
  };
  struct Judging {
    std::optional<Judged> judged;
    std::future<Judged> running;
    /// @return whether nothing is under way
    bool take();
  };
  [[nodiscard]] FreezeView look_at_show(Instant position, int percent);
  [[nodiscard]] FreezeView look_at_way(const std::shared_ptr<const Plan>& way, Instant at, bool moves);

  const Plan& plan_;
  std::vector<Instant> waits_;
  std::uint32_t plans_ = 0;
  std::atomic<bool> abandoned_{false};
  Judging show_;
  Judging way_;
};

}  // namespace footlight::app
