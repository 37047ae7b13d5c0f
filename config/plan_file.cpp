// SPDX-License-Identifier: Apache-2.0
#include "config/plan_file.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "config/output_file.hpp"
#include "config/plan_digest.hpp"
#include "config/plan_reader.hpp"
#include "config/sqlite.hpp"
#include "config/track_code.hpp"
#include "core/sha256.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMostPlanBytes = std::size_t{512} << 20U;

std::int64_t ns(Instant instant) { return instant.time_since_epoch().count(); }

void write_meta(Database& database, const Plan& plan) {
  Statement meta = database.prepare("INSERT INTO meta VALUES(?, ?)");
  const std::pair<std::string_view, std::string> values[] = {{"title", plan.title},
                                                             {"show_hash", plan.show_hash},
                                                             {"valid", plan.valid ? "1" : "0"},
                                                             {"digest", digest_of(plan)}};
  for (const auto& [key, value] : values) meta.bind(key).bind(std::string_view(value)).run();
  if (!plan.version.empty()) meta.bind(std::string_view("version")).bind(std::string_view(plan.version)).run();
}

void write_stage(Database& database, const Stage& stage) {
  Statement row = database.prepare("INSERT INTO stage VALUES(0, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  row.bind(to_text(stage.grid.kind()));
  row.bind(std::int64_t{stage.grid.columns()}).bind(std::int64_t{stage.grid.rows()}).bind(stage.grid.pitch_m());
  row.bind_blob(encode_cells(stage.blocked)).bind_blob(encode_cells(stage.reserve));
  row.bind(stage.clearance_m).bind(stage.max_speed_mps).bind(std::int64_t{stage.lag.count()});
  row.bind(to_text(stage.walk)).run();
}

void write_performers(Database& database, const Plan& plan) {
  Statement performer = database.prepare("INSERT INTO performers VALUES(?, ?, ?, ?)");
  Statement track = database.prepare("INSERT INTO tracks VALUES(?, ?)");
  for (std::size_t i = 0; i < plan.performers.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    performer.bind(number).bind(std::string_view(plan.performers[i])).bind(plan.radius_m[i]);
    performer.bind(plan.max_speed_mps[i]).run();
    track.bind(number).bind_blob(encode_track(plan.tracks[i])).run();
  }
}

void write_film(Statement& row, std::int64_t section, const FilmPlacement& film) {
  row.bind(section).bind(std::string_view(film.path));
  row.bind(std::int64_t{film.first_frame}).bind(std::int64_t{film.last_frame}).bind(film.show_fps);
  row.bind(std::int64_t{film.width}).bind(std::int64_t{film.height}).bind(std::int64_t{film.threshold});
  row.bind(std::int64_t{film.inverted ? 1 : 0});
  for (const double number : film.stage_to_frame) row.bind(number);
  row.run();
}

void write_sections(Database& database, const Plan& plan) {
  Statement row = database.prepare("INSERT INTO sections VALUES(?, ?, ?, ?, ?, ?)");
  Statement film = database.prepare("INSERT INTO films VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement note = database.prepare("INSERT INTO notes VALUES(?, ?, ?)");
  Statement obstacle = database.prepare("INSERT INTO obstacles VALUES(?, ?, ?, ?, ?, ?, ?)");
  std::int64_t places = 0;
  std::int64_t number = 0;
  std::int64_t notes = 0;
  for (const PlanSection& section : plan.sections) {
    row.bind(number).bind(std::string_view(section.name)).bind(ns(section.start)).bind(ns(section.end));
    row.bind(section.max_speed_mps).bind_blob(encode_cells(section.reserve)).run();
    if (section.film) write_film(film, number, *section.film);
    for (std::size_t o = 0; o < section.obstacles.size(); ++o) {
      for (const PlanObstacle::At& at : section.obstacles[o].at) {
        obstacle.bind(places++).bind(number).bind(static_cast<std::int64_t>(o)).bind(section.obstacles[o].radius_m);
        obstacle.bind(ns(at.time)).bind(at.centre.x).bind(at.centre.y).run();
      }
    }
    for (const std::string& text : section.notes) note.bind(notes++).bind(number).bind(std::string_view(text)).run();
    ++number;
  }
}

void write_formations(Database& database, const Plan& plan) {
  Statement row = database.prepare("INSERT INTO formations VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  std::int64_t number = 0;
  for (const Formation& formation : plan.formations) {
    row.bind(number++).bind(std::string_view(formation.id)).bind(std::int64_t{formation.section.value()});
    row.bind(formation.count).bind(ns(formation.time));
    if (formation.frame) {
      row.bind(std::int64_t{*formation.frame});
    } else {
      row.bind_null();
    }
    row.bind_blob(encode_cells(formation.cells)).bind(std::int64_t{formation.in_picture});
    row.bind(std::int64_t{formation.key ? 1 : 0}).bind(std::int64_t{formation.moved});
    row.bind(std::int64_t{formation.pinned}).run();
  }
}

void write_transitions(Database& database, const Plan& plan) {
  Statement row = database.prepare("INSERT INTO transitions VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  std::int64_t number = 0;
  for (const TransitionFacts& facts : plan.transitions) {
    row.bind(number++).bind(ns(facts.start)).bind(ns(facts.end)).bind(facts.clearance_m);
    row.bind(std::int64_t{facts.closest_a.value()}).bind(std::int64_t{facts.closest_b.value()});
    row.bind(ns(facts.closest_at)).bind(facts.longest_walk_m).bind(std::int64_t{facts.longest_walker.value()});
    row.bind(facts.tolerated_lag_s).run();
  }
}

/// The integer that a PRAGMA answers with.
std::int64_t pragma(Database& database, const char* sql) {
  Statement statement = database.prepare(sql);
  return statement.step() ? statement.integer(0).value_or(-1) : -1;
}

Result<std::string> content_of(const Plan& plan) {
  auto database = Database::make();
  if (!database) return std::move(database).error();
  bool whole = database->execute(
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; BEGIN", kPlanApplicationId, kPlanVersion)
          .c_str());
  for (const char* table : kPlanSchema) whole = whole && database->execute(table);
  write_meta(*database, plan);
  write_stage(*database, plan.stage);
  write_performers(*database, plan);
  write_sections(*database, plan);
  write_formations(*database, plan);
  write_transitions(*database, plan);
  whole = whole && database->execute("COMMIT");
  std::string content = database->content();
  if (!whole || content.empty()) return internal_error("SQLite: " + database->last_error());
  return content;
}

Result<Plan> plan_from(std::string_view content) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  if (content.substr(0, kMagic.size()) != kMagic) return input_error("it is no plan (footlight plan writes one)");
  auto database = Database::from(content);
  if (!database) return std::move(database).error();
  const std::int64_t application = pragma(*database, "PRAGMA application_id");
  const std::int64_t version = pragma(*database, "PRAGMA user_version");
  if (application != kPlanApplicationId) return input_error("it is no plan (footlight plan writes one)");
  if (version != kPlanVersion) {
    return input_error(
        fmt::format("it has version {}, this program reads version {} (plan the show again)", version, kPlanVersion));
  }
  auto plan = read_plan(*database);
  if (!plan) return input_error(fmt::format("it is harmed: {} (plan the show again)", plan.error().message));
  return plan;
}

}  // namespace

Status<> save_plan(const Plan& plan, const std::filesystem::path& file) {
  FL_CHECK(plan.tracks.size() == plan.performers.size() && plan.radius_m.size() == plan.performers.size() &&
           plan.max_speed_mps.size() == plan.performers.size());
  auto content = content_of(plan);
  if (!content) return std::move(content).error();
  // What cannot be read again is not written: a value that is not a number, say, is stored as none at all.
  if (auto again = plan_from(*content); !again)
    return internal_error("the plan cannot be saved: " + again.error().message);
  return write_file(file, *content);
}

Result<Plan> load_plan(const std::filesystem::path& file) {
  auto content = read_file(file, kMostPlanBytes);
  if (!content) return std::move(content).error();
  auto plan = plan_from(*content);
  if (!plan) return input_error(fmt::format("cannot use '{}': {}", file.string(), plan.error().message));
  return plan;
}

Result<std::string> hash_files(std::span<const std::string> files) {
  Sha256 sum;
  // Names as seen from the first file, so that a show may move with its folder.
  const std::filesystem::path home =
      files.empty() ? std::filesystem::path() : std::filesystem::path(files.front()).parent_path();
  for (const std::string& file : files) {
    Sha256 content;
    auto done = read_blocks(file, [&](std::string_view block) {
      content.bytes({reinterpret_cast<const std::uint8_t*>(block.data()), block.size()});
    });
    if (!done) return std::move(done).error();
    sum.text(std::filesystem::path(file).lexically_proximate(home).generic_string()).text(content.hex());
  }
  return sum.hex();
}

}  // namespace footlight::config
