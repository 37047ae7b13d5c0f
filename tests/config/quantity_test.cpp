// SPDX-License-Identifier: Apache-2.0
#include "config/quantity.hpp"

#include <regex>

#include <gtest/gtest.h>

namespace footlight::config {
namespace {

double value(std::string_view text, Dimension dimension) {
  const auto parsed = parse_quantity(text, dimension);
  EXPECT_TRUE(parsed.value) << text << ": " << parsed.text;
  return parsed.value.value_or(-1);
}

std::string error(std::string_view text, Dimension dimension) {
  const auto parsed = parse_quantity(text, dimension);
  EXPECT_FALSE(parsed.value);
  return parsed.text + " (" + parsed.hint + ")";
}

TEST(Quantity, ComesInTheBaseUnit) {
  EXPECT_DOUBLE_EQ(value("1 m", Dimension::length), 1);
  EXPECT_DOUBLE_EQ(value("50cm", Dimension::length), 0.5);
  EXPECT_DOUBLE_EQ(value("2 ft", Dimension::length), 0.6096);
  EXPECT_DOUBLE_EQ(value("12 in", Dimension::length), 0.3048);
  EXPECT_DOUBLE_EQ(value("3.6 km/h", Dimension::speed), 1);
  EXPECT_DOUBLE_EQ(value("250 ms", Dimension::time), 0.25);
  EXPECT_DOUBLE_EQ(value("2 min", Dimension::time), 120);
  EXPECT_DOUBLE_EQ(value("30 m²", Dimension::area), 30);
  EXPECT_DOUBLE_EQ(value("1 count", Dimension::counts), 1);
  EXPECT_DOUBLE_EQ(value(" 1e1  counts ", Dimension::counts), 10);
}

TEST(Quantity, WithoutUnitNamesTheUnits) {
  EXPECT_EQ(error("0.5", Dimension::length),
            "\"0.5\" has no unit (write for example \"0.5 m\"; units: m, cm, mm, ft, in)");
  EXPECT_EQ(error("1.4", Dimension::speed),
            "\"1.4\" has no unit (write for example \"1.4 m/s\"; units: m/s, km/h, ft/s)");
  EXPECT_EQ(error("3 m", Dimension::time),
            "\"m\" is not a unit of a time (write for example \"3.2 s\"; units: s, ms, min)");
  EXPECT_EQ(error("soon", Dimension::time), "\"soon\" is not a time (write for example \"3.2 s\"; units: s, ms, min)");
  EXPECT_EQ(error("inf s", Dimension::time),
            "\"inf s\" is not a time (write for example \"3.2 s\"; units: s, ms, min)");
}

TEST(Quantity, OfACountNamesTheInstant) {
  EXPECT_EQ(parse_at_count("count 233").value, 233);
  EXPECT_EQ(parse_at_count("count 1.5").value, 1.5);
  EXPECT_EQ(parse_at_count("233").text, "\"233\" is not a count of the music");
  EXPECT_EQ(parse_at_count("233 counts").hint, "write for example \"count 233\"; the music begins at count 1");
}

TEST(Quantity, PatternsOfTheSchemaTakeWhatTheReaderTakes) {
  for (const auto& [text, dimension] : std::vector<std::pair<std::string, Dimension>>{{"1 m", Dimension::length},
                                                                                      {".5 ft", Dimension::length},
                                                                                      {"3.6 km/h", Dimension::speed},
                                                                                      {"250ms", Dimension::time},
                                                                                      {"1 count", Dimension::counts},
                                                                                      {"1e-3 s", Dimension::time},
                                                                                      {"1", Dimension::length},
                                                                                      {"m", Dimension::length},
                                                                                      {"1 s", Dimension::length},
                                                                                      {"x", Dimension::area}}) {
    EXPECT_EQ(std::regex_search(text, std::regex(pattern_of(dimension))),
              parse_quantity(text, dimension).value.has_value())
        << text;
  }
}

TEST(Range, IsPrintedAsPeopleSayIt) {
  EXPECT_EQ(to_text(Range{0, 10}, "m"), "0 to 10 m");
  EXPECT_EQ(to_text(Range{0, 10, true}, "m"), "above 0, at most 10 m");
  EXPECT_EQ(to_text(Range{.min = 1}, ""), "at least 1");
  EXPECT_EQ(to_text(Range{.max = 1}, ""), "at most 1");
  EXPECT_EQ(to_text(Range{1, 1}, ""), "1");
  EXPECT_EQ(to_text(Range{}, "m"), "");
}

}  // namespace
}  // namespace footlight::config
