// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"
#include "core/motion/srd_options.hpp"
#include "core/result.hpp"
#include "planner/motion/floor.hpp"

namespace footlight::planner::srd {

/// Where a group's formation is at one time.
struct Frame {
  Point centre;          ///< P of Eq. 2-3
  double turn_from = 0;  ///< rad, of the formation of the beginning, counter-clockwise
  double turn_to = 0;    ///< rad, of the formation of the goal
  double share = 0;      ///< 0 at the beginning, 1 at the goal: how much of the change of formation is made
  double spread = 1;     ///< ranks are opened: everybody is so many times as far from the centre
};

/// One person's place in both formations, from the group's centre.
struct Offsets {
  Point from;
  Point to;
};

/// Places of a formation on the floor in one frame: both formations turned with it, and the share of each.
class Placing {
 public:
  explicit Placing(const Frame& frame);
  [[nodiscard]] Point operator()(const Offsets& offsets) const {
    return centre_ + turned(from_, offsets.from) + turned(to_, offsets.to);
  }

 private:
  static Point turned(Point turn, Point v) { return {turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y}; }

  Point centre_;
  Point from_;  ///< share and spread times cosine and sine
  Point to_;
};

/// How one group moves: the way of its centre, and when it is where. Worked out before the first step, so that a
/// formation can be asked for at any time.
class March {
 public:
  struct Task {
    std::vector<Point> corners;          ///< way of the centre, the beginning and the goal included; at least one
    std::vector<Offsets> offsets;        ///< of each person; turned as at the beginning and as at the goal
    std::vector<double> speed_mps;       ///< of each person
    double duration_s = 0;               ///< > 0
    std::vector<double> spread{};        ///< of each frame; empty: 1
    const MotionFloor* floor = nullptr;  ///< whose ground slows people down; nothing: level ground
  };

  /// The centre walks along its corners at an even speed omega (Eq. 3, which it follows exactly: the group does not
  /// wait for who is held up by others), and more slowly where a person's place would else move faster than kEase of
  /// her speed on the ground where it is (from frame to frame): for `path` only the centre's way counts, for `wheel`
  /// and `fixed` everybody's.
  /// @return ErrorKind::input when the goal cannot be reached in time. O(people x length / kStep_m)
  [[nodiscard]] static Result<March> plan(const Task& task, const SrdOptions& options);

  /// How far a formation has turned at the goal that keeps its face along the way, rad; 0 where it does not.
  [[nodiscard]] static double whole_turn(const std::vector<Point>& corners, const SrdOptions& options);

  /// @param at_s clamped to the march  O(log frames)
  [[nodiscard]] Frame at(double at_s) const;
  [[nodiscard]] double arrives_s() const { return at_s_.back(); }
  [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }  ///< at least two
  [[nodiscard]] const std::vector<double>& times_s() const { return at_s_; }  ///< of each frame, ascending
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] const std::vector<Point>& corners() const { return corners_; }

 private:
  void lay_frames(const SrdOptions& options);
  [[nodiscard]] std::vector<double> least_times(const Task& task, const SrdOptions& options) const;

  std::vector<Point> corners_;
  double length_m_ = 0;
  std::vector<Frame> frames_;
  std::vector<double> at_s_;  ///< of each frame, ascending
};

/// People walk their formation's way at no more than this share of their speed, so that who was held up can catch up.
inline constexpr double kEase = 0.85;

}  // namespace footlight::planner::srd
