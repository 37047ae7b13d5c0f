// SPDX-License-Identifier: Apache-2.0
#include "planner/judge/drawing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace footlight::planner::judge {
namespace {

/// Half to even, whatever the rounding mode of the thread.
int round_half_even(double value) {
  const double down = std::floor(value);
  const double rest = value - down;
  const auto whole = static_cast<int>(down);
  if (rest != 0.5) return rest < 0.5 ? whole : whole + 1;
  return whole % 2 == 0 ? whole : whole + 1;
}

void add_up(const Mask& mask, std::vector<std::uint32_t>& sums) {
  const auto width = static_cast<std::size_t>(mask.width());
  const auto height = static_cast<std::size_t>(mask.height());
  const auto row_words = static_cast<std::size_t>(mask.row_words());
  sums.assign((width + 1) * (height + 1), 0);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint64_t* bits = mask.words().data() + y * row_words;
    const std::uint32_t* above = sums.data() + y * (width + 1) + 1;
    std::uint32_t* here = sums.data() + (y + 1) * (width + 1) + 1;
    std::uint32_t row = 0;
    for (std::size_t word = 0; word < row_words; ++word) {
      std::uint64_t rest = bits[word];
      const std::size_t last = std::min(width, 64 * (word + 1));
      for (std::size_t x = 64 * word; x < last; ++x, rest >>= 1U) {
        row += static_cast<std::uint32_t>(rest & 1U);
        here[x] = above[x] + row;
      }
    }
  }
}

/// Picture in [0, x] x [0, y], exact for a picture that is constant on each pixel.
double sum_to(const std::vector<std::uint32_t>& sums, int width, int height, double x, double y) {
  x = std::clamp(x, 0.0, static_cast<double>(width));
  y = std::clamp(y, 0.0, static_cast<double>(height));
  const int i = std::min(static_cast<int>(x), width - 1);
  const int j = std::min(static_cast<int>(y), height - 1);
  const double fx = x - i;
  const double fy = y - j;
  const std::size_t stride = static_cast<std::size_t>(width) + 1;
  const std::uint32_t* at = sums.data() + static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
  return at[0] * (1 - fx) * (1 - fy) + at[1] * fx * (1 - fy) + at[stride] * (1 - fx) * fy + at[stride + 1] * fx * fy;
}

/// Sets the bits [first, last) of a row.
void cover_row(std::uint64_t* row, int first, int last) {
  for (int x = first; x < last;) {
    const int word = x / 64;
    const int end = std::min(last, 64 * (word + 1));
    const std::uint64_t ones = ~std::uint64_t{0} >> static_cast<unsigned>(64 - (end - x));
    row[word] |= ones << (static_cast<unsigned>(x) % 64U);
    x = end;
  }
}

}  // namespace

DrawingJudge::DrawingJudge(const Grid& grid, const PlanSection& section, const Walks& walks, const Film& film)
    : placement_(*section.film), walks_(walks), film_(film), start_s_(to_seconds(section.start)) {
  const StageToFrame& m = placement_.stage_to_frame;
  side_px_ = std::sqrt(grid.cell_area_m2() * std::abs(m[0] * m[4] - m[1] * m[3]));
  is_reserve_.assign(static_cast<std::size_t>(grid.size()), 0);
  for (const CellIndex cell : section.reserve) {
    if (cell.at() < is_reserve_.size()) is_reserve_[cell.at()] = 1;
  }
  const double end_s = to_seconds(section.end);
  for (std::size_t k = 0; k < film.frames.size(); ++k) {
    if (placement_.show_fps <= 0 && k > 0) break;
    const double t = time_of(k);
    if (t >= start_s_ - 1e-9 && t <= end_s + 1e-9) frames_.push_back(k);
  }
}

double DrawingJudge::time_of(std::size_t frame) const {
  if (placement_.show_fps <= 0) return start_s_;
  const double number = film_.first_frame + static_cast<double>(frame);
  return start_s_ + (number - placement_.first_frame) / placement_.show_fps;
}

std::optional<DrawingJudge::Square> DrawingJudge::square_of(std::uint32_t person, double time_s) const {
  const std::vector<Stand>& track = walks_.track(person);
  if (track.empty()) return std::nullopt;
  const auto after = std::upper_bound(track.begin(), track.end(), time_s,
                                      [](double t, const Stand& stand) { return t < to_seconds(stand.time); });
  const Stand& from = after == track.begin() ? track.front() : *std::prev(after);
  const auto next = std::next(track.begin(), std::min(&from - track.data() + 1, std::ssize(track) - 1));
  if (is_reserve_[from.cell.at()] != 0 && is_reserve_[next->cell.at()] != 0) return std::nullopt;
  Point p = from.at;
  const double from_s = to_seconds(from.time);
  if (time_s > from_s && next->time > from.time) {
    const double way_s = to_seconds(next->time) - from_s;
    p.x += (next->at.x - from.at.x) / way_s * (time_s - from_s);
    p.y += (next->at.y - from.at.y) / way_s * (time_s - from_s);
  }
  const StageToFrame& m = placement_.stage_to_frame;
  const double x = p.x * m[0] + p.y * m[1] + m[2];
  const double y = p.x * m[3] + p.y * m[4] + m[5];
  return Square{x - side_px_ / 2, y - side_px_ / 2, x + side_px_ / 2, y + side_px_ / 2};
}

FrameJudgement DrawingJudge::judge(std::size_t frame, Scratch& scratch) const {
  const Mask& mask = film_.frames[frame];
  const int width = mask.width();
  const int height = mask.height();
  if (width == 0 || height == 0) return {};
  const double time_s = time_of(frame);
  add_up(mask, scratch.sums);
  scratch.covered.assign(mask.words().size(), 0);
  const auto row_words = static_cast<std::size_t>(mask.row_words());
  double rho_sum = 0;
  int people = 0;
  const auto sum = [&](double x, double y) { return sum_to(scratch.sums, width, height, x, y); };
  const auto pixel = [](double value, int size) {
    return round_half_even(std::clamp(value, 0.0, static_cast<double>(size)));
  };
  for (std::uint32_t i = 0; i < walks_.people(); ++i) {
    const std::optional<Square> q = square_of(i, time_s);
    if (!q) continue;
    const double rho =
        (sum(q->x1, q->y1) - sum(q->x0, q->y1) - sum(q->x1, q->y0) + sum(q->x0, q->y0)) / (side_px_ * side_px_);
    rho_sum += std::clamp(rho, 0.0, 1.0);
    ++people;
    for (int y = pixel(q->y0, height); y < pixel(q->y1, height); ++y) {
      cover_row(scratch.covered.data() + static_cast<std::size_t>(y) * row_words, pixel(q->x0, width),
                pixel(q->x1, width));
    }
  }
  std::uint64_t both = 0;
  std::uint64_t either = 0;
  for (std::size_t k = 0; k < scratch.covered.size(); ++k) {
    both += static_cast<std::uint64_t>(std::popcount(scratch.covered[k] & mask.words()[k]));
    either += static_cast<std::uint64_t>(std::popcount(scratch.covered[k] | mask.words()[k]));
  }
  const std::uint32_t area = scratch.sums.back();
  FrameJudgement out;
  if (people > 0) out.dev = 1 - rho_sum / people;
  if (area > 0) out.miss = 1 - static_cast<double>(both) / static_cast<double>(area);
  if (either > 0) out.iou = 1 - static_cast<double>(both) / static_cast<double>(either);
  return out;
}

}  // namespace footlight::planner::judge
