// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/time_flow.hpp"

#include <algorithm>
#include <functional>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

/// Bids between two looks at whether the user wants to stop.
constexpr std::size_t kBidsPerLook = 65536;
/// Bids a node between two times that all labels are raised, and nodes that are filled for each that they are lowered.
constexpr std::size_t kBidsPerRaise = 2;
constexpr std::size_t kFillsPerLowering = 4;

}  // namespace

TimeFlowSolver::TimeFlowSolver(const FlowTask& task)
    : task_(task),
      cells_(static_cast<std::uint32_t>(task.cells)),
      last_(static_cast<std::uint32_t>(task.intervals.size())),
      free_start_(task.start.empty()),
      into_(task.cells * (task.intervals.size() + 1)),
      out_(into_.size()),
      from_(into_.size(), kEmpty),
      next_(into_.size(), kNone),
      kind_(into_.size(), 0) {
  FL_CHECK(!task.intervals.empty() && (free_start_ || task.start.size() == task.people));
}

bool TimeFlowSolver::refine(std::int32_t epsilon, const Progress& progress) {
  FL_CHECK(task_.stand.size() == into_.size() && epsilon > 0);
  epsilon_ = epsilon;
  set_steps();
  look_back();
  const std::size_t pause = kBidsPerRaise * from_.size();
  for (std::size_t n = 0; enter(); ++n) {
    if (n % kBidsPerLook == 0 && progress.stopped()) return false;
    const std::uint32_t at = active_.back();
    active_.pop_back();
    bid(at);
    if (n % pause == pause - 1) raise_labels();
  }
  return fill_all(progress);
}

bool TimeFlowSolver::fill_all(const Progress& progress) {
  for (std::uint32_t v = 0; v < from_.size(); ++v) {
    if (from_[v] == kUnfilled) active_.push_back(v);
  }
  const std::size_t pause = from_.size() / kFillsPerLowering + 1;
  for (std::size_t n = 0; !active_.empty(); ++n) {
    if (n % kBidsPerLook == 0 && progress.stopped()) return false;
    if (n % pause == 0) lower_labels();
    const std::uint32_t at = active_.back();
    active_.pop_back();
    fill(at);
  }
  return true;
}

std::vector<std::int32_t> TimeFlowSolver::prices() const {
  std::vector<std::int32_t> out(into_.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    if (from_[v] != kEmpty && (v >= cells_ || free_start_)) out[v] = std::max(0, into_[v] - out_[v]);
  }
  return out;
}

void TimeFlowSolver::start_from(const std::vector<std::int32_t>& prices) {
  FL_CHECK(prices.size() == into_.size());
  into_ = prices;
  std::fill(out_.begin(), out_.end(), 0);
  std::fill(from_.begin(), from_.end(), kUnfilled);
}

bool TimeFlowSolver::can_stand(std::uint32_t k, std::uint32_t cell) const {
  const Reach& reach = *task_.intervals[std::min(k, last_ - 1)].reach;
  return reach.first[cell] != reach.first[cell + 1];
}

/// Labels that agree with the costs and the prices. Whoever stands where a price is asked is kept there, her walks are
/// forgotten: she is active, and the node waits for somebody to come.
void TimeFlowSolver::look_back() {
  active_.clear();
  for (std::uint32_t v = 0; v < from_.size(); ++v) into_[v] -= out_[v];  // the price
  for (std::uint32_t k = last_ + 1; k-- > 0;) {
    for (std::uint32_t c = 0; c < cells_; ++c) {
      const std::uint32_t v = node(k, c);
      out_[v] = k == last_ ? task_.stand[v] : onward(v).best;
      const bool kept = from_[v] != kEmpty && into_[v] > 0 && (k > 0 || free_start_) && can_stand(k, c);
      from_[v] = kept ? kUnfilled : kEmpty;
      next_[v] = kNone;
      into_[v] = out_[v] + (kept ? into_[v] : 0);
      if (kept && k < last_) active_.push_back(v);
    }
  }
  waiting_ = 0;
  if (!free_start_) {
    for (const CellIndex cell : task_.start) {
      from_[cell.at()] = kSource;
      active_.push_back(cell.value());
    }
    return;
  }
  offer_starts();
  waiting_ = task_.people;
  start_label_ = -kFar;
}

/// @return whether somebody is left to bid; who has not begun begins when nobody else is
bool TimeFlowSolver::enter() {
  while (active_.empty() && waiting_ > 0) begin_somewhere();
  return !active_.empty();
}

void TimeFlowSolver::offer_starts() {
  open_.clear();
  for (std::uint32_t c = 0; c < cells_; ++c) {
    if (out_[c] < kFar / 2 && from_[c] != kSource) offer_start(c);
  }
}

