// SPDX-License-Identifier: Apache-2.0
#include "app/journal/journal_file.hpp"

#include <utility>

#include <fmt/format.h>

namespace footlight::app {
namespace {

using config::Database;
using config::Statement;

constexpr const char* kSchema[] = {
    "CREATE TABLE runs(id INTEGER PRIMARY KEY, began_ns INTEGER NOT NULL, version TEXT NOT NULL, show TEXT NOT NULL, "
    "plan TEXT NOT NULL, machine_start TEXT NOT NULL, epoch INTEGER NOT NULL, ended_ns INTEGER, how TEXT)",
    "CREATE TABLE entries(id INTEGER PRIMARY KEY, run INTEGER NOT NULL REFERENCES runs(id), wall_ns INTEGER NOT NULL, "
    "machine_ns INTEGER NOT NULL, kind TEXT NOT NULL, who TEXT NOT NULL, \"order\" TEXT NOT NULL, text TEXT NOT NULL, "
    "refused INTEGER NOT NULL, position_ns INTEGER NOT NULL)",
    "CREATE TABLE places(id INTEGER PRIMARY KEY, run INTEGER NOT NULL REFERENCES runs(id), machine_ns INTEGER NOT "
    "NULL, "
    "position_ns INTEGER NOT NULL, cue INTEGER, waits INTEGER NOT NULL, runs_since_ns INTEGER, percent INTEGER NOT "
    "NULL, "
    "hold_at_ns INTEGER, step_to_ns INTEGER, loop_from_ns INTEGER, loop_to_ns INTEGER, over INTEGER NOT NULL, "
    "in_reset INTEGER NOT NULL, time_on INTEGER NOT NULL, time_armed INTEGER NOT NULL, emergency_hold INTEGER NOT "
    "NULL, readiness TEXT NOT NULL)",
    "CREATE INDEX entries_of_run ON entries(run)",
    "CREATE INDEX places_of_run ON places(run)",
};

std::int64_t pragma(Database& database, const char* sql) {
  Statement statement = database.prepare(sql);
  return statement.step() ? statement.integer(0).value_or(-1) : -1;
}

Status<> judge(Database& database) {
  if (pragma(database, "PRAGMA application_id") != kJournalApplicationId) {
    return input_error("it is no journal of a run");
  }
  if (const auto version = pragma(database, "PRAGMA user_version"); version != kJournalVersion) {
    return input_error(
        fmt::format("it has version {}, this program writes version {} (move it away, and a new one is begun)", version,
                    kJournalVersion));
  }
  return Done{};
}

std::int64_t ns(Duration duration) { return duration.count(); }

void bind_instant(Statement& row, const std::optional<Instant>& instant) {
  if (instant) {
    row.bind(ns(instant->time_since_epoch()));
  } else {
    row.bind_null();
  }
}

std::optional<Instant> instant(const Statement& row, int column) {
  const auto value = row.integer(column);
  return value ? std::optional(Instant(Duration(*value))) : std::nullopt;
}

Duration duration(const Statement& row, int column) { return Duration(row.integer(column).value_or(0)); }

}  // namespace

std::filesystem::path journal_in(const std::filesystem::path& state_folder) { return state_folder / "journal.sqlite"; }

Result<JournalFile> JournalFile::open(const std::filesystem::path& file) {
  auto database = Database::open(file.string(), Database::Use::write);
  if (!database) return std::move(database).error();
  if (pragma(*database, "SELECT count(*) FROM sqlite_schema") == 0) {
    bool made = database->execute("BEGIN IMMEDIATE");
    made = made && database->execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                                                 kJournalApplicationId, kJournalVersion)
                                         .c_str());
    for (const char* table : kSchema) made = made && database->execute(table);
    if (!made || !database->execute("COMMIT")) return input_error(database->last_error());
  }
  if (auto fits = judge(*database); !fits) return std::move(fits).error();
  return JournalFile(std::move(database).value());
}

Status<> JournalFile::begin(const JournalRun& run) {
  Statement row = database_.prepare(
      "INSERT INTO runs(began_ns, version, show, plan, machine_start, epoch) VALUES(?, ?, ?, ?, ?, ?)");
  row.bind(ns(run.began)).bind(std::string_view(run.version)).bind(std::string_view(run.show));
  row.bind(std::string_view(run.plan)).bind(std::string_view(run.machine_start)).bind(std::int64_t{run.epoch});
  if (!row.run()) return failed();
  run_ = database_.last_row();
  return Done{};
}

bool JournalFile::put(const JournalEntry& entry, Statement& row) const {
  row.bind(run_).bind(ns(entry.wall)).bind(ns(entry.machine)).bind(std::string_view(entry.kind));
  row.bind(std::string_view(entry.who)).bind(std::string_view(entry.order)).bind(std::string_view(entry.text));
  return row.bind(std::int64_t{entry.refused ? 1 : 0}).bind(ns(entry.position.time_since_epoch())).run();
}

bool JournalFile::put(const Place& place, Statement& row) const {
  const auto& where = place.where;
  row.bind(run_).bind(ns(place.at)).bind(ns(where.position.time_since_epoch()));
  if (where.cue) {
    row.bind(static_cast<std::int64_t>(*where.cue));
  } else {
    row.bind_null();
  }
  row.bind(std::int64_t{where.waits ? 1 : 0});
  bind_instant(row, where.runs_since);
  row.bind(std::int64_t{where.percent});
  bind_instant(row, where.hold_at);
  bind_instant(row, where.step_to);
  bind_instant(row, where.loop ? std::optional(where.loop->from) : std::nullopt);
  bind_instant(row, where.loop ? std::optional(where.loop->to) : std::nullopt);
  for (const bool truth : {place.over, place.in_reset, place.time.on, place.time.armed, place.emergency_hold}) {
    row.bind(std::int64_t{truth ? 1 : 0});
  }
  return row.bind(std::string_view(place.readiness)).run();
}

