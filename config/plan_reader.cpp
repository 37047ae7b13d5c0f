// SPDX-License-Identifier: Apache-2.0
#include "config/plan_reader.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "config/plan_digest.hpp"
#include "config/track_code.hpp"

namespace footlight::config {
namespace {

constexpr std::int64_t kMostPerformers = 1'000'000;
constexpr std::int64_t kIntMax = std::numeric_limits<int>::max();

/// One row after the other of a table whose first column numbers the rows from 0. The first thing wrong ends it.
class Rows {
 public:
  Rows(Database& database, const char* sql, std::string table)
      : statement_(database.prepare(sql)), table_(std::move(table)) {}

  /// @return whether there is another row; false once anything was wrong
  bool next() {
    if (!problem_.empty() || !statement_.step()) return false;
    column_ = 0;
    if (integer(0, kIntMax) != row_) wrong("its rows are not in order");
    ++row_;
    return problem_.empty();
  }
  /// Number of rows so far.
  [[nodiscard]] std::int64_t count() const { return row_; }
  /// The problem, if any, once `next` has said false.
  [[nodiscard]] std::string problem() const {
    if (!problem_.empty()) return fmt::format("table {}: {}", table_, problem_);
    return statement_.failed() ? fmt::format("table {} cannot be read", table_) : std::string();
  }
  void wrong(std::string what) {
    if (problem_.empty()) problem_ = std::move(what);
  }

  // The columns one after the other.
  std::int64_t integer(std::int64_t least, std::int64_t most) {
    const auto value = statement_.integer(column_++);
    if (!value || *value < least || *value > most) return wrong_value(least);
    return *value;
  }
  int number(std::int64_t least = 0, std::int64_t most = kIntMax) { return static_cast<int>(integer(least, most)); }
  Instant instant() { return Instant(Duration(integer(std::numeric_limits<std::int64_t>::min(), kIntMax64))); }
  double real() {
    const auto value = statement_.real(column_++);
    return value ? *value : static_cast<double>(wrong_value(0));
  }
  std::string text() { return take(statement_.text(column_++)); }
  std::vector<CellIndex> cells(int grid_size) {
    return take(decode_cells(take(statement_.blob(column_++)), grid_size));
  }
  std::vector<Mark> track(int grid_size) { return take(decode_track(take(statement_.blob(column_++)), grid_size)); }
  std::optional<int> optional_number() {
    if (statement_.null(column_)) {
      ++column_;
      return std::nullopt;
    }
    return number();
  }

 private:
  static constexpr std::int64_t kIntMax64 = std::numeric_limits<std::int64_t>::max();

  std::int64_t wrong_value(std::int64_t instead) {
    wrong(fmt::format("row {} has a value of the wrong kind or out of its range", row_));
    return instead;
  }
  template <class T>
  T take(std::optional<T> value) {
    if (value) return *std::move(value);
    wrong_value(0);
    return {};
  }

  Statement statement_;
  std::string table_;
  std::string problem_;
  std::int64_t row_ = 0;
  int column_ = 0;
};

bool ascending(const std::vector<CellIndex>& cells) {
  for (std::size_t i = 1; i < cells.size(); ++i) {
    if (!(cells[i - 1] < cells[i])) return false;
  }
  return true;
}

class PlanReader {
 public:
  explicit PlanReader(Database& database) : database_(database) {}

  Result<Plan> read() {
    // The grid comes first: everything else is checked against it.
    const bool whole = schema() && meta() && stage() && performers() && tracks() && sections() && films() &&
                       obstacles() && notes() && formations() && transitions();
    if (!whole) return input_error(problem_);
    if (digest_of(plan_) != digest_) return input_error("its content does not match its digest");
    return std::move(plan_);
  }

 private:
  bool fail(std::string what) {
    if (problem_.empty()) problem_ = std::move(what);
    return false;
  }
  bool done(const Rows& rows) {
    const std::string problem = rows.problem();
    return problem.empty() || fail(problem);
  }

  bool schema() {
    Statement statement = database_.prepare("SELECT sql FROM sqlite_schema ORDER BY rowid");
    for (const char* expected : kPlanSchema) {
      if (!statement.step() || statement.text(0) != expected) return fail("its tables are not those of a plan");
    }
    if (statement.step() || statement.failed()) return fail("its tables are not those of a plan");
    return true;
  }

