// SPDX-License-Identifier: Apache-2.0
//
// Charts, floor plans and lists as they come out of a printer: words read from the PDFs.
#include "app/paper/poster.hpp"

#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/paper/flow.hpp"
#include "app/paper/lists.hpp"
#include "tests/support/printed_words.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using test::expect_words_apart;
using test::printed_words;

/// Formations know everybody's cells; names are short, long and Chinese; every cell has a lamp.
tests::SmallShow cast_on(GridKind kind, int columns, int rows, std::size_t people) {
  tests::SmallShow out = tests::random_show(columns, rows, people, 2, 2, 5);
  out.plan.stage.grid = *Grid::make(kind, columns, rows, 1);
  out.plan.title = "A title that goes on and on, as titles of ceremonies do, with a city, a year and a sponsor";
  for (Formation& formation : out.plan.formations) {
    for (const auto& track : out.plan.tracks) {
      const auto mark = std::ranges::find(track, formation.time, &Mark::time);
      formation.cells.push_back(mark->cell);
    }
  }
  const char* names[] = {"Zo\u00eb \u00c5ngstr\u00f6m-Wo\u017aniak", "\u5f20\u4f1f", "Seán O'Brien"};
  for (std::size_t p = 0; p < people; ++p) {
    out.show.performers[p].name = p < 3 ? names[p] : "D" + out.show.performers[p].id;
  }
  out.rig = tests::lamps_everywhere(out.plan.stage.grid, {BusKind::can, BusKind::modbus_rtu}, 115200);
  return out;
}

std::string pdf_with(const tests::SmallShow& cast, const PaperSize& paper, const auto& draw) {
  const Stamp stamp(cast.plan);
  Canvas canvas = Canvas::pdf(paper.width_pt, paper.height_pt, {"t", "s"});
  draw(canvas, stamp);
  EXPECT_EQ(canvas.missing_characters(), 0);
  return canvas.finish();
}

void expect_apart(const std::string& pdf, const PaperSize& paper, const std::string& where) {
  const auto pages = printed_words(pdf);
  ASSERT_FALSE(pages.empty());
  for (std::size_t i = 0; i < pages.size(); ++i) {
    expect_words_apart(pages[i], paper.width_pt, paper.height_pt, where + ", page " + std::to_string(i + 1));
  }
}

constexpr GridKind kKinds[] = {GridKind::square, GridKind::hexagonal, GridKind::triangular};

TEST(Charts, NoWordsOverlapAndNoneLeavesThePage) {
  for (const GridKind kind : kKinds) {
    const tests::SmallShow cast = cast_on(kind, 70, 60, 700);
    for (const PaperSize& paper : {kA4, kLetter}) {
      const std::string pdf = pdf_with(cast, paper, [&](Canvas& canvas, const Stamp& stamp) {
        draw_chart(canvas, paper, stamp, cast.plan, cast.show, FormationIndex(1));
      });
      expect_apart(pdf, paper, std::string(to_text(kind)));
    }
  }
}

TEST(Charts, EverybodyStandsWholeOnOneTile) {
  for (const GridKind kind : kKinds) {
    const tests::SmallShow cast = cast_on(kind, 70, 60, 700);
    const auto pages = printed_words(pdf_with(cast, kA4, [&](Canvas& canvas, const Stamp& stamp) {
      draw_chart(canvas, kA4, stamp, cast.plan, cast.show, FormationIndex(1));
    }));
    ASSERT_GT(pages.size(), 3U) << "an overview and tiles";
    std::map<std::string, int> seen;
    for (std::size_t i = 1; i < pages.size(); ++i) {
      for (const auto& word : pages[i]) {
        // Tiles have names of the same kind, in the heading.
        if (word.top > 60 && word.word[0] == 'D' && word.word.size() > 1 && word.word[1] <= '9') ++seen[word.word];
      }
    }
    // Columns are called D and more letters, so that a number after a D is a performer.
    EXPECT_EQ(seen.size(), 697U) << to_text(kind);
    for (const auto& [name, times] : seen) EXPECT_EQ(times, 1) << name;
  }
}

TEST(FloorPlan, NoWordsOverlapAndEveryCellIsThere) {
  for (const GridKind kind : kKinds) {
    const tests::SmallShow cast = cast_on(kind, 30, 40, 20);
    const std::string pdf = pdf_with(cast, kA4, [&](Canvas& canvas, const Stamp& stamp) {
      draw_floor_plan(canvas, kA4, stamp, cast.plan, cast.rig);
    });
    expect_apart(pdf, kA4, std::string(to_text(kind)));
    std::map<std::string, int> seen;
    const auto pages = printed_words(pdf);
    const std::regex cell("[A-Z]+[0-9]+");
    for (std::size_t i = 1; i < pages.size(); ++i) {
      for (const auto& word : pages[i]) {
        // Tiles have names of the same kind, in the heading.
        if (word.top > 60 && std::regex_match(word.word, cell)) ++seen[word.word];
      }
    }
    EXPECT_EQ(seen.size(), 1200U) << to_text(kind);
  }
}

TEST(Lists, NoWordsOverlapAndNoneLeavesThePage) {
  tests::SmallShow cast = cast_on(GridKind::square, 40, 30, 60);
  cast.show.cues[1].notes =
      std::string(40, 'w') + " and a note that is long enough to need more than one line of a page";
  cast.show.groups[0].name = "the ones who carry the very large banners through the middle of the stage";
  const auto parts = parts_of(cast.plan, cast.show);
  for (const PaperSize& paper : {kA4, kLetter, kPhone}) {
    for (const Language language : {Language::english, Language::chinese}) {
      const std::string calls = pdf_with(cast, paper, [&](Canvas& canvas, const Stamp& stamp) {
        Flow flow(canvas, paper, stamp);
        add_call_list(flow, cast.plan, cast.show, parts, std::nullopt, language);
        add_call_list(flow, cast.plan, cast.show, parts, GroupIndex(0), language);
      });
      expect_apart(calls, paper, "calls");
    }
    const std::string patch = pdf_with(cast, paper, [&](Canvas& canvas, const Stamp& stamp) {
      Flow flow(canvas, paper, stamp);
      add_patch_list(flow, cast.plan, cast.show, cast.rig);
    });
    expect_apart(patch, paper, "patch");
  }
}

}  // namespace
}  // namespace footlight::app
