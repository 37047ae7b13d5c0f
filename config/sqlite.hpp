// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace footlight::config {

/// One prepared statement: bind the parameters in their order, then step. Thread: one at a time.
class Statement {
 public:
  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(std::string_view value);
  Statement& bind_blob(std::string_view value);
  Statement& bind_null();

  /// Runs a statement that gives no rows and makes it ready for the next one. @return false on an error
  bool run();
  /// @return whether there is a row; false at the end and on an error (`failed`)
  bool step();
  [[nodiscard]] bool failed() const { return failed_; }

  // Values of the row; nothing when the column holds something of another kind.
  [[nodiscard]] std::optional<std::int64_t> integer(int column) const;
  [[nodiscard]] std::optional<double> real(int column) const;
  [[nodiscard]] std::optional<std::string> text(int column) const;
  [[nodiscard]] std::optional<std::string> blob(int column) const;
  [[nodiscard]] bool null(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int next_ = 1;
  bool failed_ = false;
};

/// An SQLite database. Plans live in memory, made from or turned into the bytes of a file: nothing beside the file is
/// read (no journal of a stranger), and what is written can be renamed into place as a whole. What grows while a show
/// runs is a file of its own.
class Database {
 public:
  /// An empty one. ErrorKind::internal when memory is out.
  static Result<Database> make();
  /// Read only, trusting nothing in it. Pages are checked as they are read. ErrorKind::input when it is no database.
  static Result<Database> from(std::string_view file_content);

  enum class Use : std::uint8_t { read, write };
  /// A file on the disk: for reading, or to be written as it grows (write-ahead log; made when it is not there). An
  /// SQLite file trusts its log and index beside it. ErrorKind::input with SQLite's words.
  static Result<Database> open(const std::string& file, Use use);

  bool execute(const char* sql);
  /// A statement that has failed already when `sql` does not fit the database.
  Statement prepare(const char* sql);
  /// The bytes of the file; empty on an error.
  [[nodiscard]] std::string content() const;
  /// SQLite's words for the last error.
  [[nodiscard]] std::string last_error() const;
  [[nodiscard]] std::int64_t last_row() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace footlight::config
