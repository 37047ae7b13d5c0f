// SPDX-License-Identifier: Apache-2.0
#include "planner/mutual_information.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr double kStands_mps = 1e-3;
constexpr double kRounding = 1e-9;
constexpr double kMostBins = 4096;  ///< across a floor; grids have no more cells

std::uint16_t class_of(double place, double classes) {
  return static_cast<std::uint16_t>(std::clamp(std::floor(place + kRounding), 0.0, classes - 1));
}

}  // namespace

double mutual_information_bits(std::span<const std::uint16_t> first, std::span<const std::uint16_t> second) {
  FL_CHECK(first.size() == second.size());
  if (first.empty()) return 0;
  const std::size_t rows = std::size_t{*std::max_element(first.begin(), first.end())} + 1;
  const std::size_t columns = std::size_t{*std::max_element(second.begin(), second.end())} + 1;
  std::vector<std::uint32_t> both(rows * columns, 0);
  std::vector<std::uint32_t> row(rows, 0);
  std::vector<std::uint32_t> column(columns, 0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ++both[first[i] * columns + second[i]];
    ++row[first[i]];
    ++column[second[i]];
  }
  const double people = static_cast<double>(first.size());
  double bits = 0;
  for (std::size_t a = 0; a < rows; ++a) {
    for (std::size_t b = 0; b < columns; ++b) {
      const double together = both[a * columns + b];
      if (together > 0) bits += together / people * std::log2(together * people / (double(row[a]) * column[b]));
    }
  }
  return bits;
}

std::uint16_t InformationClasses::bin(double offset_m) const { return class_of(offset_m / bin_m, kMostBins); }

std::uint16_t InformationClasses::sector(Point velocity) const {
  double turn = std::atan2(velocity.y, velocity.x) / (2 * std::numbers::pi);
  if (turn < -kRounding) turn += 1;
  return class_of(turn * sectors, sectors);
}

std::uint16_t InformationClasses::pace(double speed_mps) const {
  return class_of(fastest_mps > 0 ? speed_mps / fastest_mps * sectors : 0, sectors);
}

PlaceInformation place_information(std::span<const Point> position, std::span<const Point> velocity,
                                   const InformationClasses& classes) {
  FL_CHECK(position.size() == velocity.size());
  std::vector<std::uint16_t> across;
  std::vector<std::uint16_t> up;
  std::vector<std::uint16_t> sector;
  std::vector<std::uint16_t> pace;
  for (std::size_t p = 0; p < position.size(); ++p) {
    const double speed = length(velocity[p]);
    if (speed < kStands_mps) continue;
    across.push_back(classes.bin(position[p].x - classes.low.x));
    up.push_back(classes.bin(position[p].y - classes.low.y));
    sector.push_back(classes.sector(velocity[p]));
    pace.push_back(classes.pace(speed));
  }
  if (across.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone, 0};
  }
  return {(mutual_information_bits(across, sector) + mutual_information_bits(up, sector)) / 2,
          (mutual_information_bits(across, pace) + mutual_information_bits(up, pace)) / 2,
          static_cast<std::uint32_t>(across.size())};
}

}  // namespace footlight::planner
