// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_schedule.hpp"

#include <gtest/gtest.h>

#include "controller/plan_check.hpp"
#include "tests/controller/fake_driver.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

using tests::cue_of;
using tests::lamps_everywhere;
using tests::mark_at;
using tests::plan_of;
using tests::random_show;
using tests::SmallShow;

std::vector<std::unique_ptr<drivers::Driver>> fake_drivers(const Rig& rig) {
  std::vector<std::unique_ptr<drivers::Driver>> list;
  for (const Bus& bus : rig.buses) {
    list.push_back(std::make_unique<FakeDriver>(rig.nodes.size(), kChannelsPerNode, bus.kind == BusKind::can));
  }
  return list;
}

/// On a floor of 8 x 2 with the reserve in the last column. Person 1 walks A1 -> C1 in [4, 6] s and on to H1 in
/// [10, 12]; person 2 walks from the reserve H2 to A1 in [10, 12]; person 3 stands on E1.
SmallShow three_people() {
  SmallShow small;
  const Grid grid = Grid::make(GridKind::square, 8, 2, 1.0).value();
  small.show.stage.grid = grid;
  small.show.stage.reserve = {grid.index({7, 0}), grid.index({7, 1})};
  small.show.groups = {{"red", {255, 0, 0}}, {"blue", {0, 0, 255}}};
  small.show.announce_counts = 4;  // 2 s
  for (std::uint32_t p = 0; p < 3; ++p) {
    Performer performer;
    performer.id = std::to_string(p + 1);
    performer.group = GroupIndex(p == 1 ? 1 : 0);
    small.show.performers.push_back(performer);
  }
  small.plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(4, grid, 0, 0), mark_at(6, grid, 2, 0),
                               mark_at(10, grid, 2, 0), mark_at(12, grid, 7, 0)},
                              {mark_at(0, grid, 7, 1), mark_at(10, grid, 7, 1), mark_at(12, grid, 0, 0)},
                              {mark_at(0, grid, 4, 0), mark_at(12, grid, 4, 0)}});
  small.plan.stage = small.show.stage;
  small.plan.sections = {{"walks", kStart, instant_at(12), 2, {}, {}, {}}};
  small.plan.valid = true;
  small.show.cues = {cue_of("1", 0)};
  small.rig = lamps_everywhere(grid, {BusKind::serial}, 115'200);
  return small;
}

CueSchedule build(const SmallShow& small) {
  auto schedule = build_schedule(small.show, small.plan, small.rig, fake_drivers(small.rig));
  EXPECT_TRUE(schedule.has_value()) << (schedule ? "" : schedule.error().message);
  return std::move(schedule).value();
}

/// Every cell of the lower row as a letter: . dark, then effect (steady S, pulse P, blink B, double-blink D, count-down
/// C) in the group's colour family: lower case for blue.
std::string row(const CueSchedule& schedule, std::size_t k) {
  std::string text;
  for (std::size_t column = 0; column < 8; ++column) {
    const LookIndex index = schedule.looks_of(k, NodeIndex(0))[column];
    const Look look = schedule.looks()[index];
    const char letter = "SBPDC"[static_cast<int>(look.effect)];
    text += index == kDark ? '.' : look.colour.blue > look.colour.red ? static_cast<char>(letter + 32) : letter;
  }
  return text;
}

TEST(CueSchedule, TellsWhatEveryLampShowsFromSwitchToSwitch) {
  const CueSchedule schedule = build(three_people());
  std::vector<std::string> told;
  for (std::size_t k = 0; k < schedule.switches().size(); ++k) {
    const Switch& s = schedule.switches()[k];
    told.push_back(std::to_string(static_cast<int>(to_seconds(s.time))) + " " + row(schedule, k) + " " + s.cause);
  }
  EXPECT_EQ(told, (std::vector<std::string>{
                      "0 S...S... opening",
                      "0 S...S... walks at count 1",
                      "2 S.C.S... walks at count 5 announced",
                      "4 ..S.S... walks at count 9",
                      "6 ..S.S... walks at count 13",
                      "8 c.S.S..C walks at count 17 announced",
                      "10 s...S..S walks at count 21",
                      "12 s...S... walks at count 25",
                  }));
}

