// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace footlight::config {

/// What a written value measures. Values are held in the first unit: metres, metres a second, seconds, square metres,
/// counts, ampere, radians.
enum class Dimension { length, speed, time, area, counts, current, angle };

/// An interval of values, in the base unit.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is excluded

  [[nodiscard]] bool contains(double value) const { return (above_min ? value > min : value >= min) && value <= max; }
  [[nodiscard]] bool bounded() const { return min > -1e300 || max < 1e300; }
};

/// A decimal number and nothing else; no infinity, no NaN.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// A whole number that fits into an int, decimal or 0x..., and nothing else.
[[nodiscard]] std::optional<int> parse_integer(std::string_view text);

/// A quantity, or what was wrong with its text.
struct ParsedQuantity {
  std::optional<double> value;
  std::string text;  ///< of the error
  std::string hint;
};
/// "1.5 m", "4.2 km/h", "200 ms", "30 m2", "8 counts": number, blanks, unit.
[[nodiscard]] ParsedQuantity parse_quantity(std::string_view text, Dimension dimension);
/// "count 233": an instant of the music.
[[nodiscard]] ParsedQuantity parse_at_count(std::string_view text);

/// "m, cm, mm, ft, in"
[[nodiscard]] std::string units_of(Dimension dimension);
/// The unit of the value in memory: "m", "m/s", "s", "m2", "counts", "A", "rad".
[[nodiscard]] std::string_view base_unit(Dimension dimension);
/// Regular expression of the written form, for JSON Schema.
[[nodiscard]] std::string pattern_of(Dimension dimension);

/// Shortest decimal form that reads back as the same number, six digits where that is not short.
[[nodiscard]] std::string plain(double value);
/// "0 to 10 m", "above 0, at most 10 m", "at least 1"; empty when unbounded. @param unit may be empty
[[nodiscard]] std::string to_text(const Range& range, std::string_view unit);

}  // namespace footlight::config
