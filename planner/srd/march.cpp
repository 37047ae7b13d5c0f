// SPDX-License-Identifier: Apache-2.0
#include "planner/srd/march.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"

namespace footlight::planner::srd {
namespace {

/// Way of the centre from frame to frame.
constexpr double kStep_m = 0.25;
/// Frames of a march that goes nowhere, and the most of any.
constexpr std::size_t kFewest = 16;
constexpr std::size_t kMost = 4000;

/// Places along a polyline by the length walked.
class Line {
 public:
  explicit Line(const std::vector<Point>& corners) : corners_(corners), walked_(corners.size(), 0) {
    for (std::size_t i = 1; i < corners.size(); ++i) walked_[i] = walked_[i - 1] + distance(corners[i - 1], corners[i]);
  }
  [[nodiscard]] double length_m() const { return walked_.back(); }
  [[nodiscard]] Point at(double walked_m) const {
    const auto after = std::upper_bound(walked_.begin(), walked_.end(), walked_m);
    if (after == walked_.begin()) return corners_.front();
    if (after == walked_.end()) return corners_.back();
    const auto n = static_cast<std::size_t>(after - walked_.begin());
    const double share = (walked_m - walked_[n - 1]) / (walked_[n] - walked_[n - 1]);
    return corners_[n - 1] + share * (corners_[n] - corners_[n - 1]);
  }

