// SPDX-License-Identifier: Apache-2.0
#include "app/paper/part_page.hpp"

#include <algorithm>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/paper/qr_code.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> sections_of(const std::string& page) {
  std::vector<std::string> out;
  for (std::size_t at = page.find("<section"); at != std::string::npos; at = page.find("<section", at + 1)) {
    out.push_back(page.substr(at, page.find("</section>", at) - at));
  }
  return out;
}

/// By how much the arrow of a walk is turned, clockwise from forward.
int turn_of(Point walk) {
  tests::SmallShow cast = tests::random_show(20, 12, 1, 1, 1, 3);
  const Grid& grid = cast.plan.stage.grid;
  const Cell from{10, 6};
  const Cell to{from.column + static_cast<int>(walk.x), from.row + static_cast<int>(walk.y)};
  cast.plan.tracks[0] = {{cast.plan.tracks[0].front().time, grid.index(from)},
                         {cast.plan.tracks[0].back().time, grid.index(to)}};
  const PartPages pages(cast.show, cast.plan, Stamp(cast.plan), {});
  const std::string page = pages.page_of(PerformerIndex(0), parts_of(cast.plan, cast.show)[0]);
  std::smatch match;
  EXPECT_TRUE(
      std::regex_search(page, match, std::regex("class=\"way\"><svg[^>]*><path transform=\"rotate\\((-?[0-9]+)")));
  return match.empty() ? 999 : std::stoi(match[1]);
}

TEST(PartPages, ArrowsPointAsWhoFacesTheAudienceWalks) {
  EXPECT_EQ(turn_of({0, -3}), 0) << "downstage is forward";
  EXPECT_EQ(turn_of({3, 0}), -90) << "stage left is to the left";
  EXPECT_EQ(turn_of({-3, 0}), 90);
  EXPECT_EQ(turn_of({-3, -3}), 45);
  EXPECT_EQ(std::abs(turn_of({0, 3})), 180);
}

TEST(PartPages, SayWhatTheSheetSays) {
  const tests::SmallShow cast = tests::random_show(20, 12, 12, 3, 4, 8);
  const auto parts = parts_of(cast.plan, cast.show);
  const SheetWords words(cast.show, cast.plan, {});
  const PartPages pages(cast.show, cast.plan, Stamp(cast.plan), {});
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto rows = words.rows_of(parts[p]);
    const std::string page = pages.page_of(PerformerIndex::of(p), parts[p]);
    const auto sections = sections_of(page);
    ASSERT_EQ(sections.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const std::string& said : {"<b>" + rows[i].count + "</b> <i>" + rows[i].measure + "</i>",
                                      "<b>" + rows[i].cell + "</b> " + rows[i].place, rows[i].way, rows[i].stay,
                                      rows[i].closest, rows[i].light}) {
        EXPECT_THAT(sections[i], HasSubstr(said));
      }
    }
    EXPECT_THAT(page, HasSubstr("part " + digits_of(rows) + "</footer>")) << "as on paper";
  }
}

TEST(PartPages, NamesAreTextAndNoMarkup) {
  tests::SmallShow cast = tests::random_show(20, 12, 2, 1, 2, 3);
  cast.show.performers[0].name = "<script>alert(1)</script> & \"Co\"";
  const PartPages pages(cast.show, cast.plan, Stamp(cast.plan), {});
  const std::string page = pages.page_of(PerformerIndex(0), parts_of(cast.plan, cast.show)[0]);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;Co&quot;"));
  EXPECT_THAT(parts_index({{"A<b>", "a b.html"}}, Stamp(cast.plan), Language::english),
              HasSubstr("<a href=\"a%20b.html\">A&lt;b&gt;</a>"));
}

TEST(PartText, IsWholeOrCountsWhatIsLeftOut) {
  const tests::SmallShow cast = tests::random_show(20, 12, 4, 3, 6, 8);
  const auto parts = parts_of(cast.plan, cast.show);
  const Stamp stamp(cast.plan);
  const auto text = [&](std::size_t most) {
    return part_text(cast.show, cast.plan, stamp, PerformerIndex(0), parts[0], Language::english, most);
  };
  const std::string whole = text(10000);
  EXPECT_THAT(whole, StartsWith(cast.show.performers[0].name + "\n" + stamp.title + " " + stamp.plan + "\n"));
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(whole, '\n')), parts[0].size() + 1);
  EXPECT_EQ(text(whole.size()), whole);
  for (std::size_t most = 0; most < whole.size(); ++most) {
    const std::string part = text(most);
    ASSERT_LE(part.size(), most);
    if (part.empty()) continue;
    const auto told = static_cast<std::size_t>(std::ranges::count(part, '\n')) - 2;
    EXPECT_TRUE(part.ends_with("\nand " + std::to_string(parts[0].size() - told) + " more")) << part;
    EXPECT_THAT(whole, StartsWith(part.substr(0, part.rfind('\n'))));
  }
}

TEST(QrCode, HoldsWhatFitsOnASheet) {
  EXPECT_FALSE(qr_code(""));
  EXPECT_FALSE(qr_code(std::string(kMostCodeBytes + 1, 'x')));
  const auto largest = qr_code(std::string(kMostCodeBytes, 'x'));
  ASSERT_TRUE(largest);
  EXPECT_EQ(largest->modules, 57);
  const auto small = qr_code("https://example.org/7.html");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->modules, 25) << "version 2";
  EXPECT_EQ(small->dark.size(), 625U);
  EXPECT_TRUE(small->dark[0]) << "the corner of a finder";
}

}  // namespace
}  // namespace footlight::app