void TimeFlowSolver::offer_start(std::uint32_t cell) {
  open_.push_back((static_cast<std::uint64_t>(into_[cell] + kFar) << 32U) | cell);
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

void TimeFlowSolver::begin_somewhere() {
  FL_CHECK(!open_.empty());
  std::pop_heap(open_.begin(), open_.end(), std::greater<>());
  const auto cell = static_cast<std::uint32_t>(open_.back() & 0xFFFFFFFFU);
  const auto label = static_cast<std::int32_t>(open_.back() >> 32U) - kFar;
  open_.pop_back();
  if (from_[cell] == kSource) return;
  if (into_[cell] > label) return offer_start(cell);
  start_label_ = std::max(start_label_, label);
  --waiting_;
  if (from_[cell] == kEmpty) active_.push_back(cell);
  from_[cell] = kSource;
}

TimeFlowSolver::Offer TimeFlowSolver::onward(std::uint32_t at) const {
  const std::uint32_t k = at / cells_;
  const FlowInterval& interval = task_.intervals[k];
  const Reach& reach = *interval.reach;
  const std::uint32_t c = at - k * cells_;
  const std::int32_t* into = into_.data() + node(k + 1, 0);
  const std::uint32_t* to = reach.to.data();
  const std::uint8_t* kind = reach.kind.data();
  // Costs with the numbers of the walks behind them: the two least are found without a branch.
  constexpr std::int64_t kNothing = std::int64_t{kFar} << 32U;
  std::int64_t best = kNothing;
  std::int64_t second = kNothing;
  for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
    const std::int64_t cost = (std::int64_t{interval.cost[kind[a]] + into[to[a]]} << 32U) | a;
    second = std::min(second, std::max(best, cost));
    best = std::min(best, cost);
  }
  Offer offer{static_cast<std::int32_t>(best >> 32U), static_cast<std::int32_t>(second >> 32U), 0, 0};
  if (offer.best == kFar) return offer;
  const auto best_walk = static_cast<std::uint32_t>(best & 0xFFFFFFFF);
  offer.node = node(k + 1, to[best_walk]);
  offer.kind = kind[best_walk];
  offer.best += task_.stand[at];
  if (offer.second < kFar) offer.second += task_.stand[at];
  return offer;
}

/// Somebody who stands at a node chooses where to go next, or gives the node up.
void TimeFlowSolver::bid(std::uint32_t at) {
  if (!is_bidder(at)) return;
  const Offer offer = onward(at);
  std::int32_t back = kFar;
  if (is_node(from_[at])) {
    back = out_[from_[at]] - task_.stand[from_[at]] - walk_to(at);
  } else if (from_[at] == kUnfilled) {
    back = into_[at];
  } else if (free_start_) {
    back = start_label_;
  }
  out_[at] = offer.best;
  if (offer.best > back + epsilon_) {
    into_[at] = offer.best;
    return leave(at);
  }
  const std::uint32_t to = offer.node;
  const std::uint32_t before = from_[to];
  if (is_node(before)) {
    const std::int32_t raise = std::min(offer.second, std::max(back, offer.best)) - offer.best + epsilon_;
    into_[to] += raise;
    out_[at] += raise;
    next_[before] = kNone;
    active_.push_back(before);
  } else if (before == kEmpty) {
    active_.push_back(to);
  }
  next_[at] = to;
  from_[to] = at;
  kind_[to] = offer.kind;
}

void TimeFlowSolver::leave(std::uint32_t at) {
  const std::uint32_t before = from_[at];
  from_[at] = kEmpty;
  if (is_node(before)) {
    next_[before] = kNone;
    active_.push_back(before);
  } else if (before == kSource) {
    offer_start(at);
    ++waiting_;
  }
}

TimeFlowSolver::Offer TimeFlowSolver::backward(std::uint32_t at) const {
  const std::uint32_t k = at / cells_ - 1;
  const FlowInterval& interval = task_.intervals[k];
  const Reach& reach = *interval.reach;
  const std::uint32_t c = at - (k + 1) * cells_;
  Offer offer{-kFar, -kFar, kNone, 0};
  for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
    const std::uint32_t u = node(k, reach.to[a]);
    if (k == 0 && !free_start_ && from_[u] != kSource) continue;
    const std::uint8_t kind = reach.mirror[reach.kind[a]];
    const std::int32_t worth = out_[u] - task_.stand[u] - interval.cost[kind];
    if (worth > offer.best) {
      offer = {worth, offer.best, u, kind};
    } else {
      offer.second = std::max(offer.second, worth);
    }
  }
  return offer;
}

