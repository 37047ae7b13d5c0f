// SPDX-License-Identifier: Apache-2.0
#include "planner/repair/tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/check.hpp"
#include "planner/repair/lateness.hpp"
#include "planner/repair/room.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// People are exchanged with those whose targets are so near, and targets moved so far, pitches.
constexpr double kNear = 2.3;
/// Pairs that nothing helped are tried again when others have changed.
constexpr int kPasses = 3;
/// Where more than this share of the people is in pairs too near when punctual, waits do not bring them apart.
constexpr double kMostWaiting = 0.125;
constexpr std::uint32_t kNone = 0xFFFFFFFFU;
constexpr int kNever = std::numeric_limits<int>::max() / 4;

/// Walks in square buckets by their middles: two people can come near each other only if the middles of their walks
/// are no further apart than the reach and half of both walks.
class Middles {
 public:
  void fill(const std::vector<Walk>& walks, double side_m) {
    side_m_ = side_m;
    Point high = low_ = middle(walks.front());
    for (const Walk& walk : walks) {
      const Point m = middle(walk);
      low_ = {std::min(low_.x, m.x), std::min(low_.y, m.y)};
      high = {std::max(high.x, m.x), std::max(high.y, m.y)};
    }
    columns_ = static_cast<int>((high.x - low_.x) / side_m_) + 1;
    rows_ = static_cast<int>((high.y - low_.y) / side_m_) + 1;
    people_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
    for (std::uint32_t i = 0; i < walks.size(); ++i) add(i, walks[i]);
  }
  void add(std::uint32_t person, const Walk& walk) { people_[bucket(walk)].push_back(person); }
  void remove(std::uint32_t person, const Walk& walk) {
    auto& here = people_[bucket(walk)];
    here.erase(std::find(here.begin(), here.end(), person));
  }
  /// Calls visit(person) for everybody whose middle lies within `reach_m` of the walk's, and some more, until it
  /// returns false.
  template <class Visit>
  void visit_around(const Walk& walk, double reach_m, Visit visit) const {
    const Point m = middle(walk);
    const int left = column(m.x - reach_m);
    const int right = column(m.x + reach_m);
    const int last = row(m.y + reach_m);
    for (int r = row(m.y - reach_m); r <= last; ++r) {
      for (int c = left; c <= right; ++c) {
        for (const std::uint32_t person : people_[static_cast<std::size_t>(r * columns_ + c)]) {
          if (!visit(person)) return;
        }
      }
    }
  }

 private:
  static Point middle(const Walk& walk) { return 0.5 * (walk.from + walk.to); }
  // Walks change: who leaves the floor of the buckets is kept in the nearest one, and looked for there.
  [[nodiscard]] int column(double x) const { return clamped((x - low_.x) / side_m_, columns_); }
  [[nodiscard]] int row(double y) const { return clamped((y - low_.y) / side_m_, rows_); }
  [[nodiscard]] static int clamped(double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size - 1)));
  }
  [[nodiscard]] std::size_t bucket(const Walk& walk) const {
    const Point m = middle(walk);
    return static_cast<std::size_t>(row(m.y) * columns_ + column(m.x));
  }

  double side_m_ = 1;
  Point low_;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::vector<std::uint32_t>> people_;
};

class Loosener {
 public:
  Loosener(const ToleranceTask& task, std::vector<CellIndex>& to, std::vector<std::uint32_t>& target_of)
      : task_(task),
        grid_(*task.grid),
        to_(to),
        target_of_(target_of),
        room_(task.clearance_m, task.radius_m, task.grid->pitch_m()),
        limit_m_(room_.widest_m() - kRounding_m) {
    walks_.reserve(task.from.size());
    for (std::size_t i = 0; i < task.from.size(); ++i) {
      walks_.push_back({grid_.centre(task.from[i]), grid_.centre(to[target_of[i]])});
      longest_m_ = std::max(longest_m_, length_m(walks_.back()));
    }
    for (const Walk& walk : walks_) done_.walks.push_back({walk});
  }

