// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/bus_health.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr NodeBoard::View kFine{0, NodeBoard::kRight};
constexpr NodeBoard::View kUnheard{0, NodeBoard::kSilent};
constexpr NodeBoard::View kGone{0, NodeBoard::kSilent | NodeBoard::kQuarantined};

class Ears final : public Surface {
 public:
  void look(const DeskView& view, RunDesk& /*desk*/) override { seen = view; }
  void told(const RunEvent& event) override { heard.push_back(std::string(to_text(event.kind)) + ": " + event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  DeskView seen;
  std::vector<std::string> heard;
};

/// Two buses of three nodes.
class BusHealthTest : public ::testing::Test {
 protected:
  BusHealthTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan), board_(6) {
    rig_ = tests::lamps_everywhere(small_.show.stage.grid, {BusKind::serial, BusKind::can}, 115'200, 6);
    for (std::size_t n = 0; n < 6; ++n) {
      board_.put(n, kFine);
      rig_.nodes[n].bus = BusIndex::of(n / 3);
      rig_.nodes[n].name = (n < 3 ? "left-" : "far-") + std::to_string(n % 3 + 1);
    }
    rig_.buses[0].name = "left";
    rig_.buses[1].name = "far";
    view_.buses = {{"left", 3, 0}, {"far", 3, 0}};
    view_.roll_called = true;
    health_.emplace(rig_, board_, desk_, [this](const std::string& change) { changes_.push_back(change); });
    desk_.add(*health_);
    desk_.add(ears_);
  }
  void put_bus(std::size_t bus, NodeBoard::View view) {
    for (std::size_t n = 3 * bus; n < 3 * bus + 3; ++n) board_.put(n, view);
  }
  /// Looks every 20 ms as a run does. @return what all were told meanwhile
  std::vector<std::string> pass(double time_s) {
    const Instant until = view_.now + seconds(time_s);
    while (view_.now < until) {
      view_.now += milliseconds(20);
      (void)desk_.look(view_);
    }
    return std::exchange(ears_.heard, {});
  }
  std::vector<std::string> changes() { return std::exchange(changes_, {}); }

  tests::SmallShow small_;
  Rig rig_;
  RunDesk desk_;
  NodeBoard board_;
  Ears ears_;
  std::vector<std::string> changes_;
  std::optional<BusHealth> health_;
  DeskView view_;
};

TEST_F(BusHealthTest, AWireThatGoesDownIsOneAlarmAtOnceAndItsReturnANote) {
  EXPECT_THAT(pass(5), IsEmpty());
  view_.buses[0].trouble = "unplugged";
  put_bus(0, kUnheard);
  EXPECT_THAT(pass(0.02), ElementsAre("alarm: bus \"left\": its wire is down: unplugged; its 3 nodes are silent"));
  EXPECT_THAT(pass(9), IsEmpty());
  (void)desk_.look(view_);
  EXPECT_EQ(ears_.seen.buses[0].silent, 3U);
  EXPECT_EQ(ears_.seen.buses[1].silent, 0U);
  EXPECT_EQ(ears_.seen.buses[0].last_fault, "its wire is down: unplugged; its 3 nodes are silent");
  EXPECT_GT(ears_.seen.buses[0].last_fault_unix_ms, 0);
  view_.buses[0].trouble.clear();
  put_bus(0, kFine);
  EXPECT_THAT(pass(2), ElementsAre("note: bus \"left\": all 3 nodes answer, 10.0 s after the alarm"));
  EXPECT_THAT(changes(),
              ElementsAre("bus \"left\": its wire is down: unplugged", "bus \"left\": silent: left-1, left-2, left-3",
                          "bus \"left\": its wire is up again", "bus \"left\": answers again: left-1, left-2, left-3"));
  (void)desk_.look(view_);
  EXPECT_EQ(ears_.seen.buses[0].silent, 0U);
  EXPECT_EQ(ears_.seen.buses[0].last_fault, "its wire is down: unplugged; its 3 nodes are silent") << "the last one";
}

TEST_F(BusHealthTest, ABusIsToldBeforeTheRollCallButItsNodesOnlyAfterIt) {
  view_.roll_called = false;
  put_bus(0, {});
  EXPECT_THAT(pass(3), IsEmpty());
  view_.buses[1].trouble = "bus-off";
  EXPECT_THAT(pass(1), ElementsAre("alarm: bus \"far\": its wire is down: bus-off; its 3 nodes are silent"));
  view_.roll_called = true;
  (void)pass(0.02);
  EXPECT_TRUE(health_->silent(0)) << "who has not answered by then does not answer";
  EXPECT_THAT(pass(1), ElementsAre("alarm: bus \"left\": all 3 nodes are silent, and its port is open: cable, "
                                   "terminators, power of the markers"));
}

TEST_F(BusHealthTest, NodesThatAreGivenUpOneAfterTheOtherAreOneAlarm) {
  (void)pass(1);
  board_.put(0, kGone);
  (void)pass(0.3);
  board_.put(2, kGone);
  EXPECT_THAT(pass(1), ElementsAre("alarm: bus \"left\": 2 of 3 nodes silent: left-1, left-3"));
  EXPECT_THAT(changes(), ElementsAre("bus \"left\": silent: left-1", "bus \"left\": silent: left-3"));
}

TEST_F(BusHealthTest, AnAnswerThatWasLostIsNobodysAlarm) {
  (void)pass(1);
  for (int i = 0; i < 20; ++i) {
    board_.put(1, kUnheard);
    EXPECT_THAT(pass(0.9), IsEmpty());
    board_.put(1, kFine);
    EXPECT_THAT(pass(0.1), IsEmpty());
  }
  EXPECT_THAT(changes(), IsEmpty());
}

TEST_F(BusHealthTest, ANodeThatSaysNothingForASecondIsSilentThoughNotInQuarantine) {
  (void)pass(1);
  board_.put(1, kUnheard);
  EXPECT_THAT(pass(2), ElementsAre("alarm: bus \"left\": 1 of 3 nodes silent: left-2"));
  EXPECT_TRUE(health_->silent(1));
}

TEST_F(BusHealthTest, ANodeThatHasRestartedIsNamed) {
  (void)pass(1);
  board_.put_boots(4, 1);
  board_.put(4, {0, 0});
  EXPECT_THAT(pass(1), ElementsAre("alarm: bus \"far\": a node has restarted: far-2"));
  EXPECT_THAT(changes(), ElementsAre("bus \"far\": has restarted: far-2"));
}

TEST_F(BusHealthTest, ALineThatFlapsForAnHourIsToldSeldomerAndSeldomerWithHowOftenItWas) {
  (void)pass(1);
  std::vector<std::string> alarms;
  const auto listen = [&](double time_s) {
    for (std::string& text : pass(time_s)) {
      if (text.starts_with("alarm")) alarms.push_back(std::move(text));
    }
  };
  for (int i = 0; i < 600; ++i) {
    view_.buses[0].trouble = "unplugged";
    put_bus(0, kUnheard);
    listen(3);
    view_.buses[0].trouble.clear();
    put_bus(0, kFine);
    listen(3);
  }
  EXPECT_THAT(alarms, SizeIs(::testing::Le(16U))) << "10, 20, 40, 80, 160 and then every 320 s";
  EXPECT_THAT(alarms, SizeIs(::testing::Ge(14U)));
  EXPECT_THAT(alarms.back(), ::testing::HasSubstr("times since the last alarm)"));
  changes();
  // A loose contact is one fault: it is not written down at each of its clicks.
  for (int i = 0; i < 100; ++i) {
    view_.buses[0].trouble = i % 2 == 0 ? "unplugged" : "";
    (void)pass(0.1);
  }
  EXPECT_THAT(changes(), SizeIs(::testing::Le(3U)));
}

TEST_F(BusHealthTest, AfterAMinuteOfCalmTheNextFaultIsToldAtOnce) {
  (void)pass(1);
  for (int i = 0; i < 3; ++i) {
    view_.buses[1].trouble = "bus-off";
    put_bus(1, kUnheard);
    EXPECT_THAT(pass(1), SizeIs(1)) << i;
    view_.buses[1].trouble.clear();
    put_bus(1, kFine);
    EXPECT_THAT(pass(70), SizeIs(1)) << i;
  }
}

}  // namespace
}  // namespace footlight::app
