// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "planner/motion/neighbours.hpp"
#include "planner/srd/congestion.hpp"
#include "planner/srd/srd_model.hpp"

namespace footlight::planner::srd {

/// One step of the model, in the order of Algorithm 1; holds what lives no longer than that. Each stage runs over
/// people in parallel and writes what belongs to each person alone.
class SrdModel::Step {
 public:
  Step(const SrdModel& model, const State& now, State& next);
  void run();

 private:
  void plan();             ///< lines 2-7
  void find_congestion();  ///< lines 8-9 and 11: who keeps the formation
  void find_neighbours();
  void avoid();  ///< line 12: collisions to come
  void solve();  ///< lines 12-18
  void guard();  ///< nobody in anybody or anything
  void move();   ///< lines 19-23

  void plan_in_formation(std::size_t i, Point destination, Point velocity);
  void plan_for_herself(std::size_t i);
  void go_around(std::size_t i);
  [[nodiscard]] Point corrected(std::size_t i) const;
  [[nodiscard]] Point desired(std::size_t i) const;
  [[nodiscard]] Point allowed(std::size_t i, Point step) const;
  [[nodiscard]] double reach_m(std::size_t i) const;
  template <class Work>
  void for_people(Work work) const;

  /// Somebody, or something, that may be met within this step.
  template <class Visit>
  void visit_near(std::size_t i, Visit visit) const;

  const SrdModel& model_;
  const MotionTask& task_;
  const SrdOptions& options_;
  const State& now_;
  State& next_;
  double at_s_;  ///< at the end of the step
  std::vector<MotionFloor::Disc> discs_;
  std::vector<double> pace_mps_;        ///< the fastest that each person can go on her ground
  std::vector<Point> destination_;      ///< where each person wants to be at the end of the step
  std::vector<Point> destination_mps_;  ///< how that moves
  std::vector<Point> predicted_;        ///< p*
  std::vector<Point> other_;            ///< the next p*, while it is worked out
  Neighbours crowd_;
  struct Chunk {
    std::vector<std::uint32_t> begin;  ///< of each of its people in `near`; one more
    std::vector<std::uint32_t> near;
  };
  std::vector<Chunk> chunks_;
};

}  // namespace footlight::planner::srd