  Tolerance run() {
    std::vector<Pair> open;
    for (const NearPair& pair : near_pairs(walks_, limit_m_ + task_.late_share * longest_m_)) {
      if (weight(pair.a, done_.walks[pair.a], pair.b, done_.walks[pair.b]) > 0) open.emplace_back(pair.a, pair.b);
    }
    if (!open.empty()) prepare();
    const auto punctual = std::count_if(open.begin(), open.end(), [&](const Pair& pair) {
      return weight(pair.first, done_.walks[pair.first], pair.second, done_.walks[pair.second]) == kPunctual;
    });
    may_wait_ = static_cast<double>(punctual) <= kMostWaiting * static_cast<double>(walks_.size()) + 8;
    for (int pass = 0; pass < kPasses && !open.empty(); ++pass) {
      changed_.clear();
      for (const Pair& pair : open) {
        if (task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed)) break;
        solve(pair);
      }
      if (changed_.empty()) break;
      open = still_open(open);
    }
    done_.left = std::move(open);
    done_.waits = static_cast<int>(std::count_if(done_.walks.begin(), done_.walks.end(), waits));
    return std::move(done_);
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  /// Pairs too near when punctual weigh more than any number of others that a change touches.
  static constexpr int kPunctual = 1000;

  [[nodiscard]] static double length_m(const Walk& walk) { return distance(walk.from, walk.to); }
  [[nodiscard]] static bool waits(const TimedWalk& timed) { return timed.start > 0 || timed.end < 1; }

  /// Of two people on these walks.
  [[nodiscard]] int weight(std::uint32_t one, const TimedWalk& a, std::uint32_t other, const TimedWalk& b) const {
    const double least_m = room_.between_m(one, other) - kRounding_m;
    const double least = least_m * least_m;
    if (least_squared_when_late_m2(a, b, task_.late_share) >= least) return 0;
    return least_squared_when_late_m2(a, b, 0) < least ? kPunctual : 1;
  }

  /// Of these pairs and the pairs of everybody whose walk has changed those that are too near, ascending.
  [[nodiscard]] std::vector<Pair> still_open(const std::vector<Pair>& before) const {
    std::vector<Pair> open;
    for (const auto& [a, b] : before) {
      if (weight(a, done_.walks[a], b, done_.walks[b]) > 0) open.emplace_back(a, b);
    }
    for (const std::uint32_t person : changed_) {
      visit_troubles(person, done_.walks[person], kNone, [&](std::uint32_t other, int) {
        open.emplace_back(std::min(person, other), std::max(person, other));
        return true;
      });
    }
    std::sort(open.begin(), open.end());
    open.erase(std::unique(open.begin(), open.end()), open.end());
    return open;
  }

  void prepare() {
    middles_.fill(walks_, std::max(2 * grid_.pitch_m(), longest_m_ / 2));
    half_m_.resize(walks_.size());
    for (std::size_t i = 0; i < walks_.size(); ++i) half_m_[i] = length_m(walks_[i]) / 2;
    target_at_.assign(static_cast<std::size_t>(grid_.size()), kNone);
    person_of_.resize(to_.size());
    for (std::uint32_t j = 0; j < to_.size(); ++j) target_at_[to_[j].at()] = j;
    for (std::uint32_t i = 0; i < target_of_.size(); ++i) person_of_[target_of_[i]] = i;
  }

  /// Calls visit(other, weight) for everybody but `except` who comes too near this walk, until it returns false.
  template <class Visit>
  void visit_troubles(std::uint32_t person, const TimedWalk& timed, std::uint32_t except, Visit visit) const {
    const double reach_m = limit_m_ + 0.5 * length_m(timed.walk);
    const Point middle = 0.5 * (timed.walk.from + timed.walk.to);
    middles_.visit_around(timed.walk, reach_m + 0.5 * longest_m_, [&](std::uint32_t other) {
      const Walk& its = walks_[other];
      const Point apart = 0.5 * (its.from + its.to) - middle;
      const double most_m = reach_m + half_m_[other];
      if (squared_length(apart) >= most_m * most_m || other == person || other == except) return true;
      const int found = weight(person, timed, other, done_.walks[other]);
      return found == 0 || visit(other, found);
    });
  }

  /// The weight of all pairs of somebody on this walk; stops counting at `enough`.
  [[nodiscard]] int trouble(std::uint32_t person, const TimedWalk& timed, std::uint32_t except, int enough) const {
    int sum = 0;
    visit_troubles(person, timed, except, [&](std::uint32_t, int found) {
      sum += found;
      return sum < enough;
    });
    return sum;
  }

  /// A change of the walks of one or two people.
  struct Change {
    std::uint32_t a = kNone;
    std::uint32_t b = kNone;  ///< exchanges targets with a; kNone: nobody
    CellIndex cell;           ///< a's target, where nobody exchanges
    double start = 0;         ///< of a's walk
    double end = 1;
    int gain = 0;           ///< weight of the pairs that it solves
    double other_wait = 0;  ///< b does not exchange, but leaves later by this share of the time
  };