  bool meta() {
    Statement statement = database_.prepare("SELECT key, value FROM meta");
    std::map<std::string, std::string> values;
    while (values.size() <= 5 && statement.step()) {
      values.emplace(statement.text(0).value_or(""), statement.text(1).value_or(""));
    }
    const std::size_t known = values.contains("version") ? 5 : 4;
    if (statement.failed() || values.size() != known || !values.contains("title") || !values.contains("show_hash") ||
        !values.contains("valid") || !values.contains("digest") || (values["valid"] != "0" && values["valid"] != "1")) {
      return fail("table meta: title, show_hash, valid and digest are needed");
    }
    plan_.title = values["title"];
    plan_.version = values["version"];
    plan_.show_hash = values["show_hash"];
    plan_.valid = values["valid"] == "1";
    digest_ = values["digest"];
    return true;
  }

  bool stage() {
    Rows rows(database_,
              "SELECT number, grid, columns, rows, pitch_m, blocked, reserve, clearance_m, max_speed_m_s, lag_ns, walk "
              "FROM stage ORDER BY number",
              "stage");
    while (rows.next()) {
      if (rows.count() > 1) rows.wrong("there is more than one row");
      const auto kind = grid_kind_from(rows.text());
      const int columns = rows.number();
      const int lines = rows.number();
      const double pitch_m = rows.real();
      auto grid = Grid::make(kind.value_or(GridKind::square), columns, lines, pitch_m);
      if (!kind || !grid) return fail("table stage: there is no such grid");
      plan_.stage.grid = *grid;
      plan_.stage.blocked = rows.cells(grid->size());
      plan_.stage.reserve = rows.cells(grid->size());
      plan_.stage.clearance_m = rows.real();
      plan_.stage.max_speed_mps = rows.real();
      plan_.stage.lag = rows.instant().time_since_epoch();
      const auto walk = walk_kind_from(rows.text());
      if (!walk) return fail("table stage: there is no such kind of walk");
      plan_.stage.walk = *walk;
      if (!ascending(plan_.stage.blocked) || !ascending(plan_.stage.reserve)) rows.wrong("cells are not in order");
    }
    if (rows.count() == 0) rows.wrong("it has no row");
    return done(rows);
  }

  bool performers() {
    Rows rows(database_, "SELECT number, id, radius_m, max_speed_m_s FROM performers ORDER BY number", "performers");
    while (rows.next()) {
      if (rows.count() > kMostPerformers) rows.wrong("there are too many");
      plan_.performers.push_back(rows.text());
      plan_.radius_m.push_back(rows.real());
      plan_.max_speed_mps.push_back(rows.real());
    }
    return done(rows);
  }

  bool tracks() {
    Rows rows(database_, "SELECT performer, marks FROM tracks ORDER BY performer", "tracks");
    while (rows.next()) plan_.tracks.push_back(rows.track(plan_.stage.grid.size()));
    if (plan_.tracks.size() != plan_.performers.size()) rows.wrong("not everybody has a track");
    return done(rows);
  }

  bool sections() {
    Rows rows(database_, "SELECT number, name, start_ns, end_ns, max_speed_m_s, reserve FROM sections ORDER BY number",
              "sections");
    while (rows.next()) {
      PlanSection section;
      section.name = rows.text();
      section.start = rows.instant();
      section.end = rows.instant();
      section.max_speed_mps = rows.real();
      section.reserve = rows.cells(plan_.stage.grid.size());
      if (!ascending(section.reserve)) rows.wrong("cells are not in order");
      plan_.sections.push_back(std::move(section));
    }
    return done(rows);
  }

  [[nodiscard]] std::int64_t last_section() const { return static_cast<std::int64_t>(plan_.sections.size()) - 1; }

