// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace footlight::app {

/// Columns of text under headings: the first aligned left, the others right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> headings) { rows_.push_back(std::move(headings)); }
  /// As many texts as there are headings.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string to_text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace footlight::app
