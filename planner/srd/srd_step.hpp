// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <tbb/parallel_for.h>

#include "planner/srd/congestion.hpp"
#include "planner/srd/constraints.hpp"
#include "planner/srd/srd_model.hpp"

namespace footlight::planner::srd {

/// One step of the model, in the order of Algorithm 1. Each stage runs over people in parallel and writes what belongs
/// to each person alone. Person k is the k-th of the memory's order, her number in the task is who(k).
class SrdModel::Step {
 public:
  Step(const SrdModel& model, const State& now, State& next, StepMemory& memory);
  void run();

 private:
  void sort();
  void plan();             ///< lines 2-7
  void find_congestion();  ///< lines 8-9 and 11: who keeps the formation
  void find_neighbours();
  void avoid();  ///< line 12: collisions to come
  void solve();  ///< lines 12-18
  void guard();  ///< nobody in anybody or anything
  void move();   ///< lines 19-23

  void plan_in_formation(std::size_t k, Point destination, Point velocity);
  void plan_for_herself(std::size_t k);
  void go_around(std::size_t k);
  [[nodiscard]] Point aside(std::size_t k, double strength) const;
  [[nodiscard]] Point corrected(std::size_t k) const;
  [[nodiscard]] Point desired(std::size_t k) const;
  [[nodiscard]] Point allowed(std::size_t k, Point step) const;
  [[nodiscard]] std::uint32_t who(std::size_t k) const { return memory_.crowd.order()[k]; }
  [[nodiscard]] Point here(std::size_t k) const { return memory_.crowd.places()[k]; }
  [[nodiscard]] Moving moving(std::size_t k) const {
    return {{memory_.x[k], memory_.y[k]}, {memory_.x_mps[k], memory_.y_mps[k]}};
  }
  template <class Work>
  void for_people(Work work) const;
  /// Who may be met within this step.
  template <class Visit>
  void visit_near(std::size_t k, Visit visit) const;

  static constexpr std::size_t kChunk = 256;  ///< people of one piece of work

  const SrdModel& model_;
  const MotionTask& task_;
  const SrdOptions& options_;
  const State& now_;
  State& next_;
  StepMemory& memory_;
  double at_s_;  ///< at the end of the step
  std::vector<MotionFloor::Disc> discs_;
};

template <class Work>
void SrdModel::Step::for_people(Work work) const {
  tbb::parallel_for(std::size_t{0}, memory_.chunks.size(), [&](std::size_t chunk) {
    const std::size_t end = std::min(task_.people(), (chunk + 1) * kChunk);
    for (std::size_t k = chunk * kChunk; k < end; ++k) work(k);
  });
}

template <class Visit>
void SrdModel::Step::visit_near(std::size_t k, Visit visit) const {
  const StepMemory::Chunk& chunk = memory_.chunks[k / kChunk];
  const std::size_t n = k % kChunk;
  for (std::uint32_t at = chunk.begin[n]; at < chunk.begin[n + 1]; ++at) visit(chunk.near[at]);
}

}  // namespace footlight::planner::srd
