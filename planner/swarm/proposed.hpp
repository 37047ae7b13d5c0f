// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/rng.hpp"
#include "planner/motion/model.hpp"
#include "planner/motion/spare.hpp"
#include "planner/swarm/crowd_best.hpp"
#include "planner/swarm/landscape.hpp"
#include "planner/swarm/surroundings.hpp"
#include "planner/swarm/tries.hpp"

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
  struct Intention {
    Point from;
    Point to;
    Point direction;
    double weighed = 0;
    double priority = 0;
    std::uint32_t exchange = 0;  ///< whose place she would rather have, by rank; her own rank: nobody's
  };
  /// What is found out in a step; forgotten after it. By rank (swarm/surroundings.hpp).
  struct Scratch {
    Surroundings around;
    std::vector<Point> target;             ///< of her own place
    std::vector<std::uint32_t> may_trade;  ///< people of equal numbers may exchange places; kNobody: not now
    std::vector<Intention> wishes;
  };
  static constexpr std::uint32_t kNobody = 0xFFFFFFFF;
  /// A step of everybody.
  struct Turn {
    const State& now;
    const State& next;
    Scratch& scratch;
    std::span<const Point> shifts;  ///< of targets when the step ends
    double from_s = 0;
  };
  /// Somebody in it.
  struct Walker {
    std::size_t person = 0;
    std::size_t rank = 0;
    Point at;
    Point heading_for;
    double rest_m = 0;
    std::span<const Surroundings::Near> near;
    double avoid = 0;          ///< c_obj
    double still_squared = 0;  ///< squared distance by scope to the nearest person or blocked point, where she stands
    bool open = false;         ///< nothing blocked within a step and a scope
  };
  /// One of the points that she might step to.
  struct Option {
    Point step;
    double worst = 0;      ///< cost of the nearest object, the ground included
    double weighed = 0;    ///< the same, by c_obj
    double value = 0;      ///< Eq. 9
    bool allowed = false;  ///< touches nobody, and nothing that stands
    double disc_m = 0;     ///< how far it stays off everything that moves, beyond what it has to; negative: too near
    [[nodiscard]] bool free() const { return allowed && disc_m >= 0; }
    [[nodiscard]] bool better_than(const Option& other) const {
      if (allowed != other.allowed) return allowed;
      if (free() != other.free()) return free();
      return free() ? value < other.value : disc_m > other.disc_m;
    }
  };

  /// c_obj of Eq. 9 for somebody: within `slow_m` of the target it falls with the square of the distance. Else the
  /// least value would lie beside the place, pushed away by the neighbours' places.
  [[nodiscard]] double avoid(Point at, Point heading_for, double rest_m) const;
  void find_ways(const State& now, std::span<const Point> shifts, double from_s, State& next) const;
  void find_targets(const Turn& turn) const;
  [[nodiscard]] Walker walker_of(const Turn& turn, std::size_t rank, std::span<const Surroundings::Near> near) const;
  [[nodiscard]] Intention choose(const Turn& turn, std::size_t rank, std::vector<Surroundings::Near>& near) const;
  /// The best of some steps, the first among equals; whether the floor is free for it is looked at only for who leads.
  [[nodiscard]] Option best_of(const Turn& turn, const Walker& walker, Tries& tries) const;
  void judge(const Turn& turn, const Walker& walker, Tries& tries) const;
  [[nodiscard]] double disc_room(const Surroundings::Disc& disc, const Walker& walker, Point to) const;
  [[nodiscard]] Option search(const Turn& turn, const Walker& walker, Point move, bool flees, Rng& rng) const;
  [[nodiscard]] std::uint32_t better_place(const Turn& turn, const Walker& walker) const;
  [[nodiscard]] bool has_to_wait(const Turn& turn, std::size_t rank) const;
  void settle(const Turn& turn, State& next) const;

  const Landscape* landscape_;
  bool knows_target_;
  std::uint64_t look_ticks_ = 1;          ///< so often somebody looks for her way around what is blocked
  std::vector<double> pace_;              ///< V_max of each person as share of her limit
  std::vector<std::uint32_t> may_trade_;  ///< of each person, see Scratch
  /// Cosine and sine of the grid of angles around the best try, by size, each to both sides.
  std::vector<std::pair<double, double>> grid_turns_;
  Spare<Scratch> scratch_;
};
static_assert(MotionModel<ProposedSwarm>);

}  // namespace footlight::planner::swarm
