// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/early_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Somebody at a page.
class Page final : public Surface {
 public:
  void look(const DeskView& view, RunDesk& desk) override {
    seen = view;
    for (const std::string& order : std::exchange(orders, {})) desk.say(order, {controller::GoSource::page, "Ana"});
  }
  void told(const RunEvent& event) override { heard.push_back((event.refused ? "refused: " : "") + event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  DeskView seen;
  std::vector<std::string> orders;
  std::vector<std::string> heard;
};

class EarlyDeskTest : public ::testing::Test {
 protected:
  EarlyDeskTest()
      : small_(tests::random_show(6, 6, 4, 3, 2, 1)),
        rig_(tests::lamps_everywhere(small_.show.stage.grid, {BusKind::serial}, 115'200, 12)),
        readiness_(Scope::live),
        desk_(small_.show, small_.plan, rig_, readiness_, clock_) {
    desk_.add(page_);
  }
  std::vector<std::string> say(const std::string& order) {
    page_.orders.push_back(order);
    desk_.look();
    return std::exchange(page_.heard, {});
  }

  tests::SmallShow small_;
  Rig rig_;
  Readiness readiness_;
  ManualClock clock_;
  EarlyDesk desk_;
  Page page_;
};

TEST_F(EarlyDeskTest, WhoeverLooksSeesTheStagesAndWhatIsAsked) {
  readiness_.tell(Readiness::Stage::show, Readiness::State::success, "valid");
  desk_.look();
  ASSERT_EQ(page_.seen.readiness.stages.size(), Readiness::kStages);
  EXPECT_EQ(page_.seen.readiness.stages[0].state, "SUCCESS");
  EXPECT_FALSE(page_.seen.readiness.armed);
  EXPECT_FALSE(page_.seen.readiness.question.has_value());
  EXPECT_EQ(page_.seen.buses.at(0).nodes, 3U);
  EXPECT_FALSE(page_.seen.roll_called);
  desk_.ask("does A1 shine?", "A1");
  desk_.look();
  ASSERT_TRUE(page_.seen.readiness.question.has_value());
  EXPECT_EQ(page_.seen.readiness.question->text, "does A1 shine?");
  desk_.asked();
  desk_.look();
  EXPECT_FALSE(page_.seen.readiness.question.has_value());
}

TEST_F(EarlyDeskTest, ALampIsConfirmedByNameAndOnlyInClearWords) {
  EXPECT_THAT(say("probe yes"), ElementsAre("refused: probe: nothing is asked"));
  desk_.ask("does A1 shine?", "A1");
  EXPECT_THAT(say("probe"), ElementsAre("refused: probe: yes, no or skip is wanted: does A1 shine?"));
  EXPECT_THAT(say("probe perhaps"), ElementsAre("refused: probe: yes, no or skip is wanted: does A1 shine?"));
  EXPECT_FALSE(desk_.said().has_value());
  EXPECT_THAT(say("probe yes"), ElementsAre("A1 shines, and nothing else"));
  ASSERT_TRUE(desk_.said().has_value());
  EXPECT_EQ(desk_.said()->answer, ProbeAnswer::yes);
  EXPECT_EQ(desk_.said()->who, "Ana");
  desk_.ask("does B2 shine?", "B2");
  EXPECT_FALSE(desk_.said().has_value()) << "another lamp is another question";
  EXPECT_THAT(say("probe no"), ElementsAre("B2 does not shine where it should"));
}

TEST_F(EarlyDeskTest, NothingElseIsHeardYetAndNothingIsKeptForLater) {
  EXPECT_THAT(say("go"), ElementsAre("refused: the show is not ready: the roll call is not over"));
  desk_.ask("does A1 shine?", "A1");
  EXPECT_THAT(say("go"), ElementsAre("refused: the show is not ready: nobody has confirmed the probe lamp at A1"));
  EXPECT_FALSE(desk_.quits());
  EXPECT_THAT(say("quit"), IsEmpty());
  EXPECT_TRUE(desk_.quits());
}

}  // namespace
}  // namespace footlight::app
