// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/motion/painted_options.hpp"
#include "planner/motion/crowd.hpp"
#include "planner/motion/floor.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/neighbours.hpp"
#include "planner/painted/grid_flow.hpp"
#include "planner/painted/scene.hpp"
#include "planner/painted/sph.hpp"
#include "planner/painted/way_field.hpp"

namespace footlight::planner {

/// People who follow a painting.
///
/// Source: Kang, Kim 2014, sections 3 and 4. Each person has a waypoint in every shape of her party, and all go from
/// shape to shape in the same stretches of time, as long as their mean ways are. Three static forces lead her: to the
/// waypoint, along the stroke (Eq. 3), off the background (gradient vector flow); three dynamic ones act between and
/// around people: the incompressible flow within the stroke (Eq. 4), pressure and viscosity of smoothed particles. The
/// paper gives no weights: here the first two make one wanted velocity, more of the stroke the stronger its field is
/// where she is, and no longer once she has passed its head; the others are accelerations beside it. Before a stroke,
/// and where no stroke leads, people take the shortest free way. What would bring anybody nearer to something blocked
/// than it may is cut off at the contact and goes on along it: nobody can enter an obstacle.
///
/// People at rest are as far apart as `kFill` of the cells make room for, and nobody pushes who queues: towards
/// somebody ahead who wants the same way a person closes in only as the room between them allows within her reaction.
/// Without it everybody's drive would add up towards a door, and no pressure of a fluid could hold the crowd apart.
class PaintedModel {
 public:
  struct State : Crowd {
    std::vector<std::uint32_t> leg;  ///< on which leg she is
    std::vector<double> along;       ///< index into her stroke's line as far as she has come; its end: passed
    /// Of each stroke, as `flows_`; one generation's is the next one's as long as nothing changes in it.
    std::vector<std::shared_ptr<const GridFlow::State>> flow;
  };

  /// @param task, scene outlive this; task.from are the centres of the scene's begin cells, in any order
  PaintedModel(const MotionTask& task, const PaintedOptions& options, const PaintedScene& scene);

  [[nodiscard]] State begin() const;
  [[nodiscard]] double step_s() const { return options_.step_s; }
  void step(const State& now, State& next) const;

  /// For each person the number of her end cell in PaintedScene::end_cells.
  [[nodiscard]] const std::vector<std::uint32_t>& place_of() const { return number_; }

 private:
  struct StrokeFlow {
    const Stroke* stroke = nullptr;
    const FlowField* field = nullptr;
    GridFlow flow;
    WayField way;                ///< to the stroke's pixels
    std::vector<double> left_m;  ///< along the line from each point to its head
  };
  struct Leg {
    std::vector<std::size_t> strokes;  ///< into flows_
    WayField way;                      ///< to the next shape
    double end_s = 0;                  ///< when the party should have come to it
  };
  struct Guidance {
    Point direction;       ///< of length 1 or 0
    double left_m = 0;     ///< of her way
    double on_stroke = 0;  ///< 0..1
    double calm = 1;       ///< 0..1: how much the others and the background count; less near her waypoint
  };
  /// What everybody's step reads beside the generation before.
  struct Around {
    Neighbours near;
    Particles people;
    std::vector<double> spacing_m;  ///< of each person now
    std::vector<double> taken;      ///< share of the floor around each; empty: nobody minds the others
    std::vector<Guidance> lead;
    std::vector<double> pace_mps;  ///< of each party
    std::vector<MotionFloor::Disc> discs;
  };

  void find_people();
  void prepare_legs();
  void time_legs();
  [[nodiscard]] StrokeFlow stroke_flow(const PaintedScene::Party& party, std::size_t leg, std::size_t stroke) const;
  [[nodiscard]] const StrokeFlow* stroke_of(std::size_t person, std::size_t leg) const;
  [[nodiscard]] Guidance guidance(std::size_t person, const State& now, State& next) const;
  [[nodiscard]] Point toward(Point from, Point to, const WayField& way, double& length_m) const;
  [[nodiscard]] Point from_discs(Point at, double radius_m, double speed_mps,
                                 const std::vector<MotionFloor::Disc>& discs) const;
  [[nodiscard]] Point walked(Point from, Point to) const;
  [[nodiscard]] std::vector<double> paces(const std::vector<Guidance>& lead, const State& next) const;
  [[nodiscard]] Point queued(std::size_t person, Point velocity, const Around& around) const;
  void move(std::size_t person, const State& now, State& next, const Around& around) const;
  [[nodiscard]] Point to_floor_vector(Point pixels) const { return {pixels.x, -pixels.y}; }

  const MotionTask& task_;
  PaintedOptions options_;
  const PaintedScene& scene_;
  std::vector<std::uint32_t> number_;   ///< of each person in the scene
  std::vector<std::uint32_t> party_;    ///< of each person
  std::vector<std::uint32_t> place_;    ///< of each person in her party
  std::vector<std::vector<Leg>> legs_;  ///< of each party
  std::vector<StrokeFlow> flows_;
  std::vector<std::vector<std::uint32_t>> stroke_;  ///< of each person on each leg; npos: none
  Raster<double> away_px_;                          ///< from what is blocked
  Raster<double> clear_m_;         ///< from each pixel's middle, so far is free of everything that must be kept off
  std::vector<double> spacing_m_;  ///< of each person at rest
  double widest_m_ = 0;
  ParticleFluid fluid_;
};
static_assert(MotionModel<PaintedModel>);

}  // namespace footlight::planner
