// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/grid.hpp"
#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class SheetsCommand : public test::PlannedStarterShow {
 protected:
  std::string text_of(const std::string& file) const {
    const Ran ran = test::run_program({"pdftotext", "-layout", file, folder_ / "text.txt"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return folder_.read("text.txt");
  }
  /// What the QR code on the first page of a PDF says, read by zbar; empty: there is none.
  std::string code_on(const std::string& pdf) const {
    EXPECT_EQ(test::run_program({"pdftoppm", "-r", "200", "-png", "-singlefile", pdf, folder_ / "code"}).status, 0);
    return test::run_program({"zbarimg", "--quiet", "--raw", "--nodbus", folder_ / "code.png"}).out;
  }
};

TEST_F(SheetsCommand, WritesOneFileOrAFolderOfEverything) {
  const Ran one = footlight({"sheets", show_, "-o", folder_ / "all.pdf"});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("all.pdf: 12 of 12 performers' sheets, plan "));
  EXPECT_THAT(text_of(folder_ / "all.pdf"), HasSubstr("Cue 2 Ring"));
  const Ran many = footlight({"sheets", show_, "-o", folder_ / "paper", "--language", "zh", "--cards", "4"});
  EXPECT_EQ(many.status, 0) << many.err;
  Names names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path() / "paper")) {
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  EXPECT_THAT(names, ElementsAre("1.pdf", "10.pdf", "11.pdf", "12.pdf", "2.pdf", "3.pdf", "4.pdf", "5.pdf", "6.pdf",
                                 "7.pdf", "8.pdf", "9.pdf", "calls.pdf", "chart-arrow-1.pdf", "chart-line-1.pdf",
                                 "chart-ring-1.pdf", "floor.pdf", "patch.pdf"));
  EXPECT_THAT(text_of(folder_ / "paper/calls.pdf"), HasSubstr("预备"));
  EXPECT_THAT(text_of(folder_ / "paper/patch.pdf"), HasSubstr("Patch list"));
  EXPECT_THAT(text_of(folder_ / "paper/floor.pdf"), HasSubstr("L8"));
  EXPECT_THAT(text_of(folder_ / "paper/chart-ring-1.pdf"), HasSubstr("12"));
}

TEST_F(SheetsCommand, OnlyTheSheetsThatChangedAreMade) {
  std::filesystem::copy_file(plan_, folder_ / "old.plan");
  const Ran same = footlight({"sheets", show_, "-o", folder_ / "new.pdf", "--changed-since", folder_ / "old.plan"});
  EXPECT_EQ(same.out, "0 of 12 performers' sheets have changed; nothing was written\n") << same.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.pdf"));
  std::string ring = folder_.read("s/ring.csv");
  const std::size_t at = ring.find("\n12,8,5");
  ASSERT_NE(at, std::string::npos);
  folder_.write("s/ring.csv", ring.replace(at, 7, "\n12,9,5"));
  const Ran moved = footlight({"sheets", show_, "-o", folder_ / "new.pdf", "--changed-since", folder_ / "old.plan"});
  EXPECT_EQ(moved.status, 0) << moved.err;
  EXPECT_THAT(moved.out, HasSubstr("new.pdf: "));
  const std::string text = text_of(folder_ / "new.pdf");
  EXPECT_THAT(text, HasSubstr("J6")) << "where 12 stands now";
  EXPECT_EQ(text.find("A2 "), std::string::npos) << "1 is far away";
}

