// SPDX-License-Identifier: Apache-2.0
#include "config/quantity.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

namespace footlight::config {
namespace {

struct Unit {
  std::string_view name;
  double factor;  // to the base unit
};
constexpr std::array kLengths{Unit{"m", 1}, Unit{"cm", 0.01}, Unit{"mm", 0.001}, Unit{"ft", 0.3048},
                              Unit{"in", 0.0254}};
constexpr std::array kSpeeds{Unit{"m/s", 1}, Unit{"km/h", 1 / 3.6}, Unit{"ft/s", 0.3048}};
constexpr std::array kTimes{Unit{"s", 1}, Unit{"ms", 0.001}, Unit{"min", 60}};
constexpr std::array kAreas{Unit{"m2", 1}, Unit{"m²", 1}, Unit{"ft2", 0.3048 * 0.3048}};
constexpr std::array kCounts{Unit{"counts", 1}, Unit{"count", 1}};
constexpr std::array kCurrents{Unit{"A", 1}, Unit{"mA", 0.001}};
constexpr std::array kAngles{Unit{"rad", 1}, Unit{"deg", std::numbers::pi / 180}};

std::span<const Unit> units(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return kLengths;
    case Dimension::speed:
      return kSpeeds;
    case Dimension::time:
      return kTimes;
    case Dimension::area:
      return kAreas;
    case Dimension::counts:
      return kCounts;
    case Dimension::current:
      return kCurrents;
    case Dimension::angle:
      return kAngles;
  }
  return kLengths;
}

std::string_view example(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "0.5 m";
    case Dimension::speed:
      return "1.4 m/s";
    case Dimension::time:
      return "3.2 s";
    case Dimension::area:
      return "30 m2";
    case Dimension::counts:
      return "8 counts";
    case Dimension::current:
      return "20 mA";
    case Dimension::angle:
      return "30 deg";
  }
  return "";
}

std::string_view name_of(Dimension dimension) {
  constexpr std::array<std::string_view, 7> kNames{"length",           "speed",   "time", "area",
                                                   "number of counts", "current", "angle"};
  return kNames.at(static_cast<std::size_t>(dimension));
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// The number that begins `text`, which is shortened by it.
std::optional<double> take_number(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto value = take_number(text);
  return text.empty() ? value : std::nullopt;
}

std::optional<int> parse_integer(std::string_view text) {
  int value = 0;
  const int base = text.substr(0, 2) == "0x" ? 16 : 10;
  if (base == 16) text.remove_prefix(2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = trimmed(text);
  const auto number = take_number(rest);
  const std::string hint = "write for example " + quoted(example(dimension)) + "; units: " + units_of(dimension);
  if (!number) return {{}, quoted(text) + " is not a " + std::string(name_of(dimension)), hint};
  rest = trimmed(rest);
  if (rest.empty()) return {{}, quoted(text) + " has no unit", hint};
  for (const Unit& unit : units(dimension)) {
    if (rest == unit.name) return {*number * unit.factor, {}, {}};
  }
  return {{}, quoted(rest) + " is not a unit of a " + std::string(name_of(dimension)), hint};
}

ParsedQuantity parse_at_count(std::string_view text) {
  constexpr std::string_view kHint = "write for example \"count 233\"; the music begins at count 1";
  std::string_view rest = trimmed(text);
  if (rest.substr(0, 6) != "count ") {
    return {{}, quoted(text) + " is not a count of the music", std::string(kHint)};
  }
  const auto number = parse_number(trimmed(rest.substr(6)));
  if (!number) return {{}, quoted(text) + " is not a count of the music", std::string(kHint)};
  return {number, {}, {}};
}

std::string units_of(Dimension dimension) {
  std::string out;
  for (const Unit& unit : units(dimension)) out += (out.empty() ? "" : ", ") + std::string(unit.name);
  return out;
}

std::string_view base_unit(Dimension dimension) { return units(dimension).front().name; }

std::string pattern_of(Dimension dimension) {
  std::string alternatives;
  for (const Unit& unit : units(dimension)) alternatives += (alternatives.empty() ? "" : "|") + std::string(unit.name);
  return "^ *-?[0-9]*\\.?[0-9]+([eE][-+]?[0-9]+)? *(" + alternatives + ") *$";
}

std::string plain(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  if (std::fabs(value) >= 1e6 && std::fabs(value) < 1e15 && value == std::floor(value)) {
    std::snprintf(text, sizeof text, "%.0f", value);
  }
  return text;
}

std::string to_text(const Range& range, std::string_view unit) {
  const bool low = range.min > -1e300;
  const bool high = range.max < 1e300;
  const std::string tail = unit.empty() ? "" : " " + std::string(unit);
  if (low && range.min == range.max) return plain(range.min) + tail;
  if (low && high) {
    return range.above_min ? "above " + plain(range.min) + ", at most " + plain(range.max) + tail
                           : plain(range.min) + " to " + plain(range.max) + tail;
  }
  if (low) return (range.above_min ? "above " : "at least ") + plain(range.min) + tail;
  if (high) return "at most " + plain(range.max) + tail;
  return "";
}

}  // namespace footlight::config
