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
  return static_cast<std::uint16_t>(std::clamp(place + kRounding, 0.0, classes - 1));
}

/// How often each class of one kind is met with each of another.
class Together {
 public:
  Together(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), both_(rows * columns, 0) {}
  void add(std::uint16_t first, std::uint16_t second) { ++both_[first * columns_ + second]; }
  [[nodiscard]] double bits() const {
    std::vector<std::uint32_t> row(rows_, 0);
    std::vector<std::uint32_t> column(columns_, 0);
    double people = 0;
    for (std::size_t a = 0; a < rows_; ++a) {
      for (std::size_t b = 0; b < columns_; ++b) {
        row[a] += both_[a * columns_ + b];
        column[b] += both_[a * columns_ + b];
      }
      people += row[a];
    }
    double bits = 0;
    for (std::size_t a = 0; a < rows_; ++a) {
      for (std::size_t b = 0; b < columns_; ++b) {
        const double together = both_[a * columns_ + b];
        if (together > 0) bits += together / people * std::log2(together * people / (double(row[a]) * column[b]));
      }
    }
    return bits;
  }

 private:
  std::size_t rows_;
  std::size_t columns_;
  std::vector<std::uint32_t> both_;
};

}  // namespace

double mutual_information_bits(std::span<const std::uint16_t> first, std::span<const std::uint16_t> second) {
  FL_CHECK(first.size() == second.size());
  if (first.empty()) return 0;
  Together both(std::size_t{*std::max_element(first.begin(), first.end())} + 1,
                std::size_t{*std::max_element(second.begin(), second.end())} + 1);
  for (std::size_t i = 0; i < first.size(); ++i) both.add(first[i], second[i]);
  return both.bits();
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

WalkClasses walk_classes(Point position, Point velocity, const InformationClasses& classes) {
  WalkClasses out{classes.bin(position.x - classes.low.x), classes.bin(position.y - classes.low.y)};
  const double speed_mps = length(velocity);
  if (speed_mps < kStands_mps) return out;
  out.sector = classes.sector(velocity);
  out.pace = classes.pace(speed_mps);
  return out;
}

PlaceInformation place_information(std::span<const WalkClasses> people) {
  WalkClasses most{0, 0, 0, 0};
  std::uint32_t moving = 0;
  for (const WalkClasses& one : people) {
    if (one.sector == WalkClasses::kStands) continue;
    ++moving;
    most = {std::max(most.across, one.across), std::max(most.up, one.up), std::max(most.sector, one.sector),
            std::max(most.pace, one.pace)};
  }
  if (moving == 0) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone, 0};
  }
  const auto classes = [](std::uint16_t last) { return std::size_t{last} + 1; };
  Together across_sector(classes(most.across), classes(most.sector));
  Together up_sector(classes(most.up), classes(most.sector));
  Together across_pace(classes(most.across), classes(most.pace));
  Together up_pace(classes(most.up), classes(most.pace));
  for (const WalkClasses& one : people) {
    if (one.sector == WalkClasses::kStands) continue;
    across_sector.add(one.across, one.sector);
    up_sector.add(one.up, one.sector);
    across_pace.add(one.across, one.pace);
    up_pace.add(one.up, one.pace);
  }
  return {(across_sector.bits() + up_sector.bits()) / 2, (across_pace.bits() + up_pace.bits()) / 2, moving};
}

PlaceInformation place_information(std::span<const Point> position, std::span<const Point> velocity,
                                   const InformationClasses& classes) {
  FL_CHECK(position.size() == velocity.size());
  std::vector<WalkClasses> people;
  people.reserve(position.size());
  for (std::size_t p = 0; p < position.size(); ++p) {
    people.push_back(walk_classes(position[p], velocity[p], classes));
  }
  return place_information(people);
}

}  // namespace footlight::planner
