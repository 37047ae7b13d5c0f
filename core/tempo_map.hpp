// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight {

/// From this count on the tempo is `bpm` counts a minute.
struct TempoChange {
  double count = 1;
  double bpm = 120;

  friend bool operator==(const TempoChange&, const TempoChange&) = default;
};

/// From this count on a measure has `beats` counts.
struct MeterChange {
  double count = 1;  ///< a measure begins here
  int beats = 4;

  friend bool operator==(const MeterChange&, const MeterChange&) = default;
};

/// Counts <-> show time. Count 1 is at time 0; counts may be decimal. Before count 1 the first tempo goes on. Measures
/// are for print alone.
class TempoMap {
 public:
  /// One tempo for the whole show. @param bpm counts a minute, > 0  @param beats_per_measure >= 1
  explicit TempoMap(double bpm = 120, int beats_per_measure = 4);
  /// @param changes counts strictly increasing, the first at count 1, bpm in [1, 1000]; else ErrorKind::input
  /// @param pickup_counts before measure 1 begins, in [0, beats_per_measure)
  static Result<TempoMap> from(std::vector<TempoChange> changes, int beats_per_measure, double pickup_counts = 0);
  /// Changes the meter behind the changes before. @param count > the last change's  @param beats >= 1
  /// Errors (ErrorKind::input): no measure begins there.
  Status<> change_meter(double count, int beats);

  /// @return nearest nanosecond. O(log changes)
  [[nodiscard]] Instant at(double count) const;
  [[nodiscard]] double count_at(Instant instant) const;
  /// Tempo in force at a count, counts a minute.
  [[nodiscard]] double bpm_at(double count) const;
  /// Time of `counts` counts that begin at `count`.
  [[nodiscard]] Duration span(double count, double counts) const { return at(count + counts) - at(count); }
  /// "measure:beat", both from 1, as "17:3"; a decimal part of the count is kept as "17:3.5",
  /// to 1/10,000.
  [[nodiscard]] std::string measure_beat(double count) const;
  /// Of the first meter.
  [[nodiscard]] int beats_per_measure() const { return meters_.front().beats; }
  /// Counts before measure 1.
  [[nodiscard]] double pickup_counts() const { return meters_.front().count - 1; }
  /// The first at measure 1, counts increasing.
  [[nodiscard]] const std::vector<MeterChange>& meters() const { return meters_; }
  [[nodiscard]] const std::vector<TempoChange>& changes() const { return changes_; }

  friend bool operator==(const TempoMap&, const TempoMap&) = default;

 private:
  std::vector<TempoChange> changes_;
  std::vector<double> change_s_;  ///< show time of each change, s
  std::vector<MeterChange> meters_;
  std::vector<double> meter_measure_;  ///< number of the measure that begins at each change of meter
};

}  // namespace footlight
