// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/approach.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "planner/judge/geometry.hpp"
#include "planner/judge/near_pairs.hpp"

namespace footlight::planner::judge {
namespace {

bool earlier(const NearestPair& x, const NearestPair& y) { return std::tie(x.at, x.a, x.b) < std::tie(y.at, y.a, y.b); }

/// The instants at which walks are cut: start, every mark instant between, end.
std::vector<Instant> cuts_of(const Walks& walks, Instant start, Instant end) {
  std::vector<Instant> cuts{start};
  const auto& times = walks.times();
  for (auto t = std::upper_bound(times.begin(), times.end(), start); t != times.end() && *t < end; ++t) {
    cuts.push_back(*t);
  }
  cuts.push_back(end);
  return cuts;
}

/// Neighbouring stretches that are judged together, as indices of cuts: a stretch of its own where many people have
/// marks, several stretches where only a few do, so that the work follows the number of marks.
struct Slab {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<Slab> slabs_of(const Walks& walks, const std::vector<Instant>& cuts) {
  std::vector<Slab> out;
  const auto& times = walks.times();
  std::size_t at = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), cuts.front()) - times.begin());
  std::size_t first = 0;
  std::uint64_t marks = 0;
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    marks += at < times.size() && times[at] == cuts[k] ? walks.marks_at()[at++] : 0;
    if (2 * marks < walks.people() && k + 1 < cuts.size()) continue;
    out.push_back({first, k});
    first = k;
    marks = 0;
  }
  return out;
}

/// What a thread keeps from slab to slab.
struct Scratch {
  NearPairs near;
  std::vector<MovingDisc> discs;    // what each person covers in the slab, half of what has to be seen around her
  std::vector<std::size_t> before;  // each person's last stand at the slab's start
  std::vector<Point> from;          // where each person is at the slab's start
  std::vector<Point> to;            // and at its end
  std::vector<char> straight;       // no mark inside of the slab
};

class SlabJudge {
 public:
  SlabJudge(const Plan& plan, const Walks& walks, std::span<const Instant> cuts, std::size_t keep, Scratch& scratch)
      : plan_(plan), walks_(walks), cuts_(cuts), keep_(keep), start_(cuts.front()), end_(cuts.back()), s_(scratch) {}

  Approaches run(double seen_m) {
    place_people();
    s_.discs.resize(walks_.people());
    for (std::uint32_t i = 0; i < walks_.people(); ++i) {
      s_.discs[i] = disc(i);
      if (walks_.track(i).empty()) continue;
      s_.discs[i].radius_m += std::max(seen_m, 1.5 * std::max(plan_.stage.clearance_m, 2 * plan_.radius_m[i])) / 2;
    }
    for (const auto& [a, b] : s_.near.find(s_.discs)) judge_pair(a, b);
    if (out_.first.size() > keep_) trim();
    std::sort(out_.first.begin(), out_.first.end(), earlier);
    return std::move(out_);
  }

 private:
  void place_people() {
    const std::uint32_t people = walks_.people();
    s_.before.resize(people);
    s_.from.resize(people);
    s_.to.resize(people);
    s_.straight.resize(people);
    for (std::uint32_t i = 0; i < people; ++i) {
      const std::vector<Stand>& track = walks_.track(i);
      s_.straight[i] = 1;
      if (track.empty()) continue;
      s_.before[i] = walks_.stand_before(i, start_);
      std::size_t last = s_.before[i];
      while (last + 1 < track.size() && track[last + 1].time < end_) ++last;
      // A first mark inside of the slab ends a wait that has no mark at its start.
      s_.straight[i] = last == s_.before[i] && track[last].time <= start_ ? 1 : 0;
      s_.from[i] = walks_.position(i, s_.before[i], start_);
      s_.to[i] = walks_.position(i, last, end_);
    }
  }

  /// A point that goes along with who walks straight; who has marks inside of the slab is in a disc that stands still.
  [[nodiscard]] MovingDisc disc(std::uint32_t person) const {
    const std::vector<Stand>& track = walks_.track(person);
    if (track.empty()) return {{}, {}, -1};
    if (s_.straight[person] != 0) return {s_.from[person], s_.to[person], 0};
    Box box;
    box.add(s_.from[person]);
    box.add(s_.to[person]);
    for (std::size_t k = s_.before[person]; k < track.size() && track[k].time < end_; ++k) {
      if (track[k].time > start_) box.add(track[k].at);
    }
    const Point low{box.x0, box.y0};
    const Point middle = low + 0.5 * (Point{box.x1, box.y1} - low);
    return {middle, middle, distance(low, middle)};
  }

  void judge_pair(std::uint32_t a, std::uint32_t b) {
    if (s_.straight[a] != 0 && s_.straight[b] != 0) {
      judge_piece(a, b, {start_, end_, s_.from[a] - s_.from[b], s_.to[a] - s_.to[b]});
      return;
    }
    std::size_t before_a = s_.before[a];
    std::size_t before_b = s_.before[b];
    Piece piece{start_, start_, {}, s_.from[a] - s_.from[b]};
    do {
      const Instant next = std::min({end_, next_mark(a, before_a, piece.end), next_mark(b, before_b, piece.end)});
      piece.start = piece.end;
      piece.d0 = piece.d1;
      piece.end = next;
      before_a = forward(a, before_a, next);
      before_b = forward(b, before_b, next);
      piece.d1 = walks_.position(a, before_a, next) - walks_.position(b, before_b, next);
      judge_piece(a, b, piece);
    } while (piece.end < end_);
  }

