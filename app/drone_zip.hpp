// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/grid.hpp"
#include "core/look.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// One line of a unit's file: where it is from a millisecond on, on a straight line to the next.
struct DronePoint {
  std::int64_t time_ms = 0;
  Point at;
  double height_m = 0;
  Colour colour;

  friend bool operator==(const DronePoint&, const DronePoint&) = default;
};
struct DroneTrack {
  std::string name;
  std::vector<DronePoint> points;  ///< times strictly increasing

  friend bool operator==(const DroneTrack&, const DroneTrack&) = default;
};

/// Everybody's marks in the colour of the group, black in the reserve. Marks within one millisecond become one.
[[nodiscard]] std::vector<DroneTrack> drone_tracks(const Plan& plan, const Show& show);

/// A zip with a file NAME.csv for each track, `Time_msec,x_m,y_m,z_m,R,G,B`, as drone tools read it. Numbers survive a
/// round trip; the same tracks give the same bytes.
[[nodiscard]] Result<std::string> drone_zip(const std::vector<DroneTrack>& tracks);

/// Tracks of such a zip, in its order. Errors: no zip; a file that is none of these, with file, line and column; times
/// that do not increase; more than `kMostDroneBytes` when unpacked. @param zip_name for messages
[[nodiscard]] Result<std::vector<DroneTrack>> read_drone_zip(std::string_view bytes, const std::string& zip_name);
inline constexpr std::uint64_t kMostDroneBytes = std::uint64_t{1} << 30U;

}  // namespace footlight::app
