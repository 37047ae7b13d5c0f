// SPDX-License-Identifier: Apache-2.0
#include "app/remote/panel_surface.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/remote/fake_line.hpp"
#include "tests/app/remote/listener.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Does = config::RemoteButton::Does;
using Outcome = controller::Outcome;
using Phase = controller::Rehearsal::Phase;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

config::RemoteInput at(unsigned offset) { return {config::GpioPlace{"c", offset, false, {}}, {}}; }
config::GpioPlace lamp(unsigned offset) { return {"c", offset, false, {}}; }

constexpr unsigned kGo = 0;
constexpr unsigned kHold = 1;
constexpr unsigned kEmergency = 2;
constexpr unsigned kAcknowledge = 3;
constexpr unsigned kTrap = 4;
constexpr unsigned kSecondGo = 5;
constexpr unsigned kRed = 10;
constexpr unsigned kGreen = 11;
constexpr unsigned kRunning = 12;
constexpr unsigned kAlarm = 13;

class PanelTest : public ::testing::Test {
 protected:
  PanelTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {
    remote_.buttons = {{"GO", Does::go, "", "", at(kGo)},
                       {"left", Does::hold, "", "", at(kHold)},
                       {"red", Does::emergency_hold, "", "", at(kEmergency)},
                       {"flies", Does::acknowledge, "", "", at(kAcknowledge)},
                       {"GO 2", Does::go, "", "", at(kSecondGo)}};
    remote_.gates = {{0, at(kTrap)}};
    remote_.cue_lights = {{"flies", lamp(kRed), lamp(kGreen)}};
    remote_.tallies = {{config::TallyLine::Shows::running, lamp(kRunning)},
                       {config::TallyLine::Shows::alarm, lamp(kAlarm)}};
    interlocks_.emplace(std::vector<std::string>{"trap"}, remote_, clock_.now());
    panel_.emplace(remote_, *interlocks_);
    desk_.add(ears_);
    auto opened =
        PanelSurface::open(remote_, *interlocks_, *panel_, clock_, true,
                           [this](const config::GpioPlace& place, drivers::GpioSettings) { return line(place); });
    EXPECT_TRUE(opened) << opened.error().message;
    surface_ = std::move(opened).value();
    desk_.add(*surface_);
    look_for(0.2);
    (void)ears_.take();
  }
  Result<std::unique_ptr<drivers::GpioLine>> line(const config::GpioPlace& place) {
    if (wires_[place.offset].gone) return device_error("line " + std::to_string(place.offset) + " is gone");
    return std::unique_ptr<drivers::GpioLine>(std::make_unique<FakeLine>(wires_[place.offset]));
  }
  /// One look. @return orders that went to the cue thread
  std::vector<controller::Command> look(double after_s = 0.02) {
    clock_.advance(seconds(after_s));
    wishes_ = desk_.look(view_);
    return wishes_.commands;
  }
  /// Looks on and on. @return how many commands
  std::size_t look_for(double time_s) {
    std::size_t commands = 0;
    for (const Instant end = clock_.now() + seconds(time_s); clock_.now() < end;) commands += look().size();
    return commands;
  }

  tests::SmallShow small_;
  ManualClock clock_;
  RunDesk desk_;
  Listener ears_;
  config::Remote remote_;
  std::map<unsigned, FakeLine::Wire> wires_;
  std::optional<Interlocks> interlocks_;
  std::optional<Panel> panel_;
  std::unique_ptr<PanelSurface> surface_;
  DeskView view_;
  DeskWishes wishes_;
};

TEST_F(PanelTest, AButtonThatBouncesIsOneGo) {
  for (const bool bounce : {true, false, true, false, true}) wires_[kGo].go(bounce);
  const auto commands = look();
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].kind, controller::Command::Kind::go);
  EXPECT_EQ(commands[0].source, controller::GoSource::button);
  EXPECT_EQ(look_for(3), 0U) << "held is no second press";
}

TEST_F(PanelTest, AStuckGoIsAnAlarmAndTheOtherButtonCounts) {
  wires_[kGo].go(true);
  EXPECT_EQ(look_for(6), 1U);
  EXPECT_THAT(ears_.take(), ElementsAre("alarm: button GO has been pressed for more than 5 s and is switched off until "
                                        "it has been out for as long; the others count"));
  wires_[kSecondGo].go(true);
  EXPECT_EQ(look().size(), 1U);
  wires_[kGo].go(false);
  EXPECT_EQ(look_for(5.1), 0U);
  EXPECT_THAT(ears_.take(), Contains("note: button GO counts again"));
  wires_[kGo].go(true);
  EXPECT_EQ(look().size(), 1U);
}