  [[nodiscard]] Instant next_mark(std::uint32_t person, std::size_t before, Instant now) const {
    const std::vector<Stand>& track = walks_.track(person);
    if (track[before].time > now) return track[before].time;
    return before + 1 < track.size() ? track[before + 1].time : kNever;
  }
  [[nodiscard]] std::size_t forward(std::uint32_t person, std::size_t before, Instant to) const {
    const std::vector<Stand>& track = walks_.track(person);
    return before + 1 < track.size() && track[before + 1].time <= to ? before + 1 : before;
  }

  /// A stretch of time in which both walk straight; their difference at its ends.
  struct Piece {
    Instant start;
    Instant end;
    Point d0;
    Point d1;
    [[nodiscard]] Point at(Instant time) const {
      if (time == start) return d0;
      if (time == end) return d1;
      return d0 + (to_seconds(time - start) / to_seconds(end - start)) * (d1 - d0);
    }
  };
  [[nodiscard]] static Instant instant_in(Instant start, Instant end, double share) {
    const Instant at = start + Duration(std::llround(share * static_cast<double>((end - start).count())));
    return std::clamp(at, start, end);
  }

  void judge_piece(std::uint32_t a, std::uint32_t b, const Piece& piece) {
    const Nearest nearest = nearest_to_origin(piece.d0, piece.d1);
    const double best = out_.nearest.distance_m;
    if (nearest.squared_m2 <= best * best) {
      const NearestPair found{std::sqrt(nearest.squared_m2), instant_in(piece.start, piece.end, nearest.share), a, b};
      if (found.distance_m < best || (found.distance_m == best && earlier(found, out_.nearest))) out_.nearest = found;
    }
    const double limit = least_distance_m(plan_, a, b) - kClearanceTolerance_m;
    if (limit <= 0 || nearest.squared_m2 >= limit * limit) return;
    count_too_close(a, b, piece, nearest, limit);
  }

  void count_too_close(std::uint32_t a, std::uint32_t b, const Piece& piece, const Nearest& nearest, double limit_m) {
    const Instant at = instant_in(piece.start, piece.end, nearest.share);
    out_.too_close += stretches_too_close(piece, at, limit_m);
    out_.first.push_back({std::sqrt(nearest.squared_m2), at, a, b});
    if (out_.first.size() >= 4 * keep_ + 64) trim();
  }

  /// How many stretches between neighbouring mark instants, whoever's marks they are, hold a moment that is too near.
  /// The distance falls until `at` and rises after it, so these are neighbours, found by bisection on both sides.
  [[nodiscard]] std::uint64_t stretches_too_close(const Piece& piece, Instant at, double limit_m) const {
    const auto near = [&](Instant time) { return squared_length(piece.at(time)) < limit_m * limit_m; };
    const auto first = std::upper_bound(cuts_.begin(), cuts_.end(), piece.start);  // cuts inside of the piece
    const auto last = std::lower_bound(first, cuts_.end(), piece.end);
    const auto middle = std::lower_bound(first, last, at);
    const auto first_near = std::partition_point(first, middle, [&](Instant cut) { return !near(cut); });
    const auto last_near = std::partition_point(middle, last, near);
    // Where the closest approach is a cut itself, the stretches on both of its sides hold it.
    return 1 + static_cast<std::uint64_t>(last_near - first_near);
  }
  void trim() {
    const auto nth = out_.first.begin() + static_cast<std::ptrdiff_t>(std::min(keep_, out_.first.size()));
    std::nth_element(out_.first.begin(), nth, out_.first.end(), earlier);
    out_.first.erase(nth, out_.first.end());
  }

  const Plan& plan_;
  const Walks& walks_;
  std::span<const Instant> cuts_;  // of this slab
  std::size_t keep_;
  Instant start_;
  Instant end_;
  Scratch& s_;
  Approaches out_;
};

Approaches judge_all(const Plan& plan, const Walks& walks, const std::vector<Instant>& cuts,
                     const std::vector<Slab>& slabs, double seen_m, std::size_t keep) {
  std::vector<Approaches> parts(slabs.size());
  tbb::enumerable_thread_specific<Scratch> scratch;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slabs.size()), [&](const auto& range) {
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      const auto own = std::span(cuts).subspan(slabs[k].first, slabs[k].last - slabs[k].first + 1);
      parts[k] = SlabJudge(plan, walks, own, keep, scratch.local()).run(seen_m);
    }
  });
  Approaches out;
  for (Approaches& part : parts) {
    if (part.nearest.distance_m < out.nearest.distance_m) out.nearest = part.nearest;
    out.too_close += part.too_close;
    out.first.insert(out.first.end(), part.first.begin(), part.first.end());
  }
  std::stable_sort(out.first.begin(), out.first.end(), earlier);
  if (out.first.size() > keep) out.first.resize(keep);
  return out;
}

}  // namespace

Approaches find_approaches(const Plan& plan, const Walks& walks, Instant start, Instant end, std::size_t keep) {
  std::uint32_t people = 0;
  for (std::uint32_t i = 0; i < walks.people(); ++i) people += walks.track(i).empty() ? 0 : 1;
  if (people < 2 || end < start) return {};
  const std::vector<Instant> cuts = cuts_of(walks, start, end);
  const std::vector<Slab> slabs = slabs_of(walks, cuts);
  // What is seen is at least neighbours who stand still; in a thin crowd the view is widened until it holds a pair.
  const Grid& grid = plan.stage.grid;
  const double widest_m = 4 * grid.pitch_m() * (grid.columns() + grid.rows());
  double seen_m = std::max(1.5 * plan.stage.clearance_m, 1.001 * grid.pitch_m());
  Approaches out = judge_all(plan, walks, cuts, slabs, seen_m, keep);
  while (out.nearest.distance_m > seen_m && seen_m < widest_m) {
    seen_m *= 2;
    out.nearest = judge_all(plan, walks, cuts, slabs, seen_m, keep).nearest;
  }
  return out;
}

}  // namespace footlight::planner::judge
