// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostic.hpp"

namespace footlight::config {

/// One field of a CSV file with its place.
struct CsvField {
  std::string text;
  int line = 0;
  int column = 0;  ///< of its first character, code points
};

/// A CSV file (RFC 4180: comma, quotes doubled inside of quotes, LF or CRLF) with a header row. Blank lines and lines
/// that begin with # are left out; blanks around fields, too.
struct CsvTable {
  std::string file;
  std::vector<CsvField> header;
  std::vector<std::vector<CsvField>> rows;  ///< each as long as the header

  /// Which column has the name; nothing when there is none.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  [[nodiscard]] Position at(const CsvField& field) const { return {file, field.line, field.column}; }
};

inline constexpr std::size_t kMaxCsvBytes = std::size_t{64} << 20U;

/// Reads a table. Reports unknown columns (with the nearest of `columns`; none: any may stand there), columns that
/// stand twice, and rows of another length than the header; such rows are left out.
/// @return nothing when the file has no header or its text is no CSV in UTF-8
[[nodiscard]] std::optional<CsvTable> parse_csv(std::string_view bytes, const std::string& file,
                                                const std::vector<std::string>& columns, Diagnostics& diagnostics);

}  // namespace footlight::config
