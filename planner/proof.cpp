// SPDX-License-Identifier: Apache-2.0
#include "planner/proof.hpp"

#include <algorithm>

#include "planner/cell_order.hpp"
#include "planner/parallel.hpp"
#include "planner/repair/closest_approach.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {
namespace {

/// As far as `tolerated_lag_s` looks.
constexpr Duration kLag = milliseconds(2000);

/// What is known of one transition; people by the order of their cells at its start.
struct Proof {
  double clearance_m = 0;
  std::uint32_t closest_a = 0;
  std::uint32_t closest_b = 0;
  double closest_share = 0;
  double longest_walk_m = 0;
  std::uint32_t longest_walker = 0;
  double tolerated_lag_s = 0;
  bool sound = true;
};

std::string encoded(const Proof& proof) {
  StageWriter out;
  out.add(proof.clearance_m).add(proof.closest_a).add(proof.closest_b).add(proof.closest_share);
  return out.add(proof.longest_walk_m).add(proof.longest_walker).add(proof.tolerated_lag_s).add(proof.sound).take();
}

Proof decoded(StageReader& reader) {
  Proof proof;
  proof.clearance_m = reader.get<double>();
  proof.closest_a = reader.get<std::uint32_t>();
  proof.closest_b = reader.get<std::uint32_t>();
  proof.closest_share = reader.get<double>();
  proof.longest_walk_m = reader.get<double>();
  proof.longest_walker = reader.get<std::uint32_t>();
  proof.tolerated_lag_s = reader.get<double>();
  proof.sound = reader.get<bool>();
  return proof;
}

/// Where the first mark at an instant or after it is in a track.
std::size_t first_mark_at(const std::vector<Mark>& track, Instant instant) {
  const auto at = std::lower_bound(track.begin(), track.end(), instant,
                                   [](const Mark& mark, Instant time) { return mark.time < time; });
  return static_cast<std::size_t>(at - track.begin());
}

/// What people do from each stop to the next, hashed once: the facts of neighbouring transitions depend on the same
/// marks. People go by the order of their cells at the stop, so that names do not matter; where they are at the end is
/// part of it, so that pieces one after the other say who does what all along.
class Pieces {
 public:
  Pieces(const Chain& chain, const Plan& plan) : chain_(chain), plan_(plan), people_(plan.tracks.size()) {
    const auto zero = [](double value) { return value == 0; };
    alike_ = std::all_of(plan.radius_m.begin(), plan.radius_m.end(), zero) &&
             std::all_of(plan.max_speed_mps.begin(), plan.max_speed_mps.end(), zero);
  }

  /// @return false when stopped
  bool hash(const Progress& progress) {
    const std::size_t stops = chain_.stops.size();
    first_.resize(stops * people_);
    keys_.resize(stops);
    return for_each_index(people_, "facts", progress, [&](std::size_t p) { find_marks(p); }) &&
           for_each_index(stops, "facts", progress, [&](std::size_t k) { keys_[k] = key_of(k); });
  }

  [[nodiscard]] const StageKey& key(std::size_t stop) const { return keys_[stop]; }
  /// Performers by the cells on which they stand at a stop.
  [[nodiscard]] std::vector<std::uint32_t> order_at(std::size_t stop) const {
    std::vector<CellIndex> cells(people_);
    for (std::size_t p = 0; p < people_; ++p) cells[p] = cell_at(stop, p);
    return order_by_cell(cells, plan_.stage.grid.size());
  }

 private:
  [[nodiscard]] CellIndex cell_at(std::size_t stop, std::size_t p) const {
    const std::vector<Mark>& track = plan_.tracks[p];
    return track[std::min<std::size_t>(first_[stop * people_ + p], track.size() - 1)].cell;
  }

  void find_marks(std::size_t p) {
    const std::vector<Mark>& track = plan_.tracks[p];
    std::uint32_t mark = 0;
    for (std::size_t k = 1; k < chain_.stops.size(); ++k) {
      while (mark < track.size() && track[mark].time < chain_.stops[k].arrive) ++mark;
      first_[k * people_ + p] = mark;
    }
  }