  bool films() {
    Rows rows(
        database_,
        "SELECT row_number() OVER (ORDER BY section) - 1, section, path, first_frame, last_frame, show_fps, width, "
        "height, threshold, inverted, a, b, c, d, e, f FROM films ORDER BY section",
        "films");
    while (rows.next()) {
      const std::int64_t section = rows.integer(0, last_section());
      FilmPlacement film;
      film.path = rows.text();
      film.first_frame = rows.number();
      film.last_frame = rows.number();
      film.show_fps = rows.real();
      film.width = rows.number();
      film.height = rows.number();
      film.threshold = rows.number(0, 255);
      film.inverted = rows.number(0, 1) == 1;
      for (double& number : film.stage_to_frame) number = rows.real();
      if (rows.problem().empty()) plan_.sections[static_cast<std::size_t>(section)].film = std::move(film);
    }
    return done(rows);
  }

  bool obstacles() {
    Rows rows(database_, "SELECT number, section, obstacle, radius_m, time_ns, x_m, y_m FROM obstacles ORDER BY number",
              "obstacles");
    while (rows.next()) {
      const std::int64_t section = rows.integer(0, last_section());
      const int number = rows.number();
      const double radius_m = rows.real();
      const Instant time = rows.instant();
      const double x_m = rows.real();
      const double y_m = rows.real();
      if (!rows.problem().empty()) break;
      auto& list = plan_.sections[static_cast<std::size_t>(section)].obstacles;
      const auto size = static_cast<int>(list.size());
      if (number != size && number + 1 != size) rows.wrong("its obstacles are not in order");
      if (number == size) list.push_back({radius_m, {}});
      auto& places = list.back().at;
      if (!places.empty() && time <= places.back().time)
        rows.wrong("the places of an obstacle are not in order of time");
      places.push_back({time, {x_m, y_m}});
    }
    return done(rows);
  }

  bool notes() {
    Rows rows(database_, "SELECT number, section, text FROM notes ORDER BY number", "notes");
    while (rows.next()) {
      const std::int64_t section = rows.integer(0, last_section());
      std::string text = rows.text();
      if (rows.problem().empty()) plan_.sections[static_cast<std::size_t>(section)].notes.push_back(std::move(text));
    }
    return done(rows);
  }

  bool formations() {
    Rows rows(
        database_,
        "SELECT number, id, section, count, time_ns, frame, cells, in_picture, key, moved, pinned FROM formations "
        "ORDER BY number",
        "formations");
    while (rows.next()) {
      Formation formation;
      formation.id = rows.text();
      formation.section = SectionIndex::of(rows.integer(0, last_section()));
      formation.count = rows.real();
      formation.time = rows.instant();
      formation.frame = rows.optional_number();
      formation.cells = rows.cells(plan_.stage.grid.size());
      formation.in_picture = rows.number(0, kMostPerformers);
      formation.key = rows.number(0, 1) == 1;
      formation.moved = rows.number(0, kMostPerformers);
      formation.pinned = rows.number(0, kMostPerformers);
      if (formation.cells.size() != plan_.performers.size()) rows.wrong("not everybody has a cell");
      plan_.formations.push_back(std::move(formation));
    }
    return done(rows);
  }

  bool transitions() {
    Rows rows(database_,
              "SELECT number, start_ns, end_ns, clearance_m, closest_a, closest_b, closest_at_ns, longest_walk_m, "
              "longest_walker, tolerated_lag_s FROM transitions ORDER BY number",
              "transitions");
    const auto last = static_cast<std::int64_t>(plan_.performers.size()) - 1;
    while (rows.next()) {
      TransitionFacts facts;
      facts.start = rows.instant();
      facts.end = rows.instant();
      facts.clearance_m = rows.real();
      facts.closest_a = PerformerIndex::of(rows.integer(0, last));
      facts.closest_b = PerformerIndex::of(rows.integer(0, last));
      facts.closest_at = rows.instant();
      facts.longest_walk_m = rows.real();
      facts.longest_walker = PerformerIndex::of(rows.integer(0, last));
      facts.tolerated_lag_s = rows.real();
      plan_.transitions.push_back(facts);
    }
    return done(rows);
  }

  Database& database_;
  Plan plan_;
  std::string digest_;
  std::string problem_;
};

}  // namespace

Result<Plan> read_plan(Database& database) { return PlanReader(database).read(); }

}  // namespace footlight::config
