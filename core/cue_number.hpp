// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace footlight {

/// A decimal cue number, exact: 12 < 12.05 < 12.1 < 12.5, and 12.10 equals 12.1.
class CueNumber {
 public:
  CueNumber() = default;
  /// Digits with at most one point and at most six decimals, below 10^9, at least 0.
  static std::optional<CueNumber> parse(std::string_view text);

  /// Shortest form: no trailing zeros.
  [[nodiscard]] std::string to_text() const;
  friend auto operator<=>(const CueNumber&, const CueNumber&) = default;

 private:
  std::int64_t millionths_ = 0;
};

}  // namespace footlight
