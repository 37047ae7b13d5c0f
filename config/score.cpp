// SPDX-License-Identifier: Apache-2.0
#include "config/score.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "config/midi_file.hpp"
#include "config/music_xml.hpp"
#include "config/quantity.hpp"

namespace footlight::config {
namespace {

constexpr double kMostCounts = 1e6;  // what a show file takes

/// Length of a count in quarter notes, and counts a measure where that is a whole number.
struct Beat {
  double quarters = 1;
  std::optional<int> a_measure;
};

Beat beat_of(const ScoreEvents::Meter& meter, CountUnit unit) {
  const double note = 4.0 / meter.note;
  switch (unit) {
    case CountUnit::note:
      return {note, meter.beats};
    case CountUnit::quarter: {
      const double beats = meter.beats * note;
      return {1, beats == std::floor(beats) ? std::optional(static_cast<int>(beats)) : std::nullopt};
    }
    case CountUnit::beat:
      break;
  }
  const bool compound = meter.note >= 8 && meter.beats > 3 && meter.beats % 3 == 0;
  return compound ? Beat{3 * note, meter.beats / 3} : Beat{note, meter.beats};
}

/// Places in quarter notes to counts, through meters whose counts are of different length. A count is so precise that
/// ticks come out as the numbers that people would write.
class Counting {
 public:
  Counting(const std::vector<ScoreEvents::Meter>& meters, CountUnit unit) {
    for (const ScoreEvents::Meter& meter : meters) {
      starts_.push_back({meter.quarter, starts_.empty() ? 1 : count(meter.quarter), beat_of(meter, unit)});
    }
  }
  struct Start {
    double quarter = 0;
    double count = 1;
    Beat beat;
  };
  [[nodiscard]] const Start& start_of(double quarter) const {
    const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), quarter,
                                        [](double q, const Start& start) { return q < start.quarter; });
    return *std::prev(after);
  }
  [[nodiscard]] double count(double quarter) const {
    const Start& start = start_of(quarter);
    const double exact = start.count + (quarter - start.quarter) / start.beat.quarters;
    const double tidy = std::round(exact * 1e9) / 1e9;
    return tidy;
  }
  [[nodiscard]] const std::vector<Start>& starts() const { return starts_; }

 private:
  std::vector<Start> starts_;
};

std::vector<ScoreEvents::Meter> meters_from_zero(const ScoreEvents& events) {
  std::vector<ScoreEvents::Meter> out{{0, 4, 4}};
  for (const ScoreEvents::Meter& meter : events.meters) {
    if (meter.quarter <= out.back().quarter) {
      out.back() = {out.back().quarter, meter.beats, meter.note};
    } else if (meter.beats != out.back().beats || meter.note != out.back().note) {
      out.push_back(meter);
    }
  }
  return out;
}

std::vector<ScoreEvents::Tempo> tempos_from_zero(const ScoreEvents& events, std::vector<std::string>& ignored) {
  std::vector<ScoreEvents::Tempo> out;
  if (events.tempos.empty() || events.tempos.front().quarter > 0) {
    ignored.emplace_back("no tempo stands at the beginning: 120 quarter notes a minute are taken");
    out.push_back({0, 120});
  }
  for (const ScoreEvents::Tempo& tempo : events.tempos) {
    if (!out.empty() && out.back().quarter == tempo.quarter) {
      out.back() = tempo;
    } else {
      out.push_back(tempo);
    }
  }
  return out;
}