TEST(CueSchedule, AnAnnouncementIsShortenedToTheMarkBeforeTheMove) {
  SmallShow small = three_people();
  small.show.announce_counts = 16;
  const CueSchedule schedule = build(small);
  std::vector<double> times;
  for (const Switch& s : schedule.switches()) times.push_back(to_seconds(s.time));
  EXPECT_EQ(times, (std::vector<double>{0, 0, 4, 6, 10, 12}));
  EXPECT_EQ(row(schedule, 0), "S.C.S...") << "announced in the opening already";
  EXPECT_EQ(row(schedule, 3), "c.S.S..C");
}

TEST(CueSchedule, ACellOfOneNowAndAnotherNextIsAHandover) {
  SmallShow small = three_people();
  // Person 3 makes place for person 2.
  const Grid& grid = small.plan.stage.grid;
  small.plan.tracks[1].back() = mark_at(12, grid, 4, 0);
  small.plan.tracks[2] = {mark_at(0, grid, 4, 0), mark_at(10, grid, 4, 0), mark_at(12, grid, 5, 0)};
  const CueSchedule schedule = build(small);
  EXPECT_EQ(row(schedule, 5), "..S.dC.C");
}

TEST(CueSchedule, AWearableShowsItsOwnPerformer) {
  SmallShow small = three_people();
  small.rig.nodes[0].channels = {{Channel::Kind::wearable, {}, PerformerIndex(0)},
                                 {Channel::Kind::wearable, {}, PerformerIndex(1)}};
  const CueSchedule schedule = build(small);
  std::vector<std::string> told;
  for (std::size_t k = 0; k < schedule.switches().size(); ++k) told.push_back(row(schedule, k).substr(0, 2));
  EXPECT_EQ(told, (std::vector<std::string>{"S.", "S.", "C.", "S.", "S.", "Cc", "Ss", ".s"}));
}

TEST(CueSchedule, TakesColoursAndEffectsThatTheShowChooses) {
  SmallShow small = three_people();
  small.show.looks[LampRole::here] = {Colour{0, 255, 0}, Effect::pulse, 40};
  small.show.looks[LampRole::next] = {std::nullopt, Effect::blink, 0};
  const CueSchedule schedule = build(small);
  const Look here = schedule.looks()[schedule.looks_of(0, NodeIndex(0))[0]];
  EXPECT_EQ(here, (Look{{0, 255, 0}, Effect::pulse, 40}));
  EXPECT_EQ(row(schedule, 2), "P...P...") << "a role of brightness 0 is dark";
}

TEST(CueSchedule, NumbersItsLooksByTheirOrderFromDarkOn) {
  const CueSchedule schedule = build(random_show(12, 8, 40, 2, 4, 3));
  EXPECT_EQ(schedule.looks()[0], (Look{{0, 0, 0}, Effect::steady, 0}));
  EXPECT_TRUE(std::is_sorted(schedule.looks().begin() + 1, schedule.looks().end()));
}

TEST(CueSchedule, IsTheSameWhenCompiledTwice) {
  SmallShow small = random_show(12, 8, 40, 2, 4, 3);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::serial, BusKind::can}, 115'200);
  const CueSchedule a = build(small);
  const CueSchedule b = build(small);
  EXPECT_EQ(a.looks(), b.looks());
  ASSERT_EQ(a.switches().size(), b.switches().size());
  for (std::size_t k = 0; k < a.switches().size(); ++k) {
    for (std::size_t n = 0; n < small.rig.nodes.size(); ++n) {
      EXPECT_TRUE(std::ranges::equal(a.looks_of(k, NodeIndex::of(n)), b.looks_of(k, NodeIndex::of(n))));
    }
  }
}

TEST(CueSchedule, PatternsLeaveFewLampsThatMislead) {
  SmallShow small = random_show(12, 8, 60, 2, 4, 3);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::can}, 500'000);
  const LampConfusion confusion = build(small).confusion();
  EXPECT_GT(confusion.before, 500U);
  EXPECT_LT(confusion.after * 5, confusion.before);
}

