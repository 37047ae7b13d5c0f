// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/run_desk.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using controller::GoSource;
using controller::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Ears final : public Surface {
 public:
  void look(const DeskView& /*view*/, RunDesk& desk) override {
    for (const std::string& line : std::exchange(says, {})) desk.say(line, me);
  }
  void told(const RunEvent& event) override { heard.push_back(json_of(event)); }
  [[nodiscard]] int file() const override { return wakes; }
  [[nodiscard]] bool listens() const override { return awake; }

  Speaker me{GoSource::network, "osc 127.0.0.1"};
  std::vector<std::string> says;
  std::vector<std::string> heard;
  int wakes = -1;
  bool awake = true;
};

class RunDeskTest : public ::testing::Test {
 protected:
  RunDeskTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {
    desk_.add(ears_);
    desk_.add(other_);
  }
  std::vector<std::string> heard() { return std::exchange(ears_.heard, {}); }

  tests::SmallShow small_;
  RunDesk desk_;
  Ears ears_;
  Ears other_;
};

TEST_F(RunDeskTest, AllSurfacesAreToldWhatCameOfAnOrderAndWhoSaidIt) {
  ears_.says = {"  tempo 80 "};
  const DeskWishes wishes = desk_.look({});
  ASSERT_EQ(wishes.commands.size(), 1U);
  EXPECT_EQ(wishes.commands[0].percent, 80);
  EXPECT_EQ(wishes.commands[0].source, GoSource::network);
  EXPECT_THAT(desk_.look({}).commands, IsEmpty()) << "an order is carried out once";
  desk_.answered({wishes.commands[0], Outcome::too_soon, instant_at(3)});
  const std::string answer =
      R"({"answer":{"order":"tempo 80","who":"osc 127.0.0.1","refused":true,"text":"too soon after the last GO"}})";
  EXPECT_THAT(other_.heard, ElementsAre(answer));
  EXPECT_THAT(heard(), ElementsAre(answer));
  desk_.answered({wishes.commands[0], Outcome::too_soon, instant_at(3)});
  EXPECT_THAT(heard(), IsEmpty()) << "it has been answered";
  desk_.answered({{}, Outcome::done, instant_at(3)});
  EXPECT_THAT(heard(), IsEmpty()) << "the show said this to itself";
}

TEST_F(RunDeskTest, AnOrderThatIsNotUnderstoodIsRefusedToAll) {
  ears_.says = {"jmup"};
  EXPECT_THAT(desk_.look({}).commands, IsEmpty());
  EXPECT_THAT(other_.heard, ElementsAre(HasSubstr(R"("refused":true,"text":"\"jmup\" is no order)")));
}

TEST_F(RunDeskTest, VerbsAnswerAtOnceAndKeepWhatWasTyped) {
  std::vector<std::string> taken;
  desk_.add({"note", "note WORDS    a note\n",
             [&](const std::vector<std::string>& words, const Speaker&) -> Result<std::string> {
               if (words.empty()) return input_error("note: what?");
               taken = words;
               return std::string("kept");
             }});
  ears_.says = {"NOTE Ana too  late", "note"};
  EXPECT_THAT(desk_.look({}).commands, IsEmpty());
  EXPECT_THAT(taken, ElementsAre("Ana", "too", "late"));
  EXPECT_THAT(
      heard(),
      ElementsAre(HasSubstr(R"("order":"NOTE Ana too  late","who":"osc 127.0.0.1","refused":false,"text":"kept")"),
                  HasSubstr(R"("refused":true,"text":"note: what?")")));
  EXPECT_THAT(desk_.help(), HasSubstr("note WORDS"));
  EXPECT_THAT(desk_.help(), HasSubstr("jump cue 12"));
}

TEST_F(RunDeskTest, WhatStandsAgainstWalkingStaysUntilItIsTakenBack) {
  desk_.bar(controller::kHoldPressed | 2, true);
  EXPECT_EQ(desk_.look(DeskView{}).bars, controller::kHoldPressed | 2);
  desk_.bar(2, false);
  EXPECT_EQ(desk_.look(DeskView{}).bars, controller::kHoldPressed);
  EXPECT_EQ(desk_.look(DeskView{}).bars, controller::kHoldPressed);
}

TEST_F(RunDeskTest, ARefusalNamesWhatStandsAgainstIt) {
  desk_.add([](DeskView& view) { view.against = {"trap closed: open", "lift level: lost"}; });
  ears_.says = {"go"};
  const DeskWishes wishes = desk_.look({});
  desk_.answered({wishes.commands.at(0), Outcome::gate_open, instant_at(3)});
  EXPECT_THAT(heard(), ElementsAre(HasSubstr("a gate that it needs is open, or nobody knows: trap closed: open, lift "
                                             "level: lost")));
}

TEST_F(RunDeskTest, EverySpeakerIsAnInputOfItsOwnForTheGoGuardAndOneThatIsSwitchedOffIsAnAlarm) {
  ears_.says = {"go"};
  other_.me.name = "button GO";
  other_.says = {"go", "go"};
  const DeskWishes wishes = desk_.look({});
  ASSERT_EQ(wishes.commands.size(), 3U);
  EXPECT_EQ(wishes.commands[0].input, 0);
  EXPECT_EQ(wishes.commands[1].input, 1);
  EXPECT_EQ(wishes.commands[2].input, 1);
  DeskView view;
  view.show.inputs_off = 2;
  (void)desk_.look(view);
  (void)desk_.look(view);
  EXPECT_THAT(heard(), ElementsAre("{\"alarm\":\"button GO has pressed GO for more than 5 s and is switched off until "
                                   "somebody says ok; the others count\"}"));
}

TEST_F(RunDeskTest, TheRunIsLeftByQuitAndWhenNobodyListens) {
  EXPECT_FALSE(desk_.look({}).nobody);
  ears_.awake = false;
  EXPECT_FALSE(desk_.look({}).nobody);
  other_.awake = false;
  EXPECT_TRUE(desk_.look({}).nobody);
  ears_.says = {"quit"};
  EXPECT_TRUE(desk_.look({}).ends);
}

TEST_F(RunDeskTest, WaitsOnlyUntilASurfaceHasSomething) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  other_.wakes = ends[0];
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  desk_.wait(seconds(3600));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(EventJson, WhateverSomebodyTypedIsValidJson) {
  EXPECT_EQ(json_of({RunEvent::Kind::alarm, "bus \"a\"\n\xff"}), "{\"alarm\":\"bus \\\"a\\\"\\n\xEF\xBF\xBD\"}");
}

}  // namespace
}  // namespace footlight::app
