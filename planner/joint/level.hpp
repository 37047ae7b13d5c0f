// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "planner/joint/blocks.hpp"
#include "planner/joint/frame_weight.hpp"
#include "planner/joint/joint_plan.hpp"
#include "planner/joint/time_flow.hpp"

namespace footlight::planner {

/// Whole costs for what one person in the picture is worth in one interval.
inline constexpr double kWorth = 1000;

/// One frame of a film that is looked at.
struct Look {
  std::size_t frame = 0;
  Instant at;
  double stands = 1;  ///< for so many frames
  double area = 0;    ///< of the picture, cells
  FrameWeight weight;
  std::vector<float> rho;  ///< picture in each cell, 0 in the reserve
};

/// A film's flow on blocks of one size and at every so many of its instants.
class Level {
 public:
  /// @param looks ascending by time; their weights may change between calls of `weigh`. All must outlive the level
  /// @param reserve one flag a cell  @param stride of the task's instants every how many are used; the last one is, too
  /// @param worth what a frame's weights are multiplied with, so that being in the picture for one interval is worth 1
  Level(const JointTask& task, const std::vector<Look>& looks, const CellFlags& reserve, int factor, std::size_t stride,
        double worth);
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  /// Costs by the weights of the looks.
  void weigh();
  /// Prices of another level as they would be here.
  void start_like(const Level& coarser);
  /// @return false when stopped
  bool refine(std::int32_t epsilon, const Progress& progress) { return solver_.refine(epsilon, progress); }
  [[nodiscard]] TimeFlow result() const { return solver_.result(); }
  /// What the drawings lose by these walks, theta_dev + kIouWeight theta_iou; tells of each look how many people are in
  /// it and how much picture they cover, cells.
  double judge(const TimeFlow& flow, const std::function<void(std::size_t, double, double)>& tell) const;

 private:
  /// A look from an interval between two instants.
  struct View {
    std::size_t look = 0;
    double share = 0;  // of the interval that is over
  };

  [[nodiscard]] std::vector<std::size_t> every(std::size_t stride) const;
  [[nodiscard]] std::vector<std::vector<View>> views() const;
  [[nodiscard]] FlowTask network();
  [[nodiscard]] Instant instant(std::size_t k) const { return task_.instants[at_[k]].time; }
  [[nodiscard]] const std::vector<float>& rho(std::size_t look) const {
    return blocks_.factor() == 1 ? looks_[look].rho : rho_[look];
  }
  void weigh(std::size_t k);
  void weigh_walks(std::size_t k);
  void add_given(std::size_t k, std::vector<double>& gain) const;
  [[nodiscard]] std::vector<std::vector<float>> prices_at_cells() const;

  const JointTask& task_;
  const std::vector<Look>& looks_;
  double worth_;
  Blocks blocks_;
  std::vector<std::size_t> at_;  ///< of the task's instants
  std::vector<std::vector<View>> views_;
  std::vector<std::vector<float>> rho_;  ///< of each look, where blocks are more than a cell
  std::map<long long, Reach> reach_;     ///< by length, micrometres
  FlowTask flow_;
  TimeFlowSolver solver_;
};

}  // namespace footlight::planner
