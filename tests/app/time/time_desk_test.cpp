// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/controller/time/led_show.hpp"

namespace footlight::app {
namespace {

using controller::Command;
using controller::Rehearsal;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Ears final : Surface {
  void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
  void told(const RunEvent& event) override { heard.push_back(std::string(to_text(event.kind)) + ": " + event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  std::vector<std::string> heard;
};

/// A show that runs, on a machine whose clocks we hold in our hands.
class TimeDeskTest : public ::testing::Test {
 protected:
  TimeDeskTest()
      : small_(tests::random_show(6, 6, 4, 3, 2, 1)),
        desk_(small_.show, small_.plan),
        time_(small_.show, nullptr, led_.clock, {[this] { return boot_; }, [this] { return wall_; }}) {
    desk_.add(ears_);
    desk_.add(time_);
    EXPECT_EQ(led_.say(Command::Kind::go), controller::Outcome::cue_started);
    pass(1, 1, 1);
  }
  /// So much time passes by each clock; the desk looks, and what it wants is done.
  void pass(double steady_s, double boot_s, double wall_s) {
    led_.clock.advance(seconds(steady_s));
    boot_ += seconds(boot_s);
    wall_ += seconds(wall_s);
    led_.step();
    for (const Command& command : desk_.look({}).commands) {
      EXPECT_FALSE(refused(led_.chase->take(command, led_.clock.now())));
    }
    led_.step();
  }

  tests::LedShow led_;
  tests::SmallShow small_;
  RunDesk desk_;
  Duration boot_ = seconds(5000);
  Duration wall_ = seconds(1e9);
  TimeDesk time_;
  Ears ears_;
};

TEST_F(TimeDeskTest, AMachineThatHasSleptHoldsTheShowAndSaysSo) {
  pass(4, 4, 4);  // the count-in is over
  ASSERT_EQ(led_.phase(), Rehearsal::Phase::runs);
  pass(0.02, 30.02, 30.02);
  EXPECT_EQ(led_.phase(), Rehearsal::Phase::stands);
  EXPECT_TRUE(led_.engine->frozen()) << "at once";
  EXPECT_THAT(ears_.heard,
              ElementsAre("alarm: HOLD: the machine has slept for 30.0 s; look where people are, then GO or jump"));
  EXPECT_FALSE(led_.chase->view().armed) << "nor does a source of time go on with it";
  EXPECT_EQ(led_.say(Command::Kind::go), controller::Outcome::goes_on);
  pass(2.5, 2.5, 2.5);
  EXPECT_EQ(led_.phase(), Rehearsal::Phase::runs) << "one sleep is one hold";
}

TEST_F(TimeDeskTest, AStepOfTheWallClockMovesNothingAndIsNoted) {
  pass(4, 4, 4);
  pass(0.02, 0.02, -3599.98);
  EXPECT_EQ(led_.phase(), Rehearsal::Phase::runs);
  EXPECT_THAT(ears_.heard, ElementsAre("note: the wall clock was set by -3600.000 s: the show does not go by it"));
}

TEST_F(TimeDeskTest, WhileTheClocksAgreeNothingIsSaid) {
  for (int i = 0; i < 50; ++i) pass(0.02, 0.02, 0.02);
  EXPECT_THAT(ears_.heard, IsEmpty());
}

}  // namespace
}  // namespace footlight::app
