// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rng.hpp"
#include "planner/motion/model.hpp"
#include "planner/swarm/crowd_best.hpp"
#include "planner/swarm/landscape.hpp"
#include "planner/swarm/surroundings.hpp"

namespace footlight::planner::swarm {

/// The crowd of Lin 2007: direction and speed apart (Eq. 6-7), one exponential cost for everything (Eq. 8-9), steps
/// accepted with Eq. 10, and where a step is not accepted a search among random angles and a grid of angles.
///
/// A step has two halves. First everybody chooses where to go, looking at the frozen generation alone: the way there is
/// clear of everybody's place, of what is blocked and of what moves. Then of every two whose ways come too close to
/// each other the one with the smaller number drawn for this step stays where she is: with her standing still the
/// other's way has already been looked at. So nobody ever touches anybody who did not do so before.
class ProposedSwarm {
 public:
  struct State : Crowd {
    std::vector<Point> direction;      ///< D of Eq. 6, of length 1
    std::vector<Point> best;           ///< P_BLS on this piece of the way, m
    std::vector<double> best_weighed;  ///< c_obj times the largest cost of an object there
    std::vector<Point> heading_for;    ///< where the way to the target goes straight to, m
    std::vector<double> rest_m;        ///< of the way from there; 0: it is the target
    std::vector<std::uint32_t> place;  ///< of each person, a permutation
    CrowdBest crowd_best;              ///< P_BGS, where it is not the target itself
  };

  /// @param landscape must live as long as this
  explicit ProposedSwarm(const Landscape& landscape);

  [[nodiscard]] State begin() const;
  [[nodiscard]] double step_s() const { return landscape_->options().step_s; }
  /// O(people x people near)
  void step(const State& now, State& next) const;

 private:
  /// A step of everybody.
  struct Turn {
    const State& now;
    const Surroundings& around;
    std::span<const Point> shifts;  ///< of targets when the step ends
    double from_s = 0;
  };
  /// Somebody in it.
  struct Walker {
    std::size_t person = 0;
    Point at;
    Point heading_for;
    double rest_m = 0;
    std::span<const Surroundings::Near> near;
    double avoid = 0;          ///< c_obj
    double still_squared = 0;  ///< squared distance by scope to the nearest person or blocked point, where she stands
  };
  /// One of the points that she might step to.
  struct Option {
    Point to;
    double worst = 0;      ///< cost of the nearest object, the ground included
    double weighed = 0;    ///< the same, by c_obj
    double value = 0;      ///< Eq. 9
    bool allowed = false;  ///< touches nobody, and nothing that stands
    double disc_m = 0;     ///< how far it stays off everything that moves, beyond what it has to; negative: too near
    [[nodiscard]] bool free() const { return allowed && disc_m >= 0; }
  };
  struct Intention {
    Point to;
    Point direction;
    double weighed = 0;
    double priority = 0;
    std::uint32_t exchange = 0;  ///< whose place she would rather have; her own number: nobody's
  };

  /// c_obj of Eq. 9 for somebody: within `slow_m` of the target it falls with the square of the distance. Else the
  /// least value would lie beside the place, pushed away by the neighbours' places.
  [[nodiscard]] double avoid(Point at, Point heading_for, double rest_m) const;
  void find_ways(const Turn& turn, State& next) const;
  [[nodiscard]] Intention choose(const Turn& turn, const State& next, std::size_t person,
                                 std::vector<Surroundings::Near>& near) const;
  [[nodiscard]] Option judge(const Turn& turn, const Walker& walker, Point to) const;
  [[nodiscard]] Option search(const Turn& turn, const Walker& walker, Point move, bool flees, Rng& rng) const;
  [[nodiscard]] std::uint32_t better_place(const Turn& turn, const Walker& walker) const;
  [[nodiscard]] bool has_to_wait(const Turn& turn, std::span<const Intention> wishes, std::size_t person,
                                 std::vector<Surroundings::Near>& near) const;
  void settle(const Turn& turn, std::span<const Intention> wishes, State& next) const;

  const Landscape* landscape_;
  bool knows_target_;
  std::uint64_t look_ticks_ = 1;  ///< so often somebody looks for her way around what is blocked
  std::vector<double> pace_;      ///< V_max of each person as share of her limit
};
static_assert(MotionModel<ProposedSwarm>);

}  // namespace footlight::planner::swarm
