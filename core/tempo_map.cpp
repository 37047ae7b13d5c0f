// SPDX-License-Identifier: Apache-2.0
#include "core/tempo_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace footlight {
namespace {

std::vector<double> times_of(const std::vector<TempoChange>& changes) {
  std::vector<double> out{0.0};
  for (std::size_t i = 1; i < changes.size(); ++i) {
    out.push_back(out.back() + (changes[i].count - changes[i - 1].count) * 60.0 / changes[i - 1].bpm);
  }
  return out;
}

}  // namespace

TempoMap::TempoMap(double bpm, int beats_per_measure)
    : changes_{{1, bpm}}, change_s_{0.0}, meters_{{1, beats_per_measure}}, meter_measure_{1.0} {
  FL_CHECK(bpm > 0 && beats_per_measure >= 1);
}

Result<TempoMap> TempoMap::from(std::vector<TempoChange> changes, int beats_per_measure, double pickup_counts) {
  if (beats_per_measure < 1) return input_error("a measure has at least one beat");
  if (!(pickup_counts >= 0 && pickup_counts < beats_per_measure)) {
    return input_error("a pick-up is shorter than a measure");
  }
  if (changes.empty() || changes.front().count != 1) return input_error("the first tempo begins at count 1");
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!(changes[i].bpm >= 1 && changes[i].bpm <= 1000))
      return input_error("a tempo lies between 1 and 1000 counts a minute");
    if (i > 0 && !(changes[i].count > changes[i - 1].count)) return input_error("the counts of tempo changes increase");
  }
  TempoMap map(changes.front().bpm, beats_per_measure);
  map.change_s_ = times_of(changes);
  map.changes_ = std::move(changes);
  map.meters_.front().count = 1 + pickup_counts;
  return map;
}

Status<> TempoMap::change_meter(double count, int beats) {
  FL_CHECK(beats >= 1);
  const MeterChange& last = meters_.back();
  const double measures = (count - last.count) / last.beats;
  if (!(measures > 0)) return input_error("the counts of meter changes increase");
  // Counts from other programs' ticks may be a rounding off.
  if (std::abs(measures - std::round(measures)) * last.beats > 1e-6) {
    const double next = last.count + std::ceil(measures) * last.beats;
    char text[64];
    (void)std::snprintf(text, sizeof text, "%.10g", next);
    return input_error("no measure begins here; the next one does at count " + std::string(text));
  }
  meter_measure_.push_back(meter_measure_.back() + std::round(measures));
  meters_.push_back({count, beats});
  return Done{};
}

Instant TempoMap::at(double count) const {
  const auto after = std::upper_bound(changes_.begin() + 1, changes_.end(), count,
                                      [](double c, const TempoChange& t) { return c < t.count; });
  const std::size_t i = static_cast<std::size_t>(after - changes_.begin()) - 1;
  return instant_at(change_s_[i] + (count - changes_[i].count) * 60.0 / changes_[i].bpm);
}

double TempoMap::count_at(Instant instant) const {
  const double s = to_seconds(instant);
  const auto after = std::upper_bound(change_s_.begin() + 1, change_s_.end(), s);
  const std::size_t i = static_cast<std::size_t>(after - change_s_.begin()) - 1;
  const double count = changes_[i].count + (s - change_s_[i]) * changes_[i].bpm / 60.0;
  // Instants are whole nanoseconds, so whole counts come back a little off; a count with few decimals that lies on this
  // very nanosecond is what was meant.
  const double plain = std::round(count * 1e6) / 1e6;
  return at(plain) == instant ? plain : count;
}

double TempoMap::bpm_at(double count) const {
  const auto after = std::upper_bound(changes_.begin() + 1, changes_.end(), count,
                                      [](double c, const TempoChange& t) { return c < t.count; });
  return std::prev(after)->bpm;
}

std::string TempoMap::measure_beat(double count) const {
  // Rounded first, so that a count a nanosecond before a measure is not that measure's "beat 5 of 4".
  const double plain = std::round(count * 1e4) / 1e4;
  const auto after = std::upper_bound(meters_.begin() + 1, meters_.end(), plain + 1e-6,
                                      [](double c, const MeterChange& m) { return c < m.count; });
  const std::size_t i = static_cast<std::size_t>(after - meters_.begin()) - 1;
  const double beats = std::round((plain - meters_[i].count) * 1e4) / 1e4;
  const double measure = std::floor(beats / meters_[i].beats);
  const double beat = beats - measure * meters_[i].beats + 1;
  char text[64];
  (void)std::snprintf(text, sizeof text, "%.0f:%.6g", measure + meter_measure_[i], beat);
  return text;
}

}  // namespace footlight
