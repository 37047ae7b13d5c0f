// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace footlight {

/// A place in a text file; line and column count from 1, columns count characters (code points). Line 0: the file as a
/// whole.
struct Position {
  std::string file;
  int line = 0;
  int column = 0;

  friend auto operator<=>(const Position&, const Position&) = default;
};

enum class Severity { error, warning, note };

/// One thing that is wrong in a file. `text` says what was found, `hint` what would be right.
struct Diagnostic {
  Severity severity = Severity::error;
  Position position;
  std::string key_path;  ///< as "sections[0].sampling.interval"; empty when it concerns the file
  std::string text;
  std::string hint;

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

/// "file:line:col: error: key.path: text (hint)"; parts that are empty are left out. The only maker of such lines.
[[nodiscard]] std::string to_text(const Diagnostic& diagnostic);

/// All that is wrong with one or more files, gathered in one run.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic) { list_.push_back(std::move(diagnostic)); }
  void error(Position position, std::string key_path, std::string text, std::string hint = {});
  void warning(Position position, std::string key_path, std::string text, std::string hint = {});

  [[nodiscard]] bool has_errors() const;
  [[nodiscard]] bool empty() const { return list_.empty(); }
  /// Sorted by file, line, column, then order of arrival.
  [[nodiscard]] std::vector<Diagnostic> sorted() const;
  /// One line for each, sorted, each ended by a newline.
  [[nodiscard]] std::string to_text() const;

 private:
  std::vector<Diagnostic> list_;
};

}  // namespace footlight