TEST_F(PanelTest, AHoldButtonBarsWalkingAtOnceAndAsLongAsItIsPressed) {
  wires_[kHold].go(true);
  (void)look();
  EXPECT_EQ(wishes_.bars & controller::kHolding, controller::kHoldPressed | 1) << "and the gate is open";
  EXPECT_THAT(ears_.take(), ElementsAre("alarm: HOLD by button left. HOLD changes lamps and stops no machine"));
  wires_[kHold].go(false);
  look_for(0.2);
  EXPECT_EQ(wishes_.bars, 1U);
}

TEST_F(PanelTest, AnEmergencyHoldIsAcknowledgedByOk) {
  wires_[kEmergency].go(true);
  wires_[kEmergency].go(false);
  look_for(0.3);
  EXPECT_NE(wishes_.bars & controller::kEmergencyHold, 0U);
  desk_.say("ok", {controller::GoSource::lines, "lines"});
  const auto commands = look();
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_TRUE(wires_[kAlarm].level);
  desk_.answered({commands[0], Outcome::done, clock_.now()});
  (void)look();
  EXPECT_EQ(wishes_.bars & controller::kEmergencyHold, 0U);
  EXPECT_FALSE(wires_[kAlarm].level);
}

TEST_F(PanelTest, AGateClosesAfterARestAndOpensAtOnceWithAnAlarm) {
  wires_[kTrap].go(true);
  look_for(0.2);
  EXPECT_EQ(wishes_.bars, 0U);
  EXPECT_THAT(ears_.take(), ElementsAre("note: trap: closed"));
  wires_[kTrap].go(false);
  (void)look();
  EXPECT_EQ(wishes_.bars, 1U);
  EXPECT_THAT(ears_.take(), ElementsAre("alarm: trap: open"));
}

TEST_F(PanelTest, ALineThatIsGoneIsToldAndTakenUpAgain) {
  wires_[kTrap].go(true);
  look_for(0.2);
  wires_[kTrap].gone = true;
  wires_[kGo].gone = true;
  wires_[kRed].gone = true;
  (void)ears_.take();
  look_for(3);
  EXPECT_EQ(wishes_.bars, 1U) << "nobody knows";
  EXPECT_THAT(ears_.take(), ElementsAre("alarm: button GO: lost: gone", "alarm: trap: lost: gone"));
  wires_[kTrap].gone = false;
  wires_[kGo].gone = false;
  look_for(1.3);
  EXPECT_EQ(wishes_.bars, 0U);
  EXPECT_THAT(ears_.take(), ElementsAre("note: button GO: heard again", "note: trap: open", "note: trap: closed"));
  wires_[kGo].go(true);
  EXPECT_EQ(look().size(), 1U);
}

TEST_F(PanelTest, TheCueLightGoesFromStandbyToGo) {
  ASSERT_TRUE(panel_->standby({}));
  (void)look();
  EXPECT_TRUE(wires_[kRed].level);
  look_for(0.6);
  EXPECT_FALSE(wires_[kRed].level) << "it flashes";
  wires_[kAcknowledge].go(true);
  look_for(0.1);
  EXPECT_TRUE(wires_[kRed].level);
  look_for(0.6);
  EXPECT_TRUE(wires_[kRed].level) << "steady";
  EXPECT_THAT(ears_.take(), ElementsAre("note: cue light flies: standby acknowledged"));
  wires_[kGo].go(true);
  const auto commands = look();
  ASSERT_EQ(commands.size(), 1U);
  desk_.answered({commands[0], Outcome::cue_started, clock_.now()});
  (void)look();
  EXPECT_FALSE(wires_[kRed].level);
  EXPECT_TRUE(wires_[kGreen].level);
  look_for(5);
  EXPECT_FALSE(wires_[kGreen].level);
}

TEST_F(PanelTest, ARefusedGoLightsNoGreen) {
  ASSERT_TRUE(panel_->standby({}));
  wires_[kGo].go(true);
  const auto commands = look();
  desk_.answered({commands.at(0), Outcome::too_soon, clock_.now()});
  look_for(0.2);
  EXPECT_FALSE(wires_[kGreen].level);
  EXPECT_THAT(ears_.take(), ElementsAre("go by button GO refused: too soon after the last GO"));
}

TEST_F(PanelTest, TheTallyIsLitWhilePeopleWalk) {
  view_.show.phase = Phase::runs;
  (void)look();
  EXPECT_TRUE(wires_[kRunning].level);
  view_.show.phase = Phase::stands;
  (void)look();
  EXPECT_FALSE(wires_[kRunning].level);
}

TEST_F(PanelTest, AllLinesThatAreNotToBeHadAreToldAtOnce) {
  wires_[kGo].gone = true;
  wires_[kGreen].gone = true;
  const auto opened =
      PanelSurface::open(remote_, *interlocks_, *panel_, clock_, true,
                         [this](const config::GpioPlace& place, drivers::GpioSettings) { return line(place); });
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::device);
  EXPECT_EQ(opened.error().message, "line 0 is gone\nline 11 is gone");
}

}  // namespace
}  // namespace footlight::app
