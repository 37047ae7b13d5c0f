// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "config/sqlite.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"

namespace footlight::config {

inline constexpr std::int64_t kPlanApplicationId = 0x464C5054;  ///< "FLPT"
inline constexpr std::int64_t kPlanVersion = 4;

/// The tables of a plan file; docs/plan-file.md says what stands in them. A file with any other schema is no plan.
inline constexpr std::array kPlanSchema{
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID",
    "CREATE TABLE stage(number INTEGER PRIMARY KEY, grid TEXT NOT NULL, columns INTEGER NOT NULL, rows INTEGER NOT "
    "NULL, "
    "pitch_m REAL NOT NULL, blocked BLOB NOT NULL, reserve BLOB NOT NULL, clearance_m REAL NOT NULL, "
    "max_speed_m_s REAL NOT NULL, lag_ns INTEGER NOT NULL, walk TEXT NOT NULL) STRICT",
    "CREATE TABLE performers(number INTEGER PRIMARY KEY, id TEXT NOT NULL, radius_m REAL NOT NULL, "
    "max_speed_m_s REAL NOT NULL) STRICT",
    "CREATE TABLE tracks(performer INTEGER PRIMARY KEY, marks BLOB NOT NULL) STRICT",
    "CREATE TABLE sections(number INTEGER PRIMARY KEY, name TEXT NOT NULL, start_ns INTEGER NOT NULL, "
    "end_ns INTEGER NOT NULL, max_speed_m_s REAL NOT NULL, reserve BLOB NOT NULL) STRICT",
    "CREATE TABLE films(section INTEGER PRIMARY KEY, path TEXT NOT NULL, first_frame INTEGER NOT NULL, "
    "last_frame INTEGER NOT NULL, show_fps REAL NOT NULL, width INTEGER NOT NULL, height INTEGER NOT NULL, "
    "threshold INTEGER NOT NULL, inverted INTEGER NOT NULL, a REAL NOT NULL, b REAL NOT NULL, c REAL NOT NULL, "
    "d REAL NOT NULL, e REAL NOT NULL, f REAL NOT NULL) STRICT",
    "CREATE TABLE obstacles(number INTEGER PRIMARY KEY, section INTEGER NOT NULL, obstacle INTEGER NOT NULL, "
    "radius_m REAL NOT NULL, time_ns INTEGER NOT NULL, x_m REAL NOT NULL, y_m REAL NOT NULL) STRICT",
    "CREATE TABLE notes(number INTEGER PRIMARY KEY, section INTEGER NOT NULL, text TEXT NOT NULL) STRICT",
    "CREATE TABLE formations(number INTEGER PRIMARY KEY, id TEXT NOT NULL, section INTEGER NOT NULL, "
    "count REAL NOT NULL, time_ns INTEGER NOT NULL, frame INTEGER, cells BLOB NOT NULL, in_picture INTEGER NOT NULL, "
    "key INTEGER NOT NULL, moved INTEGER NOT NULL, pinned INTEGER NOT NULL) "
    "STRICT",
    "CREATE TABLE transitions(number INTEGER PRIMARY KEY, start_ns INTEGER NOT NULL, end_ns INTEGER NOT NULL, "
    "clearance_m REAL NOT NULL, closest_a INTEGER NOT NULL, closest_b INTEGER NOT NULL, closest_at_ns INTEGER NOT "
    "NULL, "
    "longest_walk_m REAL NOT NULL, longest_walker INTEGER NOT NULL, tolerated_lag_s REAL NOT NULL) STRICT"};

/// Reads a plan out of a database that nobody vouches for: exactly the tables above, every value of its kind and in its
/// range, every list complete, and the digest over all of it right. Errors (ErrorKind::input): the first thing wrong,
/// as the end of a sentence.
[[nodiscard]] Result<Plan> read_plan(Database& database);

}  // namespace footlight::config
