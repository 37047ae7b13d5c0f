// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "app/live/live_run.hpp"
#include "core/plan.hpp"
#include "planner/freeze.hpp"

namespace footlight::app {

/// Knows at every moment of a run what a freeze would do: the whole show is judged beside it, once for each tempo.
/// One thread calls.
class FreezeWatch {
 public:
  /// Borrows the plan, and reads it when it is asked. @param waits show times at which the show waits for GO
  FreezeWatch(const Plan& plan, std::vector<Instant> waits) : plan_(plan), waits_(std::move(waits)) {}
  ~FreezeWatch();
  FreezeWatch(const FreezeWatch&) = delete;
  FreezeWatch& operator=(const FreezeWatch&) = delete;

  /// The plan has other contents.
  void plan_taken(std::vector<Instant> waits);
  /// Does not wait: `known` is false until the show has been judged for this tempo, or a faster one, at which people
  /// come further in the time that they take to stop.
  [[nodiscard]] FreezeView look(Instant position, int percent);

 private:
  struct Judged {
    std::uint32_t plan = 0;
    int percent = 0;
    planner::FreezeJudgement what;
  };
  const Plan& plan_;
  std::vector<Instant> waits_;
  std::uint32_t plans_ = 0;
  std::optional<Judged> judged_;
  std::future<Judged> judging_;
  std::atomic<bool> abandoned_{false};
};

}  // namespace footlight::app