  void solve(Pair pair) {
    const int now = weight(pair.first, done_.walks[pair.first], pair.second, done_.walks[pair.second]);
    if (now == 0) return;
    best_.reset();
    for (const bool entirely : {true, false}) {
      entirely_ = entirely;
      if (try_exchange(pair.first, pair.second)) break;
      if (try_targets_near(pair.first) || try_targets_near(pair.second)) break;
      if (try_waits(pair.first, now) || try_waits(pair.second, now)) break;
      if (try_one_after_the_other(pair.first, pair.second)) break;
      if (try_one_after_the_other(pair.second, pair.first)) break;
      if (try_moves(pair.first) || try_moves(pair.second)) break;
    }
    if (best_) apply(*best_);
  }

  // The `try_` functions return true when the search is over: a change that leaves no trouble at all was found. Where
  // there is none, the one that saves most is kept.
  bool try_targets_near(std::uint32_t person) {
    for (const CellIndex cell : cells_near(walks_[person].to)) {
      const std::uint32_t target = target_at_[cell.at()];
      if (target != kNone && person_of_[target] != person && try_exchange(person, person_of_[target])) return true;
    }
    return false;
  }

  bool try_moves(std::uint32_t person) {
    if (task_.free.empty()) return false;
    if (!task_.fixed_target.empty() && task_.fixed_target[target_of_[person]] != 0) return false;
    for (const CellIndex cell : cells_near(walks_[person].to)) {
      if (try_move(person, cell)) return true;
    }
    const Point way = walks_[person].to - walks_[person].from;
    for (const double share : {0.6, 0.3, 0.0}) {
      if (try_move(person, grid_.nearest(walks_[person].from + share * way))) return true;
    }
    return false;
  }

  /// Waits before, after, or on both sides of the walk. A short wait is enough to be tolerant; two whose ways cross
  /// need any that there is time for.
  bool try_waits(std::uint32_t person, int now) {
    const double step = task_.stagger_share;
    const int longest = std::min(most_waits(person), now < kPunctual ? 2 : kNever);
    for (int wait = 1; wait <= longest; wait += std::max(1, wait / 2)) {
      for (int before = wait; before >= 0; before -= std::max(1, wait / 4)) {
        const Change change{person, kNone, to_[target_of_[person]], before * step, 1 - (wait - before) * step, 0};
        if (change.end > change.start && try_alone(change)) return true;
      }
    }
    return false;
  }

  /// How many steps somebody can wait and still walk at the limit of speed.
  [[nodiscard]] int most_waits(std::uint32_t person) const {
    if (!may_wait_ || task_.stagger_share <= 0 || length_m(walks_[person]) == 0) return 0;
    const double slack = 1 - length_m(walks_[person]) / task_.longest_m;
    return static_cast<int>(std::floor(std::min(slack, 0.95) / task_.stagger_share + 1e-9));
  }

  /// The first is there as early as the second leaves late.
  bool try_one_after_the_other(std::uint32_t first, std::uint32_t second) {
    const int most_first = most_waits(first);
    const int most_second = most_waits(second);
    for (int wait = 1; wait <= std::max(most_first, most_second) && std::min(most_first, most_second) > 0;
         wait += std::max(1, wait / 2)) {
      const double early = std::min(wait, most_first) * task_.stagger_share;
      const double late = std::min(wait, most_second) * task_.stagger_share;
      const TimedWalk one{walks_[first], 0, 1 - early};
      const TimedWalk two{walks_[second], late, 1};
      const int now = entirely_ ? 1 : trouble_of(first, second);
      const int most = now - (best_ ? best_->gain : 0);
      int after = weight(first, one, second, two);
      if (after < most) after += trouble(first, one, second, most - after);
      if (after < most) after += trouble(second, two, first, most - after);
      if (keep({first, second, to_[target_of_[first]], 0, 1 - early, now - after, late}, after, most)) return true;
    }
    return false;
  }

  /// Of two people as they walk now, their own pair counted once.
  [[nodiscard]] int trouble_of(std::uint32_t a, std::uint32_t b) const {
    return trouble(a, done_.walks[a], b, kNever) + trouble(b, done_.walks[b], a, kNever) +
           weight(a, done_.walks[a], b, done_.walks[b]);
  }