/// A node that nobody came to gets cheaper until somebody comes, or whoever is kept there leaves it.
void TimeFlowSolver::fill(std::uint32_t at) {
  if (from_[at] != kUnfilled) return;
  const std::int32_t worth = task_.stand[at] + (next_[at] == kNone ? 0 : walk_to(next_[at]) + into_[next_[at]]);
  if (at < cells_) return fill_start(at, worth);
  const Offer offer = backward(at);
  if (offer.best < worth - epsilon_) return give_up(at, offer.best);
  const std::uint32_t from = offer.node;
  into_[at] = offer.best;
  if (from_[from] == kEmpty) {
    from_[from] = kUnfilled;
    into_[from] = out_[from];
    active_.push_back(from);
  } else {
    const std::int32_t fall = offer.best - std::max(offer.second, std::min(worth, offer.best)) + epsilon_;
    into_[at] -= fall;
    out_[from] -= fall;
    from_[next_[from]] = kUnfilled;
    active_.push_back(next_[from]);
  }
  next_[from] = at;
  from_[at] = from;
  kind_[at] = offer.kind;
}

/// Whoever began where it is dearest begins here instead.
void TimeFlowSolver::fill_start(std::uint32_t at, std::int32_t worth) {
  std::uint32_t dearest = kNone;
  for (std::uint32_t u = 0; u < cells_; ++u) {
    if (from_[u] == kSource && (dearest == kNone || into_[u] > into_[dearest])) dearest = u;
  }
  if (into_[dearest] < worth - epsilon_) return give_up(at, into_[dearest]);
  into_[at] = std::min(into_[at], into_[dearest] - epsilon_);
  from_[at] = kSource;
  from_[dearest] = kUnfilled;
  active_.push_back(dearest);
}

void TimeFlowSolver::give_up(std::uint32_t at, std::int32_t label) {
  from_[at] = kEmpty;
  into_[at] = out_[at] = label;
  if (next_[at] == kNone) return;
  from_[next_[at]] = kUnfilled;
  active_.push_back(next_[at]);
  next_[at] = kNone;
}

std::vector<std::uint32_t> TimeFlowSolver::starts() const {
  std::vector<std::uint32_t> nodes;
  for (const CellIndex cell : task_.start) nodes.push_back(cell.value());
  if (!free_start_) return nodes;
  for (std::uint32_t c = 0; c < cells_; ++c) {
    if (from_[c] == kSource) nodes.push_back(c);
  }
  return nodes;
}

TimeFlow TimeFlowSolver::result() const {
  TimeFlow flow;
  flow.at.resize(last_ + 1);
  std::vector<std::uint32_t> now = starts();
  FL_CHECK(now.size() == task_.people);
  for (std::uint32_t k = 0; k <= last_; ++k) {
    for (std::uint32_t& v : now) {
      flow.at[k].push_back(CellIndex(v - k * cells_));
      flow.cost += task_.stand[v];
      if (k == last_) continue;
      FL_CHECK(next_[v] != kNone);
      v = next_[v];
      flow.cost += walk_to(v);
    }
  }
  flow.bound = bound();
  return flow;
}

/// What everybody would pay on the cheapest way at these prices, less the prices: labels are worked out anew.
std::int64_t TimeFlowSolver::bound() const {
  std::int64_t value = 0;
  std::vector<std::int32_t> behind(cells_, 0);
  std::vector<std::int32_t> here(cells_);
  for (std::uint32_t k = last_ + 1; k-- > 0;) {
    for (std::uint32_t c = 0; c < cells_; ++c) {
      const std::uint32_t v = node(k, c);
      std::int32_t best = k == last_ ? 0 : kFar;
      if (k < last_) {
        const FlowInterval& interval = task_.intervals[k];
        const Reach& reach = *interval.reach;
        for (std::uint32_t a = reach.first[c]; a < reach.first[c + 1]; ++a) {
          best = std::min(best, interval.cost[reach.kind[a]] + behind[reach.to[a]]);
        }
      }
      const bool priced = from_[v] != kEmpty && (k > 0 || free_start_);
      const std::int32_t price = priced ? std::max(0, into_[v] - out_[v]) : 0;
      here[c] = best == kFar ? kFar : best + task_.stand[v] + price;
      value -= price;
    }
    std::swap(here, behind);
  }
  if (!free_start_) {
    for (const CellIndex cell : task_.start) value += behind[cell.at()];
    return value;
  }
  std::nth_element(behind.begin(), behind.begin() + static_cast<std::ptrdiff_t>(task_.people - 1), behind.end());
  for (std::size_t i = 0; i < task_.people; ++i) value += behind[i];
  return value;
}

}  // namespace footlight::planner
