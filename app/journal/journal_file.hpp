// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/journal/place.hpp"
#include "config/sqlite.hpp"
#include "core/result.hpp"

namespace footlight::app {

inline constexpr std::int64_t kJournalApplicationId = 0x464C4A4E;  ///< "FLJN"
inline constexpr std::int64_t kJournalVersion = 2;

/// One run of the program, as its journal has it.
struct JournalRun {
  std::int64_t id = 0;
  Duration began{};  ///< since 1970
  std::string version;
  std::string show;           ///< path of its file
  std::string plan;           ///< config::digest_of
  std::string machine_start;  ///< core/machine_time.hpp
  std::uint32_t epoch = 0;    ///< under which it led the markers; 0: none
  std::optional<Duration> ended{};
  std::string how;  ///< it ended: "over", "interrupted", an error
};

/// Something that happened.
struct JournalEntry {
  Duration wall{};     ///< since 1970
  Duration machine{};  ///< of `machine_time`
  std::string kind;    ///< answer, moment, reset, alarm, note, health, plan
  std::string who{};
  std::string order{};
  std::string text{};
  bool refused = false;
  Instant position{};  ///< show time
};

/// The journal of runs: an SQLite file in which each run has a row, with what happened and where the show was. Whatever
/// ends the program, what was written stays. One thread. Errors are SQLite's words (ErrorKind::input).
class JournalFile {
 public:
  /// Makes it where it is not there. Refuses a file that is something else.
  static Result<JournalFile> open(const std::filesystem::path& file);

  /// A new run. Its id and end are filled in here.
  Status<> begin(const JournalRun& run);
  /// All or nothing.
  Status<> write(std::span<const JournalEntry> entries, std::span<const Place> places);
  Status<> end(Duration when, const std::string& how);

 private:
  explicit JournalFile(config::Database database) : database_(std::move(database)) {}
  [[nodiscard]] Error failed() const { return input_error(database_.last_error()); }
  bool put(const JournalEntry& entry, config::Statement& row) const;
  bool put(const Place& place, config::Statement& row) const;

  config::Database database_;
  std::int64_t run_ = 0;
};

/// What a journal says. Errors: ErrorKind::input for what is no journal, or cannot be read.
struct JournalReading {
  std::vector<JournalRun> runs;       ///< in their order
  std::vector<JournalEntry> entries;  ///< of the run that was asked for
  std::optional<Place> last_place;    ///< of that run
};
/// @param run 0: the last one
[[nodiscard]] Result<JournalReading> read_journal(const std::filesystem::path& file, std::int64_t run = 0);

/// "journal.sqlite" in the folder of traces.
[[nodiscard]] std::filesystem::path journal_in(const std::filesystem::path& state_folder);

}  // namespace footlight::app
