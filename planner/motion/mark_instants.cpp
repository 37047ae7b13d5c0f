// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/mark_instants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "planner/motion/snap_crowd.hpp"
#include "planner/schedule/beats.hpp"
#include "planner/schedule/pace.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kSameCount = 1e-9;
/// Marks are as near in time as people can follow a way in every direction at this share of their speed.
constexpr double kFollowed = 0.7;
/// Between spare marks people can walk at least so many pitches.
constexpr double kSparePitches = 2;
/// A way that leaves the straight line between two marks by more is given a spare one, pitches.
constexpr double kStraight = 1;

/// Tempo where counts are shortest.
double fastest_bpm(const MarkTask& task) {
  double bpm = task.tempo->bpm_at(task.start_count);
  for (const TempoChange& change : task.tempo->changes()) {
    const bool within = change.count > task.start_count && change.count < task.start_count + task.duration_counts;
    if (within) bpm = std::max(bpm, change.bpm);
  }
  return bpm;
}

double walked_m(const MarkTask& task, double from_count, double to_count) {
  const Instant from = task.tempo->at(from_count);
  const Instant to = task.tempo->at(to_count);
  if (task.walk == WalkKind::straight) return std::max(0.0, task.speed_mps * to_seconds(to - from) - kRounding_m);
  const int steps = beats_between(*task.tempo, from, to, task.grid->pitch_m() / task.speed_mps).steps();
  return steps * straight_per_step(task.grid->kind()) * task.grid->pitch_m();
}

/// In whole counts.
double usual_spacing(const MarkTask& task) {
  const double count_s = 60 / fastest_bpm(task);
  double counts = 1;
  for (; counts < task.duration_counts; ++counts) {
    const double walk_m = task.walk == WalkKind::straight ? task.speed_mps * counts * count_s
                                                          : walked_m(task, task.start_count, task.start_count + counts);
    if (followed_share(*task.grid, walk_m) >= kFollowed) break;
  }
  return counts;
}

}  // namespace

double least_mark_counts(const MarkTask& task) {
  return task.grid->pitch_m() / task.speed_mps * fastest_bpm(task) / 60;
}

MarkInstants mark_instants(const MarkTask& task) {
  MarkInstants out;
  out.spacing_counts = std::min(task.duration_counts, task.spacing_counts.value_or(usual_spacing(task)));
  double fine_counts = out.spacing_counts;
  const double count_m = task.speed_mps * 60 / fastest_bpm(task);
  while (task.spacing_counts && fine_counts / 2 * count_m >= kSparePitches * task.grid->pitch_m()) fine_counts /= 2;
  const int parts = static_cast<int>(std::lround(out.spacing_counts / fine_counts));
  const int whole = std::max(1, static_cast<int>(std::floor(task.duration_counts / fine_counts + kSameCount)));
  for (int n = 0; n <= whole; ++n) {
    const bool last = n == whole;
    out.count.push_back(task.start_count + (last ? task.duration_counts : n * fine_counts));
    // The last interval that is no shorter than the spacing takes what is left over.
    out.spare.push_back(!last && (n % parts != 0 || whole - n < parts) ? 1 : 0);
  }
  out.spare.front() = 0;
  for (const double count : out.count) {
    out.at_s.push_back(to_seconds(task.tempo->at(count) - task.tempo->at(task.start_count)));
  }
  double share = 1;
  double last_m = -1;
  out.followed_mps = task.speed_mps;
  for (std::size_t k = 0; k + 1 < out.count.size(); ++k) {
    const double walk_m = walked_m(task, out.count[k], out.count[k + 1]);
    out.longest_m.push_back(walk_m);
    if (walk_m <= 0) continue;  // no step falls into it
    if (std::abs(walk_m - last_m) > kRounding_m) {
      share = std::min(followed_share(*task.grid, walk_m), paced_m(walk_m, task.grid->pitch_m()) / walk_m);
      last_m = walk_m;
    }
    out.followed_mps = std::min(out.followed_mps, share * walk_m / (out.at_s[k + 1] - out.at_s[k]));
  }
  return out;
}

void MarkInstants::thin(std::vector<std::vector<Point>>& at, const Ways& ways) {
  const double most_m = kStraight * ways.grid().pitch_m();
  const auto straight = [&](std::size_t first, std::size_t last) {
    for (std::size_t p = 0; p < at[first].size(); ++p) {
      if (!ways.straight(at[first][p], at[last][p])) return false;
      for (std::size_t k = first + 1; k < last; ++k) {
        const double share = (at_s[k] - at_s[first]) / (at_s[last] - at_s[first]);
        if (distance(at[k][p], at[first][p] + share * (at[last][p] - at[first][p])) > most_m) return false;
      }
    }
    return true;
  };
  std::vector<std::size_t> kept{0};
  for (std::size_t next = 1; next < count.size(); ++next) {
    if (spare[next] != 0) continue;
    // Halved until what lies between is straight.
    std::vector<std::size_t> ends{next};
    while (!ends.empty()) {
      const std::size_t first = kept.back();
      const std::size_t middle = first + (ends.back() - first) / 2;
      if (middle == first || straight(first, ends.back())) {
        kept.push_back(ends.back());
        ends.pop_back();
      } else {
        ends.push_back(middle);
      }
    }
  }
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const std::size_t k = kept[n];
    if (n + 1 < kept.size()) {
      double sum_m = 0;
      for (std::size_t j = k; j < kept[n + 1]; ++j) sum_m += longest_m[j];
      longest_m[n] = sum_m;
    }
    count[n] = count[k];
    at_s[n] = at_s[k];
    if (n != k) at[n] = std::move(at[k]);
  }
  count.resize(kept.size());
  at_s.resize(kept.size());
  at.resize(kept.size());
  longest_m.resize(kept.size() - 1);
  spare.assign(kept.size(), 0);
}

}  // namespace footlight::planner
