// SPDX-License-Identifier: Apache-2.0
#include "app/paper/words.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

std::set<std::string> places_in(std::string_view text) {
  std::set<std::string> out;
  for (std::size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
    out.emplace(text.substr(at, text.find('}', at) - at + 1));
  }
  return out;
}

TEST(Words, EveryLanguageFillsTheSamePlaces) {
  for (int word = 0; word < static_cast<int>(Word::number_of_words); ++word) {
    const auto english = text_of(Language::english, static_cast<Word>(word));
    const auto chinese = text_of(Language::chinese, static_cast<Word>(word));
    EXPECT_FALSE(english.empty());
    EXPECT_NE(english, chinese);
    EXPECT_EQ(places_in(english), places_in(chinese)) << english;
  }
}

TEST(Words, AreFilled) {
  EXPECT_EQ(say(Language::english, Word::cue, fmt::arg("number", "2"), fmt::arg("name", "Ring")), "Cue 2  Ring");
  EXPECT_EQ(say(Language::chinese, Word::stay_until, fmt::arg("count", "9")), "停到第 9 拍");
  EXPECT_EQ(language_from("zh"), Language::chinese);
  EXPECT_FALSE(language_from("de"));
}

}  // namespace
}  // namespace footlight::app
