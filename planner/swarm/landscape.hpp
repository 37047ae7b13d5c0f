// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/swarm_options.hpp"
#include "core/result.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/swarm/equations.hpp"
#include "planner/swarm/way_field.hpp"

namespace footlight::planner::swarm {

/// What does not change while a swarm moves: whose place is where, where the targets go, and what everything costs that
/// is no person.
///
/// The target of a person is her place of the formation; while the target of her crowd (all people of one group) moves
/// along the section's path, the whole formation of places moves with it, and comes to rest where the section wants it.
class Landscape {
 public:
  /// Errors (ErrorKind::input, without position): a target in an obstacle, a target that nobody can reach, a target's
  /// way through an obstacle.
  /// @param task must live as long as this
  [[nodiscard]] static Result<Landscape> make(const MotionTask& task, const SwarmOptions& options);

  [[nodiscard]] const MotionTask& task() const { return *task_; }
  [[nodiscard]] const SwarmOptions& options() const { return options_; }
  [[nodiscard]] std::size_t people() const { return task_->people(); }
  [[nodiscard]] std::size_t crowds() const { return crowds_.size(); }
  [[nodiscard]] std::uint32_t crowd(std::size_t person) const { return crowd_of_[person]; }
  /// People of one class may take each other's places.
  [[nodiscard]] std::uint32_t exchange_class(std::size_t person) const { return class_of_[person]; }
  [[nodiscard]] const std::vector<std::uint32_t>& first_places() const { return first_place_; }

  /// Where the target of each crowd is, from where it comes to rest; m. O(crowds)
  [[nodiscard]] std::vector<Point> shifts(double at_s) const;
  [[nodiscard]] Point target(std::uint32_t place, Point shift) const { return places_[place] + shift; }
  [[nodiscard]] const std::vector<Point>& places() const { return places_; }

  /// Scope sigma of a person, and of a person against what is blocked.
  [[nodiscard]] double scope_m(std::size_t person) const { return scope_m_[person]; }
  [[nodiscard]] double still_scope_m() const { return still_scope_m_; }
  /// Eq. 9, the target's scope being the whole floor. @param weighed c_obj times the largest cost of an object
  [[nodiscard]] double value(double weighed, double to_target_m) const {
    return objective(weighed, to_target_m * to_target_m * per_floor_square_);
  }
  [[nodiscard]] double per_floor_square() const { return per_floor_square_; }
  /// |P - Q|^2 / sigma^2 of the nearest blocked point Q, or `beyond` where that is more. O(1) far from everything.
  [[nodiscard]] double still_squared(Point at, double beyond) const;
  /// Nothing blocked within a step and a scope: only the edge of the floor may end a walk.
  [[nodiscard]] bool open_around(Point at) const {
    return open_.empty() || open_[floor_->ways().grid().nearest(at).at()] != 0;
  }
  /// @param open as `open_around(from)`
  [[nodiscard]] bool step_is_free(Point from, Point to, bool open) const;
  /// The ground as one more object: e^-k times the share of speed that is lost here, so that Eq. 10 lets people go on
  /// with just the share that is left.
  [[nodiscard]] double ground_cost(Point at) const { return hardest_ * (1 - floor_->speed_factor(at)); }
  [[nodiscard]] double speed_factor(Point at) const { return floor_->speed_factor(at); }

  /// Where somebody goes straight so as to come to her target around what is blocked.
  [[nodiscard]] WayField::Toward toward(std::size_t person, Point at, Point target, double at_s) const;
  [[nodiscard]] bool has_ways() const { return !fields_.empty(); }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Lead {
    Point rest;                  ///< middle of the crowd's places
    std::vector<Point> through;  ///< from the path's first point to `rest`; empty: the target stands still
    double length_m = 0;
  };
  explicit Landscape(const MotionTask& task, const SwarmOptions& options);

  void sort_into_crowds();
  [[nodiscard]] std::optional<Error> place_people();
  [[nodiscard]] std::optional<Error> lay_paths();
  void lay_fields();
  void look_around();
  [[nodiscard]] double follow_s() const { return options_.follow * task_->duration_s(); }

  const MotionTask* task_;
  SwarmOptions options_;
  const MotionFloor* floor_;
  std::vector<std::uint32_t> crowd_of_;
  std::vector<std::uint32_t> class_of_;
  std::vector<std::uint32_t> first_place_;
  std::vector<Point> places_;
  std::vector<Lead> crowds_;
  std::vector<double> scope_m_;
  double still_scope_m_ = 0;
  double per_floor_square_ = 1;
  double hardest_ = 1;                  ///< e^-k
  std::vector<char> open_;              ///< one flag a cell; empty: nothing is blocked
  std::unique_ptr<Passages> passages_;  ///< nothing is blocked: none
  /// Of each crowd, for equal stretches of time.
  std::vector<std::vector<WayField>> fields_;
  double field_s_ = 1;
  std::vector<std::string> notes_;
};

}  // namespace footlight::planner::swarm
