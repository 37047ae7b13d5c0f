// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/text_tree.hpp"

namespace footlight::config {

/// Turns byte offsets into lines and columns as people count them: from 1, columns in code points.
class LineIndex {
 public:
  /// @param text must live as long as the index
  explicit LineIndex(std::string_view text);
  struct Place {
    int line = 1;
    int column = 1;
  };
  /// @param line0, byte_column0 from 0; clamped to the text. O(column)
  [[nodiscard]] Place place(int line0, int byte_column0) const;
  [[nodiscard]] Place place_of(std::size_t offset) const;

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

/// What is wrong with the bytes as such.
struct ScanFinding {
  std::size_t offset = 0;
  std::string text;
  std::string hint;
};

/// Looks at bytes before a parser does: control characters, invalid UTF-8, flow collections that are nested too deep or
/// too long. Empty when there is nothing. O(bytes), no allocation.
[[nodiscard]] std::vector<ScanFinding> scan_text(std::string_view bytes, const TextLimits& limits);

/// Length of the well-formed UTF-8 sequence that begins at `offset`, 0 when there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view bytes, std::size_t offset);

}  // namespace footlight::config
