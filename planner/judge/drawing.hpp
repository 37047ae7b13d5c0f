// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/film.hpp"
#include "core/plan.hpp"
#include "planner/judge/walks.hpp"

namespace footlight::planner::judge {

/// How well one frame is drawn, shares 0..1.
struct FrameJudgement {
  std::optional<double> dev;   ///< absent when nobody is in the picture
  std::optional<double> miss;  ///< absent when the frame has no picture
  std::optional<double> iou;   ///< absent when there is neither
};

/// Judges the frames of one section's film; source: Li 2020, Eq. 8.
class DrawingJudge {
 public:
  /// @param section with a film placement; it, `walks` and `film` must outlive the judge
  DrawingJudge(const Grid& grid, const PlanSection& section, const Walks& walks, const Film& film);

  /// Positions in film.frames that fall into the section, ascending.
  [[nodiscard]] const std::vector<std::size_t>& frames() const { return frames_; }

  /// What a thread keeps from frame to frame.
  struct Scratch {
    std::vector<std::uint32_t> sums;     // (height + 1) x (width + 1), picture's pixels left of and above
    std::vector<std::uint64_t> covered;  // bits as in Mask
  };
  /// @param frame one of frames()  Complexity: O(pixels + people log marks). Thread: any, with its own scratch.
  [[nodiscard]] FrameJudgement judge(std::size_t frame, Scratch& scratch) const;

 private:
  struct Square {
    double x0, y0, x1, y1;  ///< pixels
  };
  [[nodiscard]] double time_of(std::size_t frame) const;
  [[nodiscard]] std::optional<Square> square_of(std::uint32_t person, double time_s) const;

  const FilmPlacement& placement_;
  const Walks& walks_;
  const Film& film_;
  double start_s_;
  double side_px_;
  std::vector<std::size_t> frames_;
  std::vector<char> is_reserve_;  // for each cell
};

}  // namespace footlight::planner::judge
