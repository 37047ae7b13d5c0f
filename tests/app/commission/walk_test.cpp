// SPDX-License-Identifier: Apache-2.0
#include "app/commission/walk.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

class AWalk : public testing::Test {
 protected:
  AWalk() {
    stage_.grid = Grid::make(GridKind::square, 4, 2, 1).value();
    stage_.blocked = {CellIndex(7)};
    rig_ = tests::lamps_everywhere(stage_.grid, {BusKind::can}, 115'200, 4);
    rig_.nodes[1].channels[3] = {};
  }
  [[nodiscard]] Walk walk(WalkOrder order = WalkOrder::floor) const { return {rig_, stage_, lamps_of(rig_), order}; }
  static std::string refusal(Walk& walk, std::string_view answer) {
    const auto said = walk.answer(answer);
    return said ? "" : said.error().message;
  }
  /// Answers, and writes what would be written.
  static void say(Walk& walk, std::string& text, std::string_view answer) {
    if (text.empty()) text = walk.head() + "\n";
    EXPECT_TRUE(walk.answer(answer)) << answer;
    text += walk.last_line() + "\n";
  }

  Stage stage_;
  Rig rig_;
};

TEST_F(AWalk, AsksForEachLampAndKnowsInTheEndWhereTheyAre) {
  Walk walk = this->walk();
  EXPECT_EQ(walk.question(), "1 of 8: bus1/1/0 should be on A1");
  EXPECT_EQ(walk.answer("").value(), Walk::Said::placed);
  EXPECT_EQ(walk.answer("n C1").value(), Walk::Said::placed);
  EXPECT_EQ(walk.question(), "3 of 8: bus1/1/2 should be on C1");
  EXPECT_EQ(refusal(walk, ""), "C1 is where bus1/1/1 shines, as you said (b goes back)");
  EXPECT_EQ(walk.answer("b1").value(), Walk::Said::placed);
  EXPECT_EQ(walk.answer("d").value(), Walk::Said::dead);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(walk.answer("y").value(), Walk::Said::placed);
  EXPECT_EQ(walk.question(), "8 of 8: bus1/2/3 was never assigned: on which cell does it shine?");
  EXPECT_EQ(refusal(walk, ""), "the rig does not know where this lamp is (the cell where it shines, as B4)");
  EXPECT_EQ(walk.answer("D1").value(), Walk::Said::placed);
  EXPECT_TRUE(walk.finished());
  const auto seen = walk.seen();
  EXPECT_EQ(seen[1], stage_.grid.index({2, 0}));
  EXPECT_EQ(seen[2], stage_.grid.index({1, 0}));
  EXPECT_EQ(seen[3], std::nullopt);
  EXPECT_EQ(walk.dead(), std::vector<std::size_t>{3});
  EXPECT_EQ(seen[7], stage_.grid.index({3, 0}));
}

TEST_F(AWalk, RefusesWhatIsNoAnswer) {
  Walk walk = this->walk();
  EXPECT_EQ(refusal(walk, "b"), "this is the first lamp");
  EXPECT_EQ(refusal(walk, "yes"),
            "\"yes\" is no answer (Enter: right; a cell, as B4: it shines there; d: dead; b: back; "
            "q: stop)");
  EXPECT_EQ(refusal(walk, "Z9"), "Z9 is beyond the stage (its last cell is D2)");
  EXPECT_EQ(refusal(walk, "D2"), "D2 is blocked (a lamp there is nobody's place)");
  EXPECT_EQ(walk.position(), 0U);
}

TEST_F(AWalk, IsTakenUpWhereverItWasKilled) {
  std::string text;
  Walk first = walk();
  say(first, text, "");
  say(first, text, "d");
  say(first, text, "b");
  say(first, text, "C1");
  for (std::size_t cut = text.find('\n') + 1; cut <= text.size(); ++cut) {
    Walk again = walk();
    const auto taken = again.take_up(std::string_view(text).substr(0, cut), "walk");
    ASSERT_TRUE(taken) << taken.error().message;
    // What was written with the end of its line counts.
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(cut), '\n') - 1;
    EXPECT_EQ(again.position(), std::vector<std::size_t>({0, 1, 2, 1, 2})[static_cast<std::size_t>(lines)]);
  }
}

TEST_F(AWalk, OfAnyAnswersIsTakenUpTheSame) {
  EXPECT_TRUE(rc::check([this] {
    Walk walk = this->walk(*rc::gen::element(WalkOrder::floor, WalkOrder::bus));
    std::string text = walk.head() + "\n";
    const auto answers = *rc::gen::container<std::vector<std::string>>(
        rc::gen::element<std::string>("", "d", "b", "A1", "B1", "C2", "D1", "x"));
    for (const std::string& answer : answers) {
      if (walk.answer(answer)) text += walk.last_line() + "\n";
    }
    Walk again = this->walk(text.find("order bus") == std::string::npos ? WalkOrder::floor : WalkOrder::bus);
    RC_ASSERT(bool(again.take_up(text, "walk")));
    RC_ASSERT(again.seen() == walk.seen());
    RC_ASSERT(again.dead() == walk.dead());
    RC_ASSERT(again.position() == walk.position());
  }));
}

TEST_F(AWalk, OfAnotherRigOrWithWrongLinesIsNotTakenUp) {
  Walk first = walk();
  Walk other = walk(WalkOrder::bus);
  const auto of_other = first.take_up(other.head() + "\n", "w.walk");
  ASSERT_FALSE(of_other);
  EXPECT_EQ(of_other.error().message, "w.walk:1: it is the walk \"" + other.head() + "\", and this one would be \"" +
                                          first.head() +
                                          "\" (finish it with its own rig and order, or take the file away)");
  const auto wrong = first.take_up(first.head() + "\n0 bus1/1/0 A1\n5 bus1/1/1 B1\n", "w.walk");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(
      wrong.error().message,
      "w.walk:3: \"5 bus1/1/1 B1\": the next lamp would be \"1 bus1/1/1 ...\" (take away this line and those after "
      "it)");
}

}  // namespace
}  // namespace footlight::app