 private:
  const std::vector<Point>& corners_;
  std::vector<double> walked_;
};

/// Directions of the path at even distances, without jumps of a whole turn; 0 where it goes nowhere.
std::vector<double> headings(const Line& line, std::size_t frames, double corner_m) {
  std::vector<double> out(frames, 0);
  const double length_m = line.length_m();
  // A chord of no length has no direction; this one is long enough for any path that is drawn.
  const double reach_m = std::max(corner_m, 1e-3);
  for (std::size_t k = 0; k < frames && length_m > 0; ++k) {
    const double walked_m = length_m * static_cast<double>(k) / static_cast<double>(frames - 1);
    const Point chord = line.at(std::min(length_m, walked_m + reach_m)) - line.at(std::max(0.0, walked_m - reach_m));
    double angle = squared_length(chord) > 1e-12 ? std::atan2(chord.y, chord.x) : k > 0 ? out[k - 1] : 0;
    if (k > 0) angle = out[k - 1] + std::remainder(angle - out[k - 1], 2 * std::numbers::pi);
    out[k] = angle;
  }
  return out;
}

}  // namespace

Placing::Placing(const Frame& frame)
    : centre_(frame.centre),
      from_((1 - frame.share) * frame.spread * Point{std::cos(frame.turn_from), std::sin(frame.turn_from)}),
      to_(frame.share * frame.spread * Point{std::cos(frame.turn_to), std::sin(frame.turn_to)}) {}

Result<March> March::plan(const Task& task, const SrdOptions& options) {
  FL_CHECK(!task.corners.empty() && task.duration_s > 0 && task.offsets.size() == task.speed_mps.size());
  March march;
  march.corners_ = task.corners;
  march.lay_frames(options);
  FL_CHECK(task.spread.empty() || task.spread.size() == march.frames_.size());
  for (std::size_t k = 0; k < task.spread.size(); ++k) march.frames_[k].spread = task.spread[k];
  const std::vector<double> least = march.least_times(task, options);
  // At least so long from frame to frame when the whole march may take `whole_s`.
  const auto total = [&](double whole_s) {
    const double even_s = whole_s / static_cast<double>(least.size());
    double sum = 0;
    for (const double one : least) sum += std::max(one, even_s);
    return sum;
  };
  const double shortest_s = total(0);
  double whole_s = (1 - options.settle) * task.duration_s;
  if (options.group_speed_mps) {
    whole_s = march.length_m_ / *options.group_speed_mps;
  } else {
    // Evenly, and in time; without the rest for `settle` where that is needed.
    double low_s = 0;
    double high_s = whole_s;
    for (int i = 0; i < 60 && total(high_s) > whole_s; ++i) {
      const double middle_s = (low_s + high_s) / 2;
      (total(middle_s) > whole_s ? high_s : low_s) = middle_s;
      if (high_s - low_s < 1e-9) break;
    }
    whole_s = total(high_s) > whole_s ? low_s : high_s;
  }
  if (total(whole_s) > task.duration_s * (1 + 1e-9)) {
    return input_error(
        fmt::format("a group's way of {:.1f} m from ({:.1f} m, {:.1f} m) to ({:.1f} m, {:.1f} m) takes at least {:.1f} "
                    "s, and there "
                    "are {:.1f} s",
                    march.length_m_, task.corners.front().x, task.corners.front().y, task.corners.back().x,
                    task.corners.back().y, options.group_speed_mps ? total(whole_s) : shortest_s, task.duration_s));
  }
  const double even_s = whole_s / static_cast<double>(least.size());
  march.at_s_.assign(1, 0);
  for (const double one : least) march.at_s_.push_back(march.at_s_.back() + std::max(one, even_s));
  return march;
}

void March::lay_frames(const SrdOptions& options) {
  const Line line(corners_);
  length_m_ = line.length_m();
  const auto wanted = static_cast<std::size_t>(std::ceil(length_m_ / kStep_m)) + 1;
  const std::size_t frames = std::clamp(wanted, kFewest, kMost);
  std::vector<double> heading(frames, 0);
  if (options.orientation != SrdOptions::Orientation::fixed) heading = headings(line, frames, options.corner_m);
  for (std::size_t k = 0; k < frames; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(frames - 1);
    frames_.push_back({line.at(share * length_m_), heading[k] - heading.front(), heading[k] - heading.back(), share});
  }
  frames_.back().centre = corners_.back();
}

std::vector<double> March::least_times(const Task& task, const SrdOptions& options) const {
  std::vector<double> out(frames_.size() - 1, 0);
  const bool centre_alone = options.orientation == SrdOptions::Orientation::path;
  const bool level = task.floor == nullptr || task.floor->level();
  const auto ground = [&](Point at) { return level ? 1 : task.floor->speed_factor(at); };
  const double slowest_mps =
      task.speed_mps.empty() ? 1 : *std::min_element(task.speed_mps.begin(), task.speed_mps.end());
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t k) {
    const double centre_m = distance(frames_[k].centre, frames_[k + 1].centre);
    out[k] = centre_m / (kEase * slowest_mps);
    if (centre_alone && level) return;
    const Placing here(frames_[k]);
    const Placing there(frames_[k + 1]);
    for (std::size_t i = 0; i < task.offsets.size(); ++i) {
      const Point from = here(task.offsets[i]);
      const Point to = there(task.offsets[i]);
      const double moved_m = centre_alone ? centre_m : distance(from, to);
      const double pace_mps = task.speed_mps[i] * std::min(ground(from), ground(to));
      out[k] = std::max(out[k], moved_m / (kEase * pace_mps));
    }
  });
  return out;
}

double March::whole_turn(const std::vector<Point>& corners, const SrdOptions& options) {
  March march;
  march.corners_ = corners;
  march.lay_frames(options);
  return march.frames_.back().turn_from;
}

Frame March::at(double at_s) const {
  const auto after = std::upper_bound(at_s_.begin(), at_s_.end(), at_s);
  if (after == at_s_.begin()) return frames_.front();
  if (after == at_s_.end()) return frames_.back();
  const auto n = static_cast<std::size_t>(after - at_s_.begin());
  const Frame& a = frames_[n - 1];
  const Frame& b = frames_[n];
  const double share = (at_s - at_s_[n - 1]) / (at_s_[n] - at_s_[n - 1]);
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {a.centre + share * (b.centre - a.centre), mix(a.turn_from, b.turn_from), mix(a.turn_to, b.turn_to),
          mix(a.share, b.share), mix(a.spread, b.spread)};
}

}  // namespace footlight::planner::srd
