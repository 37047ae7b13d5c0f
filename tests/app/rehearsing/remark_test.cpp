// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/remark.hpp"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

class RemarkTest : public ::testing::Test {
 protected:
  RemarkTest() : show_(tests::random_show(6, 6, 4, 1, 2, 1).show) {
    show_.performers[0].name = "Ana Ruiz";
    show_.performers[1].name = "Ana";
    show_.performers[2].name = "bloom";
    show_.performers[3].name = "4";
  }
  [[nodiscard]] Result<Remark> read(const std::string& text) const {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return read_remark(show_, words);
  }
  void expect(const std::string& said, Remark::About about, const std::string& whom, const std::string& text) const {
    const auto remark = read(said);
    ASSERT_TRUE(remark) << remark.error().message;
    EXPECT_EQ(remark->about, about) << said;
    EXPECT_EQ(remark->whom, whom) << said;
    EXPECT_EQ(remark->text, text) << said;
  }
  Show show_;
};

TEST_F(RemarkTest, IsAboutWhoeverTheFirstWordsName) {
  expect("Ana too late", Remark::About::person, "Ana", "too late");
  expect("ana ruiz TOO late", Remark::About::person, "Ana Ruiz", "TOO late");
  expect("4 turns left", Remark::About::person, "4", "turns left");
  expect("stem straight lines", Remark::About::group, "stem", "straight lines");
  expect("b2 is dark", Remark::About::cell, "B2", "is dark");
  expect("all smile", Remark::About::all, "", "smile");
  expect("the light in the hall", Remark::About::all, "", "the light in the hall");
  expect("Z99 is off the floor", Remark::About::all, "", "Z99 is off the floor");
}

TEST_F(RemarkTest, AWordBeforeTheNameDecidesWhatItIs) {
  EXPECT_EQ(read("bloom late").error().message,
            "note: \"bloom\" is a person and a group (\"note person bloom ...\" or \"note group bloom ...\")");
  expect("person bloom late", Remark::About::person, "bloom", "late");
  expect("GROUP Bloom late", Remark::About::group, "bloom", "late");
  EXPECT_EQ(read("person Eva late").error().message, "note: there is no person \"Eva\"");
  EXPECT_EQ(read("cell Z99 late").error().message, "note: there is no cell \"Z99\"");
}

TEST_F(RemarkTest, HasToSaySomething) {
  for (const char* said : {"", "all", "Ana", "person Ana"}) {
    EXPECT_EQ(read(said).error().message, "note: what is to be said? As in \"note Ana too late\", \"note all smile\"")
        << said;
  }
}

}  // namespace
}  // namespace footlight::app