  [[nodiscard]] StageKey key_of(std::size_t stop) const {
    const bool last = stop + 1 == chain_.stops.size();
    const std::vector<std::uint32_t> order = order_at(stop);
    StageHash hash("piece");
    std::vector<Duration::rep> times;
    std::vector<Duration::rep> first_times;
    std::vector<CellIndex> cells;
    cells.reserve(3 * people_);
    for (std::size_t n = 0; n < people_; ++n) {
      const std::uint32_t p = order[n];
      const std::vector<Mark>& track = plan_.tracks[p];
      const std::size_t end = last ? track.size() : first_[(stop + 1) * people_ + p];
      times.clear();
      for (std::size_t m = first_[stop * people_ + p]; m < end; ++m) {
        times.push_back(track[m].time.time_since_epoch().count());
        cells.push_back(track[m].cell);
      }
      if (!last) cells.push_back(cell_at(stop + 1, p));
      if (n == 0) first_times = times;
      if (n == 0 || times != first_times) hash.add(n).list(times);
      if (!alike_) hash.add(plan_.radius_m[p]).add(plan_.max_speed_mps[p]);
    }
    hash.list(cells);
    const Instant from = chain_.stops[stop].arrive;
    for (const Formation& formation : plan_.formations) {
      if (formation.time < from || (!last && formation.time >= chain_.stops[stop + 1].arrive)) continue;
      cells.clear();
      for (const std::uint32_t p : order) cells.push_back(formation.cells[p]);
      hash.add(formation.time.time_since_epoch().count()).list(cells);
    }
    return hash.key();
  }

  const Chain& chain_;
  const Plan& plan_;
  std::size_t people_;
  bool alike_ = true;                 ///< nobody has a radius or a speed of her own
  std::vector<std::uint32_t> first_;  ///< [stop][person]: of her first mark then or later
  std::vector<StageKey> keys_;
};

class Prover {
 public:
  Prover(const Chain& chain, Plan& plan, Stages* stages, StageCount* count)
      : chain_(chain), plan_(plan), stages_(stages), count_(count), pieces_(chain, plan) {
    StageHash limits("limits");
    limits.add(plan.stage.grid.kind()).add(plan.stage.grid.columns()).add(plan.stage.grid.rows());
    limits.add(plan.stage.grid.pitch_m()).list(plan.stage.blocked);
    limits.add(plan.stage.clearance_m).add(plan.stage.max_speed_mps);
    for (const PlanSection& section : plan.sections) {
      limits.add(section.start.time_since_epoch().count()).add(section.end.time_since_epoch().count());
      limits.add(section.max_speed_mps);
      for (const PlanObstacle& obstacle : section.obstacles) {
        limits.add(obstacle.radius_m);
        for (const PlanObstacle::At& at : obstacle.at) {
          limits.add(at.time.time_since_epoch().count()).add(at.centre.x).add(at.centre.y);
        }
      }
    }
    limits_ = limits.key();
  }

  /// @return false when stopped
  bool prepare(const Progress& progress) { return pieces_.hash(progress); }

  bool prove_one(std::size_t k) {
    const Window window = window_of(k);
    const std::vector<std::uint32_t> order = pieces_.order_at(k);
    const Proof proof =
        recall(stages_, key_of(k, window), count_, decoded, encoded, [&] { return look(k, window, order); });
    TransitionFacts& facts = plan_.transitions[k];
    facts.start = chain_.stops[k].depart;
    facts.end = chain_.stops[k + 1].arrive;
    facts.clearance_m = proof.clearance_m;
    facts.closest_a = PerformerIndex(order[proof.closest_a]);
    facts.closest_b = PerformerIndex(order[proof.closest_b]);
    if (facts.closest_b < facts.closest_a) std::swap(facts.closest_a, facts.closest_b);
    facts.closest_at = facts.start + seconds(proof.closest_share * to_seconds(facts.end - facts.start));
    facts.longest_walk_m = proof.longest_walk_m;
    facts.longest_walker = PerformerIndex(proof.longest_walk_m > 0 ? order[proof.longest_walker] : 0);
    facts.tolerated_lag_s = proof.tolerated_lag_s;
    return proof.sound;
  }

 private:
  /// The marks on which a transition's facts depend.
  struct Window {
    Instant start;         ///< everybody arrives at the stop from which the transition goes
    Instant end;           ///< at the one to which it goes, or the end of the show
    Instant beyond;        ///< at least so long after it as lateness is looked at
    std::size_t last = 0;  ///< the stop at which it ends
  };

  [[nodiscard]] Window window_of(std::size_t k) const {
    const std::vector<Stop>& stops = chain_.stops;
    Window window{k == 0 ? plan_.tracks.front().front().time : stops[k].arrive, stops[k + 1].arrive, {}, k + 1};
    std::size_t& last = window.last;
    while (last + 1 < stops.size() && stops[last].arrive < stops[k + 1].arrive + kLag) ++last;
    window.beyond = last + 1 == stops.size() ? stops[last].depart : stops[last].arrive;
    if (k + 2 == stops.size()) window.end = stops.back().depart;
    return window;
  }