TEST_F(SheetsCommand, SaysWhatIsWrongAndLeavesNothing) {
  const auto fails = [&](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"sheets", show_});
    const Ran ran = footlight(more);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.err, "error: " + message + "\n");
    EXPECT_EQ(ran.out, "");
  };
  fails({"-o", folder_ / "s/x.pdf", "--performer", "33"},
        "--performer: there is no performer \"33\" (did you mean \"3\"?)");
  fails({"-o", folder_ / "s/x.pdf", "--group", "lefft"},
        "--group: there is no group \"lefft\" (did you mean \"left\"?)");
  fails({"-o", folder_ / "s/x.pdf", "--only", "charts", "--formation", "rin/1"},
        "--formation: there is no formation \"rin/1\" (did you mean \"ring/1\"?)");
  fails({"-o", folder_ / "s/x.pdf", "--only", "charts"},
        "one PDF holds one chart (name it with --formation, or name a folder)");
  fails({"-o", folder_ / "s/x.pdf", "--only", "calls,patch"},
        "one PDF holds one kind of paper (name a folder, or one kind with --only)");
  fails({"-o", folder_ / "nowhere/x.pdf"},
        "cannot write '" + (folder_ / "nowhere/x.pdf") + "': No such file or directory");
  fails({}, "say what to write: -o FOLDER, -o FILE.pdf, --pages FOLDER");
  fails({"--pages", show_ + "/x"}, "cannot write '" + show_ + "/x': Not a directory");
  for (const std::string url : {"example.org", "https://", "https://a b/", "file:///tmp"}) {
    fails({"-o", folder_ / "s/x.pdf", "--base-url", url},
          "--base-url: '" + url +
              "' is no web address (write that of the folder with the pages, as "
              "https://example.org/show/)");
  }
  fails({"-o", folder_ / "s/x.pdf", "--base-url", "https://" + std::string(200, 'a') + ".org"},
        "--base-url: the address of 1's page has 219 bytes, a code on a sheet holds 213");
  fails({"-o", show_ + "/x.pdf"}, "cannot write '" + show_ + "/x.pdf': Not a directory");
  fails({"-o", folder_ / "s/x.pdf", "--changed-since", folder_ / "no.plan"},
        "cannot read '" + (folder_ / "no.plan") + "': No such file or directory");
  expect_no_half_file();
}

