// SPDX-License-Identifier: Apache-2.0
#include "planner/schedule/beats.hpp"

#include <algorithm>
#include <cmath>

namespace footlight::planner {
namespace {

/// Instants are whole nanoseconds: what is so near to a count lies on it.
constexpr double kNearCount = 1e-6;
/// Relative rounding of a step's time, well below what `validate` tolerates.
constexpr double kRounding = 1e-9;

}  // namespace

double straight_per_step(GridKind kind) {
  if (kind == GridKind::square) return std::sqrt(0.5);
  return kind == GridKind::hexagonal ? std::sqrt(0.75) : 0.75;
}

Beats beats_between(const TempoMap& tempo, Instant from, Instant to, double least_s) {
  const double first = std::ceil(tempo.count_at(from) - kNearCount);
  const double last = std::floor(tempo.count_at(to) + kNearCount);
  double fastest_bpm = tempo.bpm_at(first);
  for (const TempoChange& change : tempo.changes()) {
    if (change.count > first && change.count < last) fastest_bpm = std::max(fastest_bpm, change.bpm);
  }
  Beats beats;
  beats.counts = std::max(1, static_cast<int>(std::ceil(least_s * fastest_bpm / 60 - kRounding)));
  beats.step_s = beats.counts * 60 / fastest_bpm;
  for (double count = first; count <= last; count += beats.counts) {
    beats.at.push_back(std::clamp(tempo.at(count), from, to));
  }
  return beats;
}

}  // namespace footlight::planner
