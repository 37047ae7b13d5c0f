// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/index.hpp"
#include "planner/joint/time_flow_marks.hpp"
#include "planner/progress.hpp"

namespace footlight::planner {

/// Which cells can be reached from each cell in one interval: the ones of cell c are to[first[c]] .. to[first[c + 1]].
/// Symmetric, and every cell on which people may stand reaches itself; the others reach nothing. What a walk costs
/// depends on its kind.
struct Reach {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> to;
  std::vector<std::uint8_t> kind;          ///< of each walk
  std::array<std::uint8_t, 256> mirror{};  ///< kind of the same walk the other way round
};

/// One interval.
struct FlowInterval {
  const Reach* reach = nullptr;
  std::array<std::int32_t, 256> cost{};  ///< of a walk of each kind
};

/// People walk through intervals and end where they like; no cell is held by two at an instant.
/// |cost| < 2^20; sums over all intervals < 2^28.
struct FlowTask {
  std::size_t cells = 0;
  std::size_t people = 0;
  std::vector<CellIndex> start;         ///< distinct, one for each person; empty: they begin where they like
  std::vector<FlowInterval> intervals;  ///< at least one
  std::vector<std::int32_t> stand;      ///< cost of being on each cell at each instant: (intervals + 1) x cells
};

struct TimeFlow {
  std::vector<std::vector<CellIndex>> at;  ///< for each instant (intervals + 1) and person
  std::int64_t cost = 0;
  /// No plan of walks costs less: the value of the dual solution (a price for each cell and instant) found with it.
  std::int64_t bound = 0;
};

/// Cheap walks of all people through all intervals together: a minimum-cost flow in the network of cells and instants
/// with one person a node. Epsilon relaxation with scaling (Bertsekas, Tsitsiklis 1989, sections 5.3-5.4), an auction:
/// whoever stands at a node bids for the next one up to what her second choice would cost, who is outbid chooses again
/// or takes her last step back, and places that are too dear for everybody come down until somebody comes. Now and then
/// all labels are set at once to the shortest ways through the residual network (price updates, Goldberg 1997): without
/// that the last few people bid against each other one epsilon at a time. The first labels are the exact costs to the
/// end of somebody who is alone. Deterministic. Memory: 33 bytes a node.
class TimeFlowSolver {
 public:
  /// @param task must outlive the solver; its costs may change between calls of `refine`
  explicit TimeFlowSolver(const FlowTask& task);

  /// Finds walks that cost at most `epsilon` a person and interval more than the best, mostly far less. Prices that
  /// were found before are where it starts: going from a large epsilon to a small one is quicker than a small one
  /// alone.
  /// @return false when stopped
  bool refine(std::int32_t epsilon, const Progress& progress);
  /// What being at each node costs beyond its own cost, since others want to be there, too; after `refine`.
  [[nodiscard]] std::vector<std::int32_t> prices() const;
  /// The next `refine` starts from these prices, none below 0, instead of those that it found.
  void start_from(const std::vector<std::int32_t>& prices);
  /// After at least one `refine`. O(walks)
  [[nodiscard]] TimeFlow result() const;

 private:
  /// What somebody at a node, or a node that waits for somebody, can have.
  struct Offer {
    std::int32_t best = 0;
    std::int32_t second = 0;
    std::uint32_t node = 0;
    std::uint8_t kind = 0;
  };

  [[nodiscard]] std::uint32_t node(std::uint32_t k, std::uint32_t cell) const { return k * cells_ + cell; }
  [[nodiscard]] std::int32_t walk_to(std::uint32_t node) const {
    return task_.intervals[node / cells_ - 1].cost[kind_[node]];
  }
  [[nodiscard]] bool can_stand(std::uint32_t k, std::uint32_t cell) const;
  [[nodiscard]] Offer onward(std::uint32_t at) const;
  [[nodiscard]] Offer backward(std::uint32_t at) const;
  void look_back();
  bool fill_all(const Progress& progress);
  bool enter();
  void begin_somewhere();
  void offer_start(std::uint32_t cell);
  void bid(std::uint32_t at);
  void leave(std::uint32_t at);
  void fill(std::uint32_t at);
  void fill_start(std::uint32_t at, std::int32_t worth);
  void give_up(std::uint32_t at, std::int32_t label);
  [[nodiscard]] std::vector<std::uint32_t> starts() const;
  [[nodiscard]] std::int64_t bound() const;
  /// Whether somebody is here who has yet to choose where to go.
  [[nodiscard]] bool is_bidder(std::uint32_t at) const {
    return from_[at] != kEmpty && next_[at] == kNone && at < node(last_, 0);
  }

  // Labels set at once: time_flow_labels.cpp.
  void raise_labels();
  void lower_labels();
  void forget_distances();
  template <class Settle>
  std::int32_t settle_distances(std::size_t wanted, Settle settle);
  void move_labels(std::int32_t furthest, std::int32_t step);
  void offer_starts();
  void set_steps();
  [[nodiscard]] std::int32_t steps(std::int32_t cost) const;
  [[nodiscard]] std::int32_t epsilons(std::int32_t cost) const;  ///< how often the epsilon is in it
  void put(std::uint32_t point, std::int32_t distance);
  void reach_in(std::uint32_t at, std::int32_t distance) { put(2 * at, distance); }
  void reach_out(std::uint32_t at, std::int32_t distance) { put(2 * at + 1, distance); }
  void reach_source(std::int32_t distance) { put(2 * static_cast<std::uint32_t>(from_.size()), distance); }
  void ways_into(std::uint32_t point, std::int32_t distance);
  void ways_out_of(std::uint32_t point, std::int32_t distance);

  const FlowTask& task_;
  std::uint32_t cells_;
  std::uint32_t last_;
  bool free_start_;
  std::int32_t epsilon_ = 0;
  std::uint64_t reciprocal_ = 0;  ///< of the epsilon, times 2^shift_
  unsigned shift_ = 0;
  std::vector<std::int32_t> into_;   ///< for each node, cost to the end with the price of the node
  std::vector<std::int32_t> out_;    ///< without it
  std::vector<std::uint32_t> from_;  ///< for each node, the node before, or a mark
  std::vector<std::uint32_t> next_;
  std::vector<std::uint8_t> kind_;  ///< of the walk here
  std::vector<std::uint32_t> active_;
  std::vector<std::int32_t> distance_;             ///< of the way into each node, of the way out of it, of the source
  std::vector<std::vector<std::uint32_t>> queue_;  ///< points by distance
  std::vector<std::uint64_t> open_;                ///< free cells of the first instant, a heap, the cheapest on top
  std::int32_t start_label_ = 0;                   ///< what beginning anywhere costs at most
  std::size_t waiting_ = 0;                        ///< people who have not begun
};

}  // namespace footlight::planner
