// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace footlight::planner {

Blocks::Blocks(const Ways& ways, const CellFlags& reserve, int factor)
    : ways_(ways), grid_(ways.grid()), factor_(factor), side_m_(factor * grid_.pitch_m()) {
  const auto cells = static_cast<std::size_t>(grid_.size());
  block_of_.resize(cells);
  if (factor == 1) {
    for (std::size_t c = 0; c < cells; ++c) {
      block_of_[c] = static_cast<std::uint32_t>(c);
      centres_.push_back(grid_.centre(CellIndex::of(c)));
      stands_on_.push_back(CellIndex::of(c));
    }
    usable_ = ways.standable();
    waits_ = reserve;
    return;
  }
  double right_m = -std::numeric_limits<double>::infinity();
  double back_m = right_m;
  left_m_ = front_m_ = -right_m;
  for (std::size_t c = 0; c < cells; ++c) {
    const Point at = grid_.centre(CellIndex::of(c));
    left_m_ = std::min(left_m_, at.x - grid_.pitch_m() / 2);
    front_m_ = std::min(front_m_, at.y - grid_.pitch_m() / 2);
    right_m = std::max(right_m, at.x);
    back_m = std::max(back_m, at.y);
  }
  columns_ = static_cast<int>(std::floor((right_m - left_m_) / side_m_)) + 1;
  rows_ = static_cast<int>(std::floor((back_m - front_m_) / side_m_)) + 1;
  const std::size_t blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      centres_.push_back({left_m_ + (column + 0.5) * side_m_, front_m_ + (row + 0.5) * side_m_});
    }
  }
  cells_each_ = static_cast<double>(cells) / static_cast<double>(blocks);
  std::vector<int> stand(blocks, 0);
  std::vector<int> wait(blocks, 0);
  stands_on_.assign(blocks, CellIndex(0));
  std::vector<double> nearest(blocks, std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < cells; ++c) {
    const Point at = grid_.centre(CellIndex::of(c));
    const int column = std::min(columns_ - 1, static_cast<int>((at.x - left_m_) / side_m_));
    const int row = std::min(rows_ - 1, static_cast<int>((at.y - front_m_) / side_m_));
    const std::size_t block =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    block_of_[c] = static_cast<std::uint32_t>(block);
    if (!ways.can_stand(CellIndex::of(c))) continue;
    ++stand[block];
    wait[block] += reserve[c] != 0 ? 1 : 0;
    const double away_m = distance(at, centres_[block]);
    if (away_m >= nearest[block]) continue;
    nearest[block] = away_m;
    stands_on_[block] = CellIndex::of(c);
  }
  usable_.assign(blocks, 0);
  waits_.assign(blocks, 0);
  for (std::size_t b = 0; b < blocks; ++b) {
    usable_[b] = stand[b] > 0 && 2 * stand[b] >= cells_each_ ? 1 : 0;
    waits_[b] = 2 * wait[b] > stand[b] ? 1 : 0;
  }
}

std::vector<float> Blocks::at_cells(const std::vector<float>& of_blocks) const {
  if (factor_ == 1) return of_blocks;
  std::vector<float> out(block_of_.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    const Point at = grid_.centre(CellIndex::of(c));
    const double x = (at.x - left_m_) / side_m_ - 0.5;
    const double y = (at.y - front_m_) / side_m_ - 0.5;
    const double column = std::floor(x);
    const double row = std::floor(y);
    const auto value = [&](double i, double j) {
      const int p = std::clamp(static_cast<int>(i), 0, columns_ - 1);
      const int q = std::clamp(static_cast<int>(j), 0, rows_ - 1);
      return static_cast<double>(
          of_blocks[static_cast<std::size_t>(q) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(p)]);
    };
    const double u = x - column;
    const double v = y - row;
    out[c] = static_cast<float>((1 - v) * ((1 - u) * value(column, row) + u * value(column + 1, row)) +
                                v * ((1 - u) * value(column, row + 1) + u * value(column + 1, row + 1)));
  }
  return out;
}

std::vector<std::uint32_t> Blocks::near(std::uint32_t block, double reach_m) const {
  std::vector<std::uint32_t> out;
  if (factor_ == 1) {
    for (const CellIndex cell : grid_.within(centres_[block], reach_m)) out.push_back(cell.value());
    return out;
  }
  const int column = static_cast<int>(block) % columns_;
  const int row = static_cast<int>(block) / columns_;
  const int far = static_cast<int>(reach_m / side_m_);
  for (int y = std::max(0, row - far); y <= std::min(rows_ - 1, row + far); ++y) {
    for (int x = std::max(0, column - far); x <= std::min(columns_ - 1, column + far); ++x) {
      out.push_back(static_cast<std::uint32_t>(y * columns_ + x));
    }
  }
  return out;
}

Reach Blocks::reach(double reach_m) {
  if (factor_ > 1) reach_m = std::max(reach_m, side_m_ * 1.001);
  Reach reach;
  reach.first.push_back(0);
  for (std::uint32_t from = 0; from < size(); ++from) {
    if (usable_[from] != 0) {
      for (const std::uint32_t to : near(from, reach_m)) {
        const double length_m = distance(centres_[from], centres_[to]);
        if (usable_[to] == 0 || length_m > reach_m) continue;
        if (!ways_.straight(grid_.centre(stands_on_[from]), grid_.centre(stands_on_[to]))) continue;
        reach.to.push_back(to);
        const Border border = waits_[from] == waits_[to] ? kWithin : waits_[from] != 0 ? kOut : kIn;
        reach.kind.push_back(kind_of(length_m, border));
      }
    }
    reach.first.push_back(static_cast<std::uint32_t>(reach.to.size()));
  }
  for (std::size_t kind = 0; kind < reach.mirror.size(); ++kind) {
    constexpr std::uint8_t kMirror[kBorders] = {kWithin, kIn, kOut};
    reach.mirror[kind] = static_cast<std::uint8_t>(kind - kind % kBorders + kMirror[kind % kBorders]);
  }
  return reach;
}

/// Lengths are told apart to a thousandth of a pitch.
std::uint8_t Blocks::kind_of(double length_m, Border border) {
  const double length = length_m / grid_.pitch_m();
  const auto [known, is_new] = lengths_.try_emplace(std::llround(1000 * length), lengths_.size());
  if (is_new) squares_.push_back(length * length);
  FL_CHECK(kBorders * known->second + border < 256);
  return static_cast<std::uint8_t>(kBorders * known->second + border);
}

}  // namespace footlight::planner
