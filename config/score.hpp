// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/tempo_map.hpp"

namespace footlight::config {

/// What a count of the show is in a score.
enum class CountUnit {
  beat,     ///< the beat as conducted: a third of the note under the meter's line where that is x/8 or shorter and the
            ///< upper number divides by three (6/8 has two counts, 9/8 three), else that note
  note,     ///< the note that the meter names: 6/8 has six counts
  quarter,  ///< a quarter note, whatever the meter
};

/// What a file of music says, in quarter notes from its beginning: before it is known what a count is.
struct ScoreEvents {
  struct Tempo {
    double quarter = 0;
    double quarters_a_minute = 120;
  };
  struct Meter {
    double quarter = 0;  ///< a measure begins here
    int beats = 4;       ///< the upper number
    int note = 4;        ///< the lower number, a power of two
  };
  struct Rehearsal {
    double quarter = 0;
    std::string text;
  };
  std::vector<Tempo> tempos;          ///< ascending; of equal places the last holds
  std::vector<Meter> meters;          ///< ascending; without one at 0 the first measures are 4/4
  std::vector<Rehearsal> rehearsals;  ///< ascending
  double pickup = 0;                  ///< length of a first measure that is not full; 0: it is
  double end = 0;
  std::vector<std::string> ignored;  ///< what was found and means nothing here, each as a sentence's beginning
};

/// The same in counts.
struct Score {
  struct Rehearsal {
    double count = 1;
    std::string text;
  };
  TempoMap tempo;
  std::vector<Rehearsal> rehearsals;
  double counts = 0;  ///< length
  std::vector<std::string> ignored;
};

/// More than a show file can hold is no music: changes of tempo and meter.
inline constexpr std::size_t kMostScoreChanges = 10'000;
inline constexpr std::size_t kMostScoreBytes = std::size_t{64} << 20U;

/// Counts of a score. Errors, naming the file and the place: a tempo outside of [1, 1000] counts a minute, more than
/// `kMostScoreChanges`, more than a million counts. A meter that does not begin where a measure begins, or has no whole
/// number of counts, is left out and told in `ignored`.
[[nodiscard]] Result<Score> score_of(const ScoreEvents& events, CountUnit unit, const std::string& file);

/// A score of any kind, by its content: Standard MIDI file, MusicXML, compressed MusicXML.
[[nodiscard]] Result<ScoreEvents> read_score(std::string_view bytes, const std::string& file);
/// Whether the bytes begin as a MIDI or MusicXML file; a zip is compressed MusicXML when it has a container.
[[nodiscard]] bool looks_like_score(std::string_view bytes);

}  // namespace footlight::config
