// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/srd_options.hpp"
#include "core/result.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/spare.hpp"
#include "planner/srd/free_floor.hpp"
#include "planner/srd/groups.hpp"
#include "planner/srd/step_memory.hpp"

namespace footlight::planner::srd {

/// A crowd of groups that keep their formations: Algorithm 1 of Son, Sung 2024 (core/motion/srd_options.hpp), and with
/// `formation` off the crowd it was made from, T. Weiss, A. Litteneker, C. Jiang, D. Terzopoulos, "Position-Based
/// Multi-Agent Dynamics for Real-Time Crowd Simulation", MIG 2017.
///
/// Deviations, each with its reason in docs/algorithms/srd.md: constraints are solved by Jacobi iterations with
/// averaging instead of one after the other; collisions to come are looked for once a step; and a last pass shortens
/// every step so that no two people are ever nearer than the sum of their radii (who were not before), and nobody is in
/// anything blocked, however few the iterations.
class SrdModel {
 public:
  struct State : Crowd {           // p_i, v_i
    std::vector<char> released;    ///< one flag a person: out of the formation
    std::vector<double> waited_s;  ///< of each person, that she sees a reason to change that
    std::vector<char> around;      ///< one flag a person: goes to `corner`, for her destination is out of sight
    std::vector<Point> corner;
    std::vector<std::uint32_t> passed;  ///< corners of her group's way, without formation
  };

  /// @param task must live as long as this  Errors: those of `divide`
  [[nodiscard]] static Result<SrdModel> make(const MotionTask& task, const SrdOptions& options);

  [[nodiscard]] State begin() const;
  [[nodiscard]] double step_s() const { return options_.step_s; }
  /// O(people x (neighbours x iterations + those in sight of who is released))
  void step(const State& now, State& next) const;

  /// Short range destinations s_i, of each person. @param at_s clamped to the march
  [[nodiscard]] std::vector<Point> destinations(double at_s) const;
  [[nodiscard]] const std::vector<std::uint32_t>& place_of() const { return groups_.place_of; }
  [[nodiscard]] const Groups& groups() const { return groups_; }

 private:
  class Step;
  SrdModel(const MotionTask& task, const SrdOptions& options);
  void spread();
  void make_room();

  const MotionTask* task_;
  SrdOptions options_;
  FreeFloor floor_;
  Groups groups_;
  std::vector<double> agility_;     ///< of each person
  std::vector<double> reaction_s_;  ///< of each person
  std::vector<double> radius_m_;    ///< half of the room of each person
  double widest_m_ = 0;             ///< of these
  double fastest_mps_ = 0;
  Spare<StepMemory> memory_;
};

}  // namespace footlight::planner::srd
