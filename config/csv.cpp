// SPDX-License-Identifier: Apache-2.0
#include "config/csv.hpp"

#include <algorithm>

#include "config/nearest.hpp"
#include "config/text_scan.hpp"

namespace footlight::config {
namespace {

/// Walks over the bytes, field by field, and knows where it is.
class CsvScanner {
 public:
  explicit CsvScanner(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool at_end() const { return i_ >= bytes_.size(); }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] int column() const { return column_; }
  [[nodiscard]] bool bad_quote() const { return bad_quote_; }

  /// The fields of one line (a quoted field may go over several).
  std::vector<CsvField> row() {
    std::vector<CsvField> out;
    bool more = true;
    while (more && !bad_quote_) {
      out.push_back(field());
      more = !at_end() && bytes_[i_] == ',';
      if (more) step();
    }
    if (!at_end() && bytes_[i_] == '\r') step();
    if (!at_end() && bytes_[i_] == '\n') step();
    return out;
  }

  void skip_line() {
    while (!at_end() && bytes_[i_] != '\n') step();
    if (!at_end()) step();
  }

  [[nodiscard]] bool line_is_blank_or_comment() const {
    std::size_t k = i_;
    while (k < bytes_.size() && (bytes_[k] == ' ' || bytes_[k] == '\t' || bytes_[k] == '\r')) ++k;
    return k == bytes_.size() || bytes_[k] == '\n' || bytes_[k] == '#';
  }

 private:
  [[nodiscard]] bool on_blank() const { return !at_end() && (bytes_[i_] == ' ' || bytes_[i_] == '\t'); }
  [[nodiscard]] bool on_end_of_field() const {
    return at_end() || bytes_[i_] == ',' || bytes_[i_] == '\n' || bytes_[i_] == '\r';
  }

  CsvField field() {
    while (on_blank()) step();
    CsvField out{{}, line_, column_};
    if (!at_end() && bytes_[i_] == '"') {
      quoted(out.text);
      while (on_blank()) step();
      bad_quote_ = bad_quote_ || !on_end_of_field();
      return out;
    }
    while (!on_end_of_field()) {
      out.text += bytes_[i_];
      step();
    }
    while (!out.text.empty() && (out.text.back() == ' ' || out.text.back() == '\t')) out.text.pop_back();
    return out;
  }

  void quoted(std::string& text) {
    step();
    for (;;) {
      if (at_end()) {
        bad_quote_ = true;
        return;
      }
      const bool quote = bytes_[i_] == '"';
      if (quote && (i_ + 1 >= bytes_.size() || bytes_[i_ + 1] != '"')) break;
      if (quote) step();
      text += bytes_[i_];
      step();
    }
    step();
  }

  void step() {
    const char c = bytes_[i_++];
    if (c == '\n') {
      ++line_;
      column_ = 1;
    } else if ((static_cast<unsigned char>(i_ < bytes_.size() ? bytes_[i_] : ' ') & 0xC0U) != 0x80U) {
      ++column_;
    }
  }

  std::string_view bytes_;
  std::size_t i_ = 0;
  int line_ = 1;
  int column_ = 1;
  bool bad_quote_ = false;
};

void check_header(const CsvTable& table, const std::vector<std::string>& columns, Diagnostics& diagnostics) {
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const CsvField& name = table.header[c];
    if (!columns.empty() && std::find(columns.begin(), columns.end(), name.text) == columns.end()) {
      diagnostics.error(table.at(name), "", "unknown column " + in_quotes(name.text),
                        suggestion(name.text, columns, "known columns"));
    }
    const auto first = std::find_if(table.header.begin(), table.header.begin() + static_cast<std::ptrdiff_t>(c),
                                    [&](const CsvField& f) { return f.text == name.text; });
    if (first != table.header.begin() + static_cast<std::ptrdiff_t>(c)) {
      diagnostics.error(table.at(name), "", "the column " + in_quotes(name.text) + " stands here for the second time",
                        "keep one of the two");
    }
  }
}

/// NUL, control characters or invalid UTF-8.
bool refuse_bytes(std::string_view bytes, const std::string& file, Diagnostics& diagnostics) {
  const TextLimits no_flow{bytes.size() + 1, bytes.size() + 1, 0,
                           static_cast<int>(std::min<std::size_t>(bytes.size() + 1, 1U << 30U))};
  const auto findings = scan_text(bytes, no_flow);
  if (findings.empty()) return false;
  const LineIndex::Place place = LineIndex(bytes).place_of(findings.front().offset);
  diagnostics.error({file, place.line, place.column}, "", findings.front().text, "a CSV file is UTF-8 text");
  return true;
}

}  // namespace

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find_if(header.begin(), header.end(), [&](const CsvField& f) { return f.text == name; });
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::optional<CsvTable> parse_csv(std::string_view bytes, const std::string& file,
                                  const std::vector<std::string>& columns, Diagnostics& diagnostics) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);
  if (refuse_bytes(bytes, file, diagnostics)) return std::nullopt;
  CsvTable table{file, {}, {}};
  CsvScanner scanner(bytes);
  while (!scanner.at_end()) {
    if (scanner.line_is_blank_or_comment()) {
      scanner.skip_line();
      continue;
    }
    auto row = scanner.row();
    if (scanner.bad_quote()) {
      diagnostics.error({file, row.back().line, row.back().column}, "", "this quote does not end where the field ends",
                        "double the quotes inside of a field");
      return std::nullopt;
    }
    if (table.header.empty()) {
      table.header = std::move(row);
      check_header(table, columns, diagnostics);
    } else if (row.size() != table.header.size()) {
      diagnostics.error({file, row.front().line, 1}, "", std::to_string(row.size()) + " fields",
                        "as many as the header has: " + std::to_string(table.header.size()));
    } else {
      table.rows.push_back(std::move(row));
    }
  }
  if (table.header.empty()) {
    diagnostics.error({file, 0, 0}, "", "the file is empty", suggestion("", columns, "it begins with a header of"));
    return std::nullopt;
  }
  return table;
}

}  // namespace footlight::config