Result<std::vector<TempoChange>> changes_of(const std::vector<ScoreEvents::Tempo>& tempos, const Counting& counting,
                                            const std::string& file) {
  std::vector<double> places;  // where the tempo changes, or how much of the music a count is
  places.reserve(tempos.size() + counting.starts().size());
  for (const auto& tempo : tempos) places.push_back(tempo.quarter);
  for (const auto& start : counting.starts()) places.push_back(start.quarter);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<TempoChange> out;
  for (const double quarter : places) {
    const auto after = std::upper_bound(tempos.begin() + 1, tempos.end(), quarter,
                                        [](double q, const ScoreEvents::Tempo& tempo) { return q < tempo.quarter; });
    const TempoChange change{counting.count(quarter),
                             std::prev(after)->quarters_a_minute / counting.start_of(quarter).beat.quarters};
    if (!(change.bpm >= 1 && change.bpm <= 1000)) {
      return input_error(fmt::format("{}: error: {} counts a minute at count {} (1 to 1000)", file, plain(change.bpm),
                                     plain(change.count)));
    }
    if (!out.empty() && out.back().count >= change.count) {
      out.back().bpm = change.bpm;
    } else if (out.empty() || out.back().bpm != change.bpm) {
      out.push_back(change);
    }
  }
  return out;
}

void change_meters(TempoMap& tempo, const Counting& counting, const std::vector<ScoreEvents::Meter>& meters,
                   std::vector<std::string>& ignored) {
  for (std::size_t i = 1; i < counting.starts().size(); ++i) {
    const Counting::Start& start = counting.starts()[i];
    const std::string what =
        fmt::format("the meter {}/{} at count {}", meters[i].beats, meters[i].note, plain(start.count));
    if (!start.beat.a_measure) {
      ignored.push_back(what + " has no whole number of counts: measures are numbered as before");
    } else if (*start.beat.a_measure != tempo.meters().back().beats) {
      const auto changed = tempo.change_meter(start.count, *start.beat.a_measure);
      if (!changed) ignored.push_back(what + ": " + changed.error().message);
    }
  }
}

}  // namespace

Result<Score> score_of(const ScoreEvents& events, CountUnit unit, const std::string& file) {
  if (events.tempos.size() + events.meters.size() > kMostScoreChanges) {
    return input_error(fmt::format("{}: error: {} changes of tempo and meter (at most {})", file,
                                   events.tempos.size() + events.meters.size(), kMostScoreChanges));
  }
  Score out;
  out.ignored = events.ignored;
  const auto meters = meters_from_zero(events);
  const auto tempos = tempos_from_zero(events, out.ignored);
  const Counting counting(meters, unit);
  const double last = std::max(events.end, events.rehearsals.empty() ? 0 : events.rehearsals.back().quarter);
  if (!(counting.count(std::max({last, meters.back().quarter, tempos.back().quarter})) <= kMostCounts)) {
    return input_error(fmt::format("{}: error: the music has more than {} counts", file, plain(kMostCounts)));
  }
  auto changes = changes_of(tempos, counting, file);
  if (!changes) return changes.error();
  const Beat& first = counting.starts().front().beat;
  if (!first.a_measure) {
    out.ignored.push_back(fmt::format("the meter {}/{} has no whole number of counts: measures of 4 counts are taken",
                                      meters.front().beats, meters.front().note));
  }
  const int beats = first.a_measure.value_or(4);
  const double pickup = std::round(events.pickup / first.quarters * 1e9) / 1e9;
  auto tempo = TempoMap::from(*std::move(changes), beats, pickup < beats ? pickup : 0);
  if (!tempo) return input_error(fmt::format("{}: error: {}", file, tempo.error().message));
  change_meters(*tempo, counting, meters, out.ignored);
  out.tempo = *std::move(tempo);
  for (const auto& mark : events.rehearsals) out.rehearsals.push_back({counting.count(mark.quarter), mark.text});
  out.counts = counting.count(events.end) - 1;
  return out;
}

bool looks_like_score(std::string_view bytes) {
  if (bytes.starts_with("MThd")) return true;
  if (bytes.starts_with("PK")) return is_compressed_music_xml(bytes);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return (first != std::string_view::npos && bytes[first] == '<') || bytes.starts_with("\xFE\xFF") ||
         bytes.starts_with("\xFF\xFE");
}

Result<ScoreEvents> read_score(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("MThd")) return read_midi(bytes, file);
  if (bytes.starts_with("PK")) return read_compressed_music_xml(bytes, file);
  return read_music_xml(bytes, file);
}

}  // namespace footlight::config
