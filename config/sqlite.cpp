// SPDX-License-Identifier: Apache-2.0
#include "config/sqlite.hpp"

#include <cstring>
#include <utility>

#include <sqlite3.h>

namespace footlight::config {
namespace {

/// Steps of SQLite's machine that one statement may take: far above what the largest plan needs, and the end of a
/// harmed file that would go round in circles.
constexpr int kMostOperations = 1'000'000'000;

constexpr int kBusy_ms = 200;  // somebody reads: its writer waits so long, in a thread of its own

int give_up(void* /*unused*/) { return 1; }

Result<sqlite3*> open_memory() {
  sqlite3* database = nullptr;
  if (sqlite3_open_v2(":memory:", &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX,
                      nullptr) != SQLITE_OK) {
    sqlite3_close(database);
    return internal_error("SQLite cannot make a database in memory");
  }
  return database;
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement& Statement::bind(std::int64_t value) {
  failed_ |= sqlite3_bind_int64(statement_.get(), next_++, value) != SQLITE_OK;
  return *this;
}
Statement& Statement::bind(double value) {
  failed_ |= sqlite3_bind_double(statement_.get(), next_++, value) != SQLITE_OK;
  return *this;
}
Statement& Statement::bind(std::string_view value) {
  failed_ |= sqlite3_bind_text64(statement_.get(), next_++, value.data() == nullptr ? "" : value.data(), value.size(),
                                 SQLITE_TRANSIENT, SQLITE_UTF8) != SQLITE_OK;
  return *this;
}
Statement& Statement::bind_blob(std::string_view value) {
  failed_ |= sqlite3_bind_blob64(statement_.get(), next_++, value.data() == nullptr ? "" : value.data(), value.size(),
                                 SQLITE_TRANSIENT) != SQLITE_OK;
  return *this;
}
Statement& Statement::bind_null() {
  failed_ |= sqlite3_bind_null(statement_.get(), next_++) != SQLITE_OK;
  return *this;
}

bool Statement::run() {
  failed_ |= sqlite3_step(statement_.get()) != SQLITE_DONE;
  sqlite3_reset(statement_.get());
  next_ = 1;
  return !failed_;
}

bool Statement::step() {
  if (failed_) return false;
  const int result = sqlite3_step(statement_.get());
  failed_ = result != SQLITE_ROW && result != SQLITE_DONE;
  return result == SQLITE_ROW;
}

std::optional<std::int64_t> Statement::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) return std::nullopt;
  return sqlite3_column_int64(statement_.get(), column);
}
std::optional<double> Statement::real(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_FLOAT) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}
std::optional<std::string> Statement::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) return std::nullopt;
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  if (data == nullptr) return std::nullopt;
  return std::string(data, size);
}
std::optional<std::string> Statement::blob(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_BLOB) return std::nullopt;
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return data == nullptr ? std::string() : std::string(data, size);
}
bool Statement::null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Result<Database> Database::make() {
  auto opened = open_memory();
  if (!opened) return std::move(opened).error();
  Database out;
  out.database_.reset(*opened);
  return out;
}

Result<Database> Database::from(std::string_view file_content) {
  auto out = make();
  if (!out) return out;
  sqlite3* database = out->database_.get();
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(file_content.size() + 1));
  if (copy == nullptr) return internal_error("out of memory");
  std::memcpy(copy, file_content.data(), file_content.size());
  // On failure SQLite frees the copy itself.
  const auto size = static_cast<sqlite3_int64>(file_content.size());
  if (sqlite3_deserialize(database, "main", copy, size, size,
                          SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_READONLY) != SQLITE_OK) {
    return input_error(sqlite3_errmsg(database));
  }
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_progress_handler(database, kMostOperations, give_up, nullptr);
  if (!out->execute("PRAGMA cell_size_check = ON")) return input_error(out->last_error());
  return out;
}

Result<Database> Database::open(const std::string& file, Use use) {
  sqlite3* database = nullptr;
  const int flags = use == Use::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int opened = sqlite3_open_v2(file.c_str(), &database, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  Database out;
  out.database_.reset(database);
  if (opened != SQLITE_OK) return input_error(database == nullptr ? "out of memory" : out.last_error());
  sqlite3_busy_timeout(database, kBusy_ms);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (use == Use::write && (!out.execute("PRAGMA journal_mode = WAL") || !out.execute("PRAGMA synchronous = NORMAL"))) {
    return input_error(out.last_error());
  }
  return out;
}

bool Database::execute(const char* sql) {
  return sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK;
}

Statement Database::prepare(const char* sql) {
  Statement out;
  sqlite3_stmt* statement = nullptr;
  out.failed_ = sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK;
  out.statement_.reset(statement);
  return out;
}

std::string Database::content() const {
  sqlite3_int64 size = 0;
  unsigned char* data = sqlite3_serialize(database_.get(), "main", &size, 0);
  if (data == nullptr) return {};
  std::string out(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
  sqlite3_free(data);
  return out;
}

std::string Database::last_error() const { return sqlite3_errmsg(database_.get()); }

std::int64_t Database::last_row() const { return sqlite3_last_insert_rowid(database_.get()); }

}  // namespace footlight::config
