// SPDX-License-Identifier: Apache-2.0
#include "planner/formation/cell_shares.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "planner/cpu_clones.hpp"
#include "planner/formation/grid_lines.hpp"
#include "planner/formation/summed_area.hpp"

namespace footlight::planner {
namespace {

FOOTLIGHT_CPU_CLONES
std::int64_t count_bits(const std::uint64_t* words, std::size_t count) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::popcount(words[i]);
  return sum;
}

/// Adds rows of bits to counters: digit k of pixel x is bit x % 64 of digits[k * words + x / 64].
/// @param carry `words` of room
FOOTLIGHT_CPU_CLONES
void add_rows(const std::uint64_t* row, std::size_t words, int rows, std::uint64_t* digits, std::uint64_t* carry) {
  for (int r = 0; r < rows; ++r, row += words) {
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < words; ++w) any |= row[w];
    if (any == 0) continue;
    for (std::size_t w = 0; w < words; ++w) carry[w] = row[w];
    const int used = std::bit_width(static_cast<unsigned>(r + 1));
    for (int k = 0; k < used; ++k) {
      std::uint64_t* digit = digits + static_cast<std::size_t>(k) * words;
      for (std::size_t w = 0; w < words; ++w) {
        const std::uint64_t both = digit[w] & carry[w];
        digit[w] ^= carry[w];
        carry[w] = both;
      }
    }
  }
}

/// Rows of bits with their weights, and how many bits are set before each word.
struct Band {
  const std::uint64_t* bits;    // rows x words
  const std::uint32_t* before;  // rows x words
  const double* weight;         // rows
  int rows;
  std::size_t words;
};

FOOTLIGHT_CPU_CLONES
void count_before(const std::uint64_t* bits, std::size_t words, std::uint32_t* before) {
  std::uint32_t sum = 0;
  for (std::size_t w = 0; w < words; ++w) {
    before[w] = sum;
    sum += static_cast<std::uint32_t>(std::popcount(bits[w]));
  }
}

/// Picture left of each of some places, in pixels.  @param at  ascending, in [0, 64 words)
FOOTLIGHT_CPU_CLONES
void picture_left_of(const Band& band, const double* at, std::size_t count, double* sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto pixel = static_cast<std::size_t>(at[i]);
    const double part = at[i] - static_cast<double>(pixel);
    const std::size_t w = pixel / 64;
    const std::uint64_t lower = (std::uint64_t{1} << (pixel % 64)) - 1;
    double sum = 0;
    for (int r = 0; r < band.rows; ++r) {
      const std::size_t word = static_cast<std::size_t>(r) * band.words + w;
      const std::uint64_t bits = band.bits[word];
      const auto whole = static_cast<int>(band.before[word]) + std::popcount(bits & lower);
      sum += band.weight[r] * (whole + part * static_cast<int>((bits >> (pixel % 64)) & 1U));
    }
    sums[i] = sum;
  }
}

/// One frame on one grid.
class Shares {
 public:
  Shares(const Mask& mask, const Grid& grid, const StageToFrame& map)
      : mask_(mask),
        grid_(grid),
        map_(map),
        side_(std::sqrt(grid.cell_area_m2()) * std::sqrt(std::abs(map[0] * map[4]))),
        row_words_(static_cast<std::size_t>(mask.row_words())),
        words_(row_words_ + 1),
        shares_(static_cast<std::size_t>(grid.size()), 0.0) {}

  std::vector<double> run() {
    if (mask_.width() == 0 || mask_.height() == 0) return std::move(shares_);
    for (const GridLine& line : lines_of(grid_)) {
      const double y = map_[4] * line.y_m + map_[5];
      const double top = std::clamp(y - side_ / 2, 0.0, static_cast<double>(mask_.height()));
      const double bottom = std::clamp(y + side_ / 2, 0.0, static_cast<double>(mask_.height()));
      if (bottom > top && fill_band(top, bottom)) measure(line);
    }
    return std::move(shares_);
  }

 private:
  /// Adds up the pixel rows of [top, bottom).  @return false where there is no picture in them
  bool fill_band(double top, double bottom) {
    const int first = static_cast<int>(top);
    const int last = std::min(static_cast<int>(bottom), mask_.height() - 1);
    const int whole = static_cast<int>(std::ceil(top));  // rows [whole, last) are covered from edge to edge
    const int full = std::max(0, last - whole);
    const int digits = std::bit_width(static_cast<unsigned>(full));
    weight_.clear();
    bits_.assign(static_cast<std::size_t>(digits + 2) * words_, 0);
    if (full > 0) add_full(whole, full, digits);
    for (int k = 0; k < digits; ++k) weight_.push_back(static_cast<double>(1U << static_cast<unsigned>(k)));
    if (first == last) {
      add_part(first, bottom - top);
    } else {
      if (whole > first) add_part(first, whole - top);
      if (bottom > last) add_part(last, bottom - last);
    }
    return find_ends();
  }