  [[nodiscard]] StageKey key_of(std::size_t k, const Window& window) const {
    StageHash hash("facts");
    hash.add(limits_).add(chain_.legs[k].timing.empty()).add(window.start.time_since_epoch().count());
    hash.add(window.end.time_since_epoch().count()).add(window.beyond.time_since_epoch().count());
    const bool to_the_end = window.last + 1 == chain_.stops.size();
    for (std::size_t stop = k; stop < window.last + (to_the_end ? 1 : 0); ++stop) hash.add(pieces_.key(stop));
    return hash.key();
  }

  [[nodiscard]] std::span<const Formation> formations_in(const Window& window) const {
    const auto earlier = [](const Formation& formation, Instant time) { return formation.time < time; };
    const auto first = std::lower_bound(plan_.formations.begin(), plan_.formations.end(), window.start, earlier);
    auto last = first;
    while (last != plan_.formations.end() && last->time <= window.end) ++last;
    return {first, last};
  }

  /// The marks from the window's start to `until`, people in order.
  [[nodiscard]] Plan cut(const Window& window, Instant until, const std::vector<std::uint32_t>& order) const {
    Plan piece;
    piece.stage = plan_.stage;
    piece.sections = plan_.sections;
    for (const std::uint32_t p : order) {
      const auto& track = plan_.tracks[p];
      auto first = track.begin() + static_cast<std::ptrdiff_t>(first_mark_at(track, window.start));
      auto last = first;
      while (last != track.end() && last->time <= until) ++last;
      std::vector<Mark>& own = piece.tracks.emplace_back(first, last);
      // Who came earlier or leaves later than at the cut stands there meanwhile.
      if (own.empty() || own.front().time > window.start) own.insert(own.begin(), {window.start, first->cell});
      if (own.back().time < until && last != track.end()) own.push_back({until, own.back().cell});
      piece.performers.push_back(plan_.performers[p]);
      piece.radius_m.push_back(plan_.radius_m[p]);
      piece.max_speed_mps.push_back(plan_.max_speed_mps[p]);
    }
    return piece;
  }

  [[nodiscard]] Proof look(std::size_t k, const Window& window, const std::vector<std::uint32_t>& order) const {
    Proof proof;
    Plan piece = cut(window, window.beyond, order);
    const Grid& grid = plan_.stage.grid;
    std::vector<Walk> walks;
    for (std::uint32_t n = 0; n < order.size(); ++n) {
      walks.push_back({position_at(grid, piece.tracks[n], chain_.stops[k].depart),
                       position_at(grid, piece.tracks[n], chain_.stops[k + 1].arrive)});
      const double walk_m = distance(walks.back().from, walks.back().to);
      if (walk_m <= proof.longest_walk_m) continue;
      proof.longest_walk_m = walk_m;
      proof.longest_walker = n;
    }
    if (chain_.legs[k].timing.empty()) {
      const NearPair nearest = nearest_pair(walks);
      proof.clearance_m = nearest.approach.distance_m;
      proof.closest_a = nearest.a;
      proof.closest_b = nearest.b;
      proof.closest_share = nearest.approach.share;
    } else {
      const Instant start = chain_.stops[k].depart;
      const Instant end = chain_.stops[k + 1].arrive;
      const ClosestApproach nearest = closest_approach(piece, start, end);
      proof.clearance_m = nearest.distance_m;
      proof.closest_a = nearest.a.value();
      proof.closest_b = nearest.b.value();
      proof.closest_share = to_seconds(nearest.at - start) / to_seconds(end - start);
    }
    proof.tolerated_lag_s = tolerated_lag_s(piece, chain_.stops[k].depart, chain_.stops[k + 1].arrive);
    piece = cut(window, window.end, order);
    for (const Formation& formation : formations_in(window)) {
      Formation ordered = formation;
      for (std::size_t n = 0; n < order.size(); ++n) ordered.cells[n] = formation.cells[order[n]];
      piece.formations.push_back(std::move(ordered));
    }
    proof.sound = validate(piece).valid();
    return proof;
  }

  const Chain& chain_;
  Plan& plan_;
  Stages* stages_;
  StageCount* count_;
  StageKey limits_{};
  Pieces pieces_;
};

}  // namespace

std::optional<bool> prove(const Chain& chain, Plan& plan, Stages* stages, StageCount* count, const Progress& progress) {
  plan.transitions.resize(chain.legs.size());
  if (chain.legs.empty()) return validate(plan).valid();
  Prover prover(chain, plan, stages, count);
  if (!prover.prepare(progress)) return std::nullopt;
  std::vector<char> sound(chain.legs.size(), 0);
  const bool done = for_each_index(chain.legs.size(), "facts", progress,
                                   [&](std::size_t k) { sound[k] = prover.prove_one(k) ? 1 : 0; });
  if (!done) return std::nullopt;
  return std::all_of(sound.begin(), sound.end(), [](char flag) { return flag != 0; });
}

}  // namespace footlight::planner