TEST_F(SheetsCommand, ACodeLeadsToThePageOfItsPerformer) {
  const Ran ran = footlight({"sheets", show_, "--pages", folder_ / "pages", "-o", folder_ / "paper", "--only", "sheets",
                             "--base-url", "https://example.org/a"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(code_on(folder_ / "paper/sheets/1.pdf"), "https://example.org/a/1.html\n");
  EXPECT_EQ(code_on(folder_ / "paper/sheets/12.pdf"), "https://example.org/a/12.html\n");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pages/12.html"));
  const Ran one = footlight(
      {"sheets", show_, "-o", folder_ / "7.pdf", "--performer", "7", "--cards", "4", "--base-url", "http://h/p#"});
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(code_on(folder_ / "7.pdf"), "http://h/p#7.html\n");
}

TEST_F(SheetsCommand, WithoutAnAddressACodeSaysWhenToBeWhere) {
  const Ran ran =
      footlight({"sheets", show_, "--pages", folder_ / "pages", "-o", folder_ / "1.pdf", "--performer", "1"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  const json told = json::parse(footlight({"sheets", show_, "-o", folder_ / "2.pdf", "--json"}).out);
  EXPECT_THAT(code_on(folder_ / "1.pdf"), StartsWith("1\nTwelve " + told["plan"].get<std::string>() + "\n1-9 "));
  EXPECT_EQ(code_on(folder_ / "2.pdf"), "") << "no pages, no code";
}

TEST_F(SheetsCommand, PagesNeedNothingElse) {
  replace("title: \"Twelve\"", "title: \"Twelve <&>\"\nversion: \"dress rehearsal\"");
  plan();
  const Ran ran = footlight({"sheets", show_, "--pages", folder_ / "pages", "--language", "zh", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json told = json::parse(ran.out);
  EXPECT_EQ(told["files"].size(), 13U) << "everybody's, and a list";
  EXPECT_EQ(told["version"], "dress rehearsal");
  EXPECT_EQ(told["performers"], 12);
  EXPECT_EQ(told["drawn"].size(), 12U);
  const std::regex outside("(src|action)=|@import|url\\(|https?:|fetch\\(|XMLHttpRequest|import ");
  for (const std::string file : {"pages/1.html", "pages/12.html", "pages/index.html"}) {
    const std::string page = folder_.read(file);
    EXPECT_FALSE(std::regex_search(page, outside)) << file;
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page, HasSubstr("Twelve &lt;&amp;&gt;   version dress rehearsal   show "));
    EXPECT_THAT(page, HasSubstr("plan " + told["plan"].get<std::string>()));
    EXPECT_THAT(page, HasSubstr("lang=\"zh-cn\""));
  }
  EXPECT_THAT(folder_.read("pages/1.html"), HasSubstr("面向观众"));
  EXPECT_THAT(folder_.read("pages/index.html"), HasSubstr("<a href=\"12.html\">12</a>"));
  ASSERT_EQ(footlight({"sheets", show_, "--pages", folder_ / "few", "--group", "left"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "few/index.html")) << "a list of some would hide the others";
}

TEST_F(SheetsCommand, ABrowserShowsWhatMarksCsvSays) {
  if (test::run_program({"sh", "-c", "command -v chromium"}).status != 0) GTEST_SKIP() << "chromium is not installed";
  ASSERT_EQ(footlight({"sheets", show_, "--pages", folder_ / "pages", "--performer", "12"}).status, 0);
  ASSERT_EQ(footlight({"export", show_, "--csv", folder_ / "csv"}).status, 0);
  // Each new cell of performer 12, and when; passing marks are on the way.
  std::vector<std::pair<std::string, std::string>> marks;
  std::istringstream csv(folder_.read("csv/marks.csv"));
  for (std::string line; std::getline(csv, line);) {
    if (!line.starts_with("12,")) continue;
    std::vector<std::string> field;
    std::istringstream fields(line);
    for (std::string one; std::getline(fields, one, ',');) field.push_back(one);
    const std::string cell = cell_name({std::stoi(field[3]), std::stoi(field[4])});
    if (marks.empty() || marks.back().second != cell) marks.emplace_back(field[1], cell);
  }
  ASSERT_GE(marks.size(), 3U);
  const Ran ran = test::run_program(
      {"/usr/bin/python3", FOOTLIGHT_SOURCE_DIR "/tests/support/browser.py", folder_ / "pages/12.html"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json seen = json::parse(ran.out);
  std::vector<std::pair<std::string, std::string>> shown;
  for (const json& place : seen["places"]) {
    ASSERT_FALSE(place.is_null()) << "one place at a time";
    shown.emplace_back(place[0], place[2]);
    EXPECT_THAT(place[4].get<std::string>(), StartsWith("Cue "));
  }
  EXPECT_EQ(shown, marks);
  const auto last = static_cast<int>(shown.size());
  EXPECT_EQ(seen["after"], (json{{"the last and one more", last},
                                 {"Home", 1},
                                 {"a tap on the right", 2},
                                 {"a tap on the left", 1},
                                 {"the button", 2},
                                 {"opening it again", 2}}));
  EXPECT_THAT(seen["wide"], IsEmpty()) << "nothing is wider than a telephone";
  EXPECT_THAT(seen["without_map"], IsEmpty());
  EXPECT_THAT(seen["requests"], IsEmpty()) << "no network";
  EXPECT_EQ(seen["light"], "rgb(255, 255, 255)");
  EXPECT_EQ(seen["dark"], "rgb(0, 0, 0)");
}

TEST_F(SheetsCommand, AFullDiskIsToldAndLeavesNoHalfFile) {
  const Ran ran = test::run_program(
      {"sh", "-c", "ulimit -f 4; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "sheets", show_, "-o", folder_ / "s/x.pdf"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, EndsWith("cannot write '" + (folder_ / "s/x.pdf") + "': File too large\n"));
  const Ran pages = test::run_program({"sh", "-c", "ulimit -f 4; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "sheets",
                                       show_, "--pages", folder_ / "pages"});
  EXPECT_EQ(pages.status, 2);
  EXPECT_THAT(pages.err, EndsWith("cannot write '" + (folder_ / "pages/1.html") + "': File too large\n"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "pages"));
  expect_no_half_file();
}

}  // namespace
}  // namespace footlight
