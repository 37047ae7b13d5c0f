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
  std::string file{};              ///< it was read from, for messages
  std::vector<int> lines{};        ///< of the points in it

  friend bool operator==(const DroneTrack& a, const DroneTrack& b) { return a.name == b.name && a.points == b.points; }
};

/// Everybody's marks in the colour of the group, black in the reserve. Marks within one millisecond become one.
[[nodiscard]] std::vector<DroneTrack> drone_tracks(const Plan& plan, const Show& show);

/// A zip with a file NAME.csv for each track, `Time_msec,x_m,y_m,z_m,R,G,B`, as drone tools read it. Numbers survive a
/// round trip; the same tracks give the same bytes.
[[nodiscard]] Result<std::string> drone_zip(const std::vector<DroneTrack>& tracks);

/// Tracks of such a zip, in its order. Errors: no zip or one made to harm (config/zip_file.hpp); a file that is none of
/// these, with file, line and column; two files of one name; more than the limits below. @param zip_name for messages
[[nodiscard]] Result<std::vector<DroneTrack>> read_drone_zip(std::string_view bytes, const std::string& zip_name);
/// One such file; its name without folder and ".csv" is the performer's.
[[nodiscard]] Result<DroneTrack> read_drone_csv(std::string_view text, const std::string& file);
/// Whether the first line that says something is a header of this kind.
[[nodiscard]] bool is_drone_csv(std::string_view text);

inline constexpr std::uint64_t kMostDroneFileBytes = std::uint64_t{16} << 20U;
inline constexpr std::uint64_t kMostDroneLines = 10'000'000;  ///< of all files of a show

}  // namespace footlight::app
