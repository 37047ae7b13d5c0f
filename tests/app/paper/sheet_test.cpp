// SPDX-License-Identifier: Apache-2.0
#include "app/paper/sheet.hpp"

#include <cmath>
#include <map>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/export_files.hpp"
#include "tests/support/printed_words.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using test::text_of_pdf;
using ::testing::HasSubstr;

/// Names as casts have them.
tests::SmallShow cast_of(std::size_t people, std::uint64_t seed) {
  tests::SmallShow out = tests::random_show(40, 30, people, 3, 6, seed);
  const char* names[] = {"Zo\u00eb \u00c5ngstr\u00f6m", "\u5f20\u4f1f", "O'Brien, Se\u00e1n", "D10",
                         "Nguy\u1ec5n Th\u1ecb"};
  for (std::size_t p = 0; p < people; ++p) {
    Performer& performer = out.show.performers[p];
    performer.name = p < 5 ? names[p] : "D" + performer.id;
  }
  out.plan.title = "Of many, in the year of the great ceremony, with everybody who was ever there";
  return out;
}

std::string pdf_of(const tests::SmallShow& cast, const SheetFormat& format, const std::vector<std::size_t>& people,
                   const std::string& code = {}) {
  const Stamp stamp(cast.plan);
  const std::vector<Part> parts = parts_of(cast.plan, cast.show);
  Sheets sheets(cast.show, cast.plan, stamp, format);
  Canvas canvas = sheets.document("sheets");
  for (const std::size_t p : people) sheets.draw(canvas, PerformerIndex::of(p), parts[p], code);
  EXPECT_EQ(canvas.missing_characters(), 0) << "fonts-noto-cjk has them";
  return canvas.finish();
}

struct Told {
  double count;
  std::string measure;
  std::string cell;
  friend bool operator==(const Told&, const Told&) = default;
};

/// What the sheet says of when and where.
std::vector<Told> told_in(const std::string& text) {
  std::vector<Told> out;
  const std::regex row("(?:^|\n)([0-9.]+)\n([0-9]+:[0-9.]+)\n([A-Z]+[0-9]+)(?=\n| )");
  for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) {
    out.push_back({std::stod((*at)[1]), (*at)[2], (*at)[3]});
  }
  return out;
}

TEST(Sheets, TenRandomOnesSayWhatMarksCsvSays) {
  const tests::SmallShow cast = cast_of(60, 7);
  std::istringstream csv(marks_csv(cast.plan, cast.show));
  std::map<std::string, std::vector<Told>> marks;
  std::map<std::string, std::vector<Point>> ways;
  std::string line;
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    std::istringstream fields(line);
    std::vector<std::string> field;
    for (std::string one; std::getline(fields, one, ',');) field.push_back(one);
    const double count = std::stod(field[1]);
    std::vector<Told>& mine = marks[field[0]];
    const std::string cell = cell_name({std::stoi(field[3]), std::stoi(field[4])});
    if (!mine.empty() && mine.back().cell == cell) continue;
    mine.push_back({count, cast.show.tempo.measure_beat(count), cell});
    ways[field[0]].push_back({std::stod(field[5]), std::stod(field[6])});
  }
  Rng rng(99);
  for (int i = 0; i < 10; ++i) {
    const std::size_t p = rng.below(60);
    const std::string text = text_of_pdf(pdf_of(cast, {}, {p}), "-raw");
    const std::string id = cast.plan.performers[p];
    EXPECT_EQ(told_in(text), marks[id]) << id << "\n" << text;
    // Every walk: so many steps of so many centimetres are the way between the two marks.
    std::string flat = std::regex_replace(text, std::regex("\n"), " ");
    const std::regex way(
        "([0-9]+) steps [a-z ]+\\([a-z ]+\\), (left|right) foot first, ([0-9]+) cm each, there at ([0-9.]+)");
    std::size_t k = 0;
    for (std::sregex_iterator at(flat.begin(), flat.end(), way), end; at != end; ++at) {
      const double arrive = std::stod((*at)[4]);
      while (k + 1 < marks[id].size() && marks[id][k + 1].count != arrive) ++k;
      ASSERT_LT(k + 1, marks[id].size()) << "nobody arrives at " << arrive;
      const int steps = std::stoi((*at)[1]);
      EXPECT_NEAR(100 * distance(ways[id][k], ways[id][k + 1]) / steps, std::stod((*at)[3]), 0.5 + 1e-9) << arrive;
      const bool odd = std::lround(marks[id][k].count) % 2 != 0;
      if (steps == std::lround(arrive - marks[id][k].count)) {
        EXPECT_EQ((*at)[2].str(), odd ? "left" : "right") << arrive;
      }
    }
    EXPECT_GT(k, 10U) << "walks were found";
  }
}

TEST(Sheets, NoWordsOverlapAndNoneLeavesThePage) {
  const tests::SmallShow cast = cast_of(12, 3);
  for (const PaperSize& paper : {kA4, kLetter, kPhone}) {
    for (const int cards : {1, 2, 4}) {
      for (const Language language : {Language::english, Language::chinese}) {
        if (paper.width_pt < 300 && cards > 1) continue;
        SheetFormat format;
        format.paper = paper;
        format.a_page = cards;
        format.words.language = language;
        format.words.style = cards == 2 ? PlaceStyle::drill : PlaceStyle::stage;
        const auto pages = test::printed_words(pdf_of(cast, format, {0, 1, 2, 3}, std::string(150, 'x')));
        ASSERT_FALSE(pages.empty());
        for (const auto& page : pages) {
          EXPECT_GT(page.size(), 20U);
          test::expect_words_apart(page, paper.width_pt, paper.height_pt, std::to_string(cards) + " cards");
        }
      }
    }
  }
}

TEST(Sheets, SayWhoseTheyAreAndWhichPlan) {
  const tests::SmallShow cast = cast_of(12, 3);
  const std::string text = text_of_pdf(pdf_of(cast, {}, {0, 1, 2, 4}), "-layout");
  for (const char* words : {"ngstr\u00f6m", "\u5f20\u4f1f", "O'Brien, Se\u00e1n", "Nguy\u1ec5n", "stage left"}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
  const Stamp stamp(cast.plan);
  EXPECT_THAT(text, HasSubstr("plan " + stamp.plan));
  EXPECT_THAT(text, HasSubstr("Of many, in"));
}

TEST(Sheets, TheSamePlanGivesTheSameBytes) {
  const tests::SmallShow cast = cast_of(12, 3);
  EXPECT_EQ(pdf_of(cast, {}, {0}), pdf_of(cast, {}, {0}));
}

TEST(Sheets, AChangeOfOnesOwnPlaceChangesOnesDigits) {
  tests::SmallShow cast = cast_of(12, 3);
  const SheetWords words(cast.show, cast.plan, {});
  const auto before = parts_of(cast.plan, cast.show);
  std::swap(cast.plan.tracks[0][3].cell, cast.plan.tracks[1][3].cell);
  const auto after = parts_of(cast.plan, cast.show);
  EXPECT_NE(digits_of(words.rows_of(before[0])), digits_of(words.rows_of(after[0])));
  EXPECT_EQ(digits_of(words.rows_of(before[0])), digits_of(words.rows_of(before[0])));
}

}  // namespace
}  // namespace footlight::app