  [[nodiscard]] std::vector<CellIndex> cells_near(Point at) const {
    std::vector<CellIndex> cells = grid_.within(at, kNear * grid_.pitch_m());
    std::stable_sort(cells.begin(), cells.end(), [&](CellIndex p, CellIndex q) {
      return std::llround(1e6 * squared_length(grid_.centre(p) - at)) <
             std::llround(1e6 * squared_length(grid_.centre(q) - at));
    });
    return cells;
  }

  bool try_exchange(std::uint32_t a, std::uint32_t b) {
    if (!task_.kind.empty() && task_.kind[a] != task_.kind[b]) return false;
    const TimedWalk one{{walks_[a].from, walks_[b].to}};
    const TimedWalk two{{walks_[b].from, walks_[a].to}};
    if (!(*task_.may_walk)(one.walk.from, one.walk.to) || !(*task_.may_walk)(two.walk.from, two.walk.to)) return false;
    const int now = entirely_ ? 1 : trouble_of(a, b);
    const int most = now - (best_ ? best_->gain : 0);
    int after = weight(a, one, b, two);
    if (after < most) after += trouble(a, one, b, most - after);
    if (after < most) after += trouble(b, two, a, most - after);
    return keep({a, b, {}, 0, 1, now - after}, after, most);
  }

  bool try_move(std::uint32_t person, CellIndex cell) {
    if (target_at_[cell.at()] != kNone || task_.free[cell.at()] == 0) return false;
    if (!(*task_.may_walk)(walks_[person].from, grid_.centre(cell))) return false;
    return try_alone({person, kNone, cell, 0, 1, 0});
  }

  bool try_alone(Change change) {
    const TimedWalk timed{{walks_[change.a].from, grid_.centre(change.cell)}, change.start, change.end};
    const int now = entirely_ ? 1 : trouble(change.a, done_.walks[change.a], kNone, kNever);
    const int most = now - (best_ ? best_->gain : 0);
    const int after = most > 0 ? trouble(change.a, timed, kNone, most) : 0;
    change.gain = now - after;
    return keep(change, after, most);
  }

  bool keep(const Change& change, int after, int most) {
    if (after >= most) return false;
    best_ = change;
    return entirely_;
  }

  void apply(const Change& change) {
    if (change.other_wait > 0) {
      walk_to(change.b, change.other_wait, 1);
    } else if (change.b != kNone) {
      std::swap(target_of_[change.a], target_of_[change.b]);
      person_of_[target_of_[change.a]] = change.a;
      person_of_[target_of_[change.b]] = change.b;
      walk_to(change.b, 0, 1);
      ++done_.exchanges;
    } else if (change.cell != to_[target_of_[change.a]]) {
      target_at_[to_[target_of_[change.a]].at()] = kNone;
      to_[target_of_[change.a]] = change.cell;
      target_at_[change.cell.at()] = target_of_[change.a];
      ++done_.moved;
    }
    walk_to(change.a, change.start, change.end);
  }

  void walk_to(std::uint32_t person, double start, double end) {
    Walk& walk = walks_[person];
    middles_.remove(person, walk);
    walk.to = grid_.centre(to_[target_of_[person]]);
    middles_.add(person, walk);
    half_m_[person] = length_m(walk) / 2;
    longest_m_ = std::max(longest_m_, length_m(walk));
    done_.walks[person] = {walk, start, end};
    changed_.push_back(person);
  }

  const ToleranceTask& task_;
  const Grid& grid_;
  std::vector<CellIndex>& to_;
  std::vector<std::uint32_t>& target_of_;
  Room room_;
  double limit_m_;  ///< of any two people
  double longest_m_ = 0;
  std::vector<Walk> walks_;
  std::vector<double> half_m_;
  Middles middles_;
  std::vector<std::uint32_t> target_at_;  ///< cell -> position in to_
  std::vector<std::uint32_t> person_of_;  ///< position in to_ -> position in from
  std::vector<std::uint32_t> changed_;    ///< in this pass
  std::optional<Change> best_;
  bool may_wait_ = true;
  bool entirely_ = true;  ///< only changes that leave no trouble
  Tolerance done_;
};

}  // namespace

Tolerance keep_apart_when_late(const ToleranceTask& task, std::vector<CellIndex>& to,
                               std::vector<std::uint32_t>& target_of) {
  FL_CHECK(task.from.size() == to.size() && target_of.size() == to.size());
  FL_CHECK(task.late_share >= 0 && task.late_share <= 1);
  if (to.empty()) return {};
  return Loosener(task, to, target_of).run();
}

}  // namespace footlight::planner