Status<> JournalFile::write(std::span<const JournalEntry> entries, std::span<const Place> places) {
  if (!database_.execute("BEGIN IMMEDIATE")) return failed();
  Statement entry_row = database_.prepare(
      "INSERT INTO entries(run, wall_ns, machine_ns, kind, who, \"order\", text, refused, position_ns) "
      "VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement place_row = database_.prepare(
      "INSERT INTO places(run, machine_ns, position_ns, cue, waits, runs_since_ns, percent, hold_at_ns, step_to_ns, "
      "loop_from_ns, loop_to_ns, over, in_reset, time_on, time_armed, emergency_hold, readiness) VALUES(?, ?, ?, ?, ?, "
      "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  bool whole = true;
  for (const JournalEntry& entry : entries) whole = whole && put(entry, entry_row);
  for (const Place& place : places) whole = whole && put(place, place_row);
  if (whole && database_.execute("COMMIT")) return Done{};
  Error error = failed();
  (void)database_.execute("ROLLBACK");
  return error;
}

Status<> JournalFile::end(Duration when, const std::string& how) {
  Statement row = database_.prepare("UPDATE runs SET ended_ns = ?, how = ? WHERE id = ?");
  if (!row.bind(ns(when)).bind(std::string_view(how)).bind(run_).run()) return failed();
  return Done{};
}

namespace {

std::vector<JournalRun> runs_of(Database& database) {
  std::vector<JournalRun> runs;
  Statement row = database.prepare(
      "SELECT id, began_ns, version, show, plan, machine_start, epoch, ended_ns, how FROM runs ORDER BY id");
  while (row.step()) {
    JournalRun& run = runs.emplace_back();
    run.id = row.integer(0).value_or(0);
    run.began = duration(row, 1);
    run.version = row.text(2).value_or("");
    run.show = row.text(3).value_or("");
    run.plan = row.text(4).value_or("");
    run.machine_start = row.text(5).value_or("");
    run.epoch = static_cast<std::uint32_t>(row.integer(6).value_or(0));
    if (!row.null(7)) run.ended = duration(row, 7);
    run.how = row.text(8).value_or("");
  }
  return runs;
}

std::vector<JournalEntry> entries_of(Database& database, std::int64_t run) {
  std::vector<JournalEntry> entries;
  Statement row = database.prepare(
      "SELECT wall_ns, machine_ns, kind, who, \"order\", text, refused, position_ns FROM entries WHERE run = ? "
      "ORDER BY id");
  row.bind(run);
  while (row.step()) {
    JournalEntry& entry = entries.emplace_back();
    entry.wall = duration(row, 0);
    entry.machine = duration(row, 1);
    entry.kind = row.text(2).value_or("");
    entry.who = row.text(3).value_or("");
    entry.order = row.text(4).value_or("");
    entry.text = row.text(5).value_or("");
    entry.refused = row.integer(6).value_or(0) != 0;
    entry.position = Instant(duration(row, 7));
  }
  return entries;
}

std::optional<Place> last_place_of(Database& database, std::int64_t run) {
  Statement row = database.prepare(
      "SELECT machine_ns, position_ns, cue, waits, runs_since_ns, percent, hold_at_ns, step_to_ns, loop_from_ns, "
      "loop_to_ns, over, in_reset, time_on, time_armed, emergency_hold, readiness FROM places WHERE run = ? ORDER BY "
      "id DESC LIMIT 1");
  row.bind(run);
  if (!row.step()) return std::nullopt;
  Place place;
  auto& where = place.where;
  place.at = duration(row, 0);
  where.position = Instant(duration(row, 1));
  if (const auto cue = row.integer(2); cue && *cue >= 0) where.cue = static_cast<std::size_t>(*cue);
  where.waits = row.integer(3).value_or(1) != 0;
  where.runs_since = instant(row, 4);
  where.percent = static_cast<int>(row.integer(5).value_or(100));
  where.hold_at = instant(row, 6);
  where.step_to = instant(row, 7);
  const auto from = instant(row, 8);
  const auto to = instant(row, 9);
  if (from && to && *from < *to) where.loop = {*from, *to};
  place.over = row.integer(10).value_or(0) != 0;
  place.in_reset = row.integer(11).value_or(0) != 0;
  place.time = {row.integer(12).value_or(0) != 0, row.integer(13).value_or(0) != 0};
  place.emergency_hold = row.integer(14).value_or(0) != 0;
  place.readiness = row.text(15).value_or("");
  return place;
}

}  // namespace

Result<JournalReading> read_journal(const std::filesystem::path& file, std::int64_t run) {
  const auto refused = [&](const std::string& why) {
    return input_error(fmt::format("cannot read the journal '{}': {}", file.string(), why));
  };
  auto database = Database::open(file.string(), Database::Use::read);
  if (!database) return refused(database.error().message);
  if (auto fits = judge(*database); !fits) return refused(fits.error().message);
  JournalReading reading;
  reading.runs = runs_of(*database);
  if (reading.runs.empty()) return reading;
  if (run == 0) run = reading.runs.back().id;
  reading.entries = entries_of(*database, run);
  reading.last_place = last_place_of(*database, run);
  return reading;
}

}  // namespace footlight::app
