// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace footlight::planner {

/// Mutual information of two classes that everybody is in, bits: Xu 2015, Eq. 11 with logarithms of base 2. 0 for
/// nobody. @param first, second of each person, as many; any small whole numbers from 0  O(people + classes^2)
[[nodiscard]] double mutual_information_bits(std::span<const std::uint16_t> first,
                                             std::span<const std::uint16_t> second);

/// How places and ways of walking are made classes (Xu 2015, Eq. 12 to 14).
struct InformationClasses {
  Point low;         ///< corner of the first bin
  double bin_m = 5;  ///< R: side of a bin
  int sectors = 8;   ///< K: of direction, the first from 0 to 2 pi / K, counter-clockwise from +x; and classes of speed
  double fastest_mps = 1.4;  ///< end of the last class of speed; more belongs to it, too

  /// What is on an edge but for rounding is on it.
  [[nodiscard]] std::uint16_t bin(double offset_m) const;
  [[nodiscard]] std::uint16_t sector(Point velocity) const;
  [[nodiscard]] std::uint16_t pace(double speed_mps) const;
};

/// What places tell of how people walk. Not a number while nobody walks.
struct PlaceInformation {
  double direction_bits;  ///< I_d of Eq. 17
  double speed_bits;      ///< I_v, in the same way with classes of speed
  std::uint32_t moving;   ///< N: people who walk; who stands has no direction
};

/// The classes of somebody who walks.
struct WalkClasses {
  static constexpr std::uint16_t kStands = 0xFFFF;  ///< as sector: of who does not walk
  std::uint16_t across = 0;
  std::uint16_t up = 0;
  std::uint16_t sector = kStands;
  std::uint16_t pace = 0;
};
/// Somebody walks who moves faster than a millimetre a second.
[[nodiscard]] WalkClasses walk_classes(Point position, Point velocity, const InformationClasses& classes);

/// Of those who walk among `people`. O(people + bins across the floor x sectors)
[[nodiscard]] PlaceInformation place_information(std::span<const WalkClasses> people);
/// Of those who move faster than a millimetre a second. Few people bias it: with N people in B bins and K sectors pure
/// chance gives about (B - 1) (K - 1) / (2 N ln 2) bits.
/// @param position, velocity of everybody, m and m/s
[[nodiscard]] PlaceInformation place_information(std::span<const Point> position, std::span<const Point> velocity,
                                                 const InformationClasses& classes);

}  // namespace footlight::planner
