// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/starter_show.hpp"

namespace footlight {
namespace {

using test::footlight;
using test::Ran;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SheetsCommand : public test::StarterShow {
 protected:
  SheetsCommand() {
    EXPECT_EQ(footlight({"plan", show_, "-q"}).status, 0);
    made_ = files();
  }
  /// Nothing else than before is beside the show.
  void expect_no_half_file() const { EXPECT_EQ(files(), made_); }
  std::string text_of(const std::string& file) const {
    const Ran ran = test::run_program({"pdftotext", "-layout", file, folder_ / "text.txt"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return folder_.read("text.txt");
  }
  Names made_;
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
  fails({"-o", show_ + "/x.pdf"}, "cannot write '" + show_ + "/x.pdf': Not a directory");
  fails({"-o", folder_ / "s/x.pdf", "--changed-since", folder_ / "no.plan"},
        "cannot read '" + (folder_ / "no.plan") + "': No such file or directory");
  expect_no_half_file();
}

TEST_F(SheetsCommand, AFullDiskIsToldAndLeavesNoHalfFile) {
  const Ran ran = test::run_program(
      {"sh", "-c", "ulimit -f 4; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "sheets", show_, "-o", folder_ / "s/x.pdf"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, EndsWith("cannot write '" + (folder_ / "s/x.pdf") + "': File too large\n"));
  expect_no_half_file();
}

}  // namespace
}  // namespace footlight