TEST(CueSchedule, ALampMisleadsWhenItIsANearGoalWithTheSameLook) {
  SmallShow small;
  const Grid grid = Grid::make(GridKind::square, 6, 3, 1.0).value();
  small.show.stage.grid = grid;
  // Two neighbours go up one row side by side; a third of the same colour goes two cells away from them.
  small.plan = plan_of(grid, {{mark_at(0, grid, 0, 0), mark_at(2, grid, 0, 1)},
                              {mark_at(0, grid, 1, 0), mark_at(2, grid, 1, 1)},
                              {mark_at(0, grid, 3, 0), mark_at(2, grid, 3, 1)}});
  small.plan.sections = {{"up", kStart, instant_at(2), 2, {}, {}, {}}};
  small.plan.valid = true;
  small.show.performers.resize(3);
  small.show.announce_counts = 0;
  small.rig = lamps_everywhere(grid, {BusKind::serial}, 115'200);
  const LampConfusion confusion = build(small).confusion();
  EXPECT_EQ(confusion.before, 4U) << "two people, in the opening and while they walk";
  EXPECT_EQ(confusion.after, 0U);
}

TEST(CueSchedule, RefusesAPlanThatIsNotProved) {
  SmallShow small = three_people();
  small.plan.valid = false;
  small.plan.title = "From vine to flower";
  const auto schedule = build_schedule(small.show, small.plan, small.rig, fake_drivers(small.rig));
  ASSERT_FALSE(schedule.has_value());
  EXPECT_EQ(schedule.error().kind, ErrorKind::refused);
  EXPECT_EQ(schedule.error().message,
            "the plan of \"From vine to flower\" is not valid and never lights a marker (footlight plan says what is "
            "wrong with it)");
}

TEST(CueSchedule, RefusesMoreColoursThanALookTableHolds) {
  SmallShow small = three_people();
  small.show.file = "show.yaml";
  small.show.groups.clear();
  small.show.performers.clear();
  small.plan.tracks.resize(1);
  for (std::uint8_t g = 0; g < 100; ++g) {
    small.show.groups.push_back({"g" + std::to_string(g), {g, 255, g}});
    Performer performer;
    performer.group = GroupIndex(g);
    small.show.performers.push_back(performer);
    if (g > 0) small.plan.tracks.push_back(small.plan.tracks[0]);
  }
  const auto schedule = build_schedule(small.show, small.plan, small.rig, fake_drivers(small.rig));
  ASSERT_FALSE(schedule.has_value());
  EXPECT_EQ(schedule.error(), input_error("show.yaml: error: performers.groups: the groups' colours need 301 looks and "
                                          "a marker's look table holds 254 (give groups that never "
                                          "stand side by side the same colour, or give looks a colour of their own)"));
}

TEST(BusBudget, ABusThatCannotCarryASwitchIsRefusedWithTheArithmetic) {
  SmallShow small = random_show(40, 32, 700, 1, 3, 9);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::serial}, 115'200, 8);
  small.rig.file = "rig.yaml";
  small.rig.buses[0].position = {"rig.yaml", 3, 7};
  // 160 nodes that change at every switch, a second apart: 4 ms for each preload, 3 ms for each receipt.
  const auto schedule = build_schedule(small.show, small.plan, small.rig, fake_drivers(small.rig));
  ASSERT_FALSE(schedule.has_value());
  EXPECT_EQ(schedule.error().kind, ErrorKind::refused);
  EXPECT_EQ(
      schedule.error().message,
      "rig.yaml:3:7: error: buses[0]: the serial bus \"bus1\" at 115200 bit/s cannot carry switch 5 \"s1/3\" (count 9, "
      "4.000 s) in time: preloads of 160 nodes that change 640.0 ms + 145 receipts of the switch before 435.0 ms + 2 "
      "latches 2.0 ms + 4 heartbeats 4.0 ms = 1081.0 ms; the switch before is 1000.0 ms earlier, of which 700.0 ms may "
      "be used and 30 % stay in reserve; 4 of 5 switches do not fit (share its nodes among 2 buses, or raise the bit "
      "rate, which does not shorten silences and turnarounds, or leave 3.09 counts between these switches instead of "
      "2.00)");
}

TEST(BusBudget, ABusThatCarriesItWithReserveIsNotRefused) {
  SmallShow small = random_show(40, 32, 700, 1, 3, 9);
  small.rig = lamps_everywhere(small.show.stage.grid, {BusKind::serial, BusKind::serial}, 115'200, 8);
  EXPECT_TRUE(build_schedule(small.show, small.plan, small.rig, fake_drivers(small.rig)).has_value());
}

TEST(PlanByte, IsTheLowestByteOfThePlansHash) {
  Plan plan = three_people().plan;
  plan.show_hash = "00ff3c";
  EXPECT_EQ(plan_byte_of(plan), 0x3C);
}

}  // namespace
}  // namespace footlight::controller