  void add_full(int row, int rows, int digits) {
    // The rows of the mask have no word of room at their ends: counters of their width first.
    digits_.assign(static_cast<std::size_t>(digits) * row_words_, 0);
    carry_.resize(row_words_);
    add_rows(row_of(row), row_words_, rows, digits_.data(), carry_.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(digits); ++k) {
      std::copy_n(digits_.data() + k * row_words_, row_words_, bits_.data() + k * words_);
    }
  }
  void add_part(int row, double weight) {
    std::copy_n(row_of(row), row_words_, bits_.data() + weight_.size() * words_);
    weight_.push_back(weight);
  }
  [[nodiscard]] const std::uint64_t* row_of(int row) const {
    return mask_.words().data() + static_cast<std::size_t>(row) * row_words_;
  }

  /// The first and the last word with picture.
  bool find_ends() {
    first_word_ = words_;
    last_word_ = 0;
    for (std::size_t r = 0; r < weight_.size(); ++r) {
      for (std::size_t w = 0; w < row_words_; ++w) {
        if (bits_[r * words_ + w] == 0) continue;
        first_word_ = std::min(first_word_, w);
        last_word_ = std::max(last_word_, w);
      }
    }
    return first_word_ <= last_word_;
  }

  void measure(const GridLine& line) {
    before_.resize(weight_.size() * words_);
    for (std::size_t r = 0; r < weight_.size(); ++r) {
      count_before(bits_.data() + r * words_, words_, before_.data() + r * words_);
    }
    const double step = map_[0] * line.step_m;
    const double left = map_[0] * line.x_m + map_[2] - side_ / 2;
    const double picture_from = 64.0 * static_cast<double>(first_word_);
    const double picture_to = std::min<double>(mask_.width(), 64.0 * static_cast<double>(last_word_ + 1));
    const double cells = line.count;
    const int from = static_cast<int>(std::clamp(std::floor((picture_from - left - side_) / step), 0.0, cells));
    const int to = std::max(from, static_cast<int>(std::clamp(std::ceil((picture_to - left) / step), 0.0, cells)));
    if (from == to) return;
    // Squares lie edge to edge, so that one cell's end is the next one's start.
    const bool shared = std::abs(step - side_) < 1e-9 * side_;
    const auto edge = [&](double x) { edges_.push_back(std::clamp(x, 0.0, static_cast<double>(mask_.width()))); };
    edges_.clear();
    for (int k = from; k < to; ++k) {
      edge(left + k * step);
      if (!shared || k + 1 == to) edge(left + k * step + side_);
    }
    sums_.resize(edges_.size());
    picture_left_of({bits_.data(), before_.data(), weight_.data(), static_cast<int>(weight_.size()), words_},
                    edges_.data(), edges_.size(), sums_.data());
    const double millionths = 1e6 / (side_ * side_);
    for (int k = from; k < to; ++k) {
      const std::size_t at = static_cast<std::size_t>(k - from) * (shared ? 1 : 2);
      // Six digits: what is equal but for the last bits must compare equal, and noise is no picture.
      const double area = std::floor((sums_[at + 1] - sums_[at]) * millionths + 0.5);
      if (area > 0) shares_[line.cell(k).at()] = std::min(area / 1e6, 1.0);
    }
  }

  const Mask& mask_;
  const Grid& grid_;
  const StageToFrame& map_;
  double side_;  ///< of the square of one cell's area, pixels
  std::size_t row_words_;
  std::size_t words_;  ///< of a row here: one of room, so that the right edge has a word, too
  std::vector<double> shares_;
  std::vector<std::uint64_t> digits_;
  std::vector<std::uint64_t> carry_;
  std::vector<std::uint64_t> bits_;
  std::vector<double> weight_;
  std::vector<std::uint32_t> before_;
  std::size_t first_word_ = 0;
  std::size_t last_word_ = 0;
  std::vector<double> edges_;
  std::vector<double> sums_;
};

}  // namespace

std::int64_t picture_area(const Mask& mask) { return count_bits(mask.words().data(), mask.words().size()); }

std::vector<double> cell_shares(const Mask& mask, const Grid& grid, const StageToFrame& map) {
  if (map[1] != 0 || map[3] != 0 || !(map[0] > 0)) return cell_shares(SummedArea(mask), grid, map);
  return Shares(mask, grid, map).run();
}

}  // namespace footlight::planner
