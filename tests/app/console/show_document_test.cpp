// SPDX-License-Identifier: Apache-2.0
#include "app/console/show_document.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/simulated_buses.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value{};
  EXPECT_LE(place + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

class ShowDocumentTest : public ::testing::Test {
 protected:
  ShowDocumentTest() : small_(tests::random_show(8, 6, 12, 2, 2, 7)) {
    small_.rig = tests::lamps_everywhere(small_.show.stage.grid, {BusKind::serial, BusKind::can}, 115'200, 8);
  }
  void compare(const controller::CueSchedule& schedule) const;

  tests::SmallShow small_;
};

TEST_F(ShowDocumentTest, ThePlanHasEverybodysPlaceAtAnyTime) {
  const std::string bytes = plan_bytes(small_.plan, 3);
  EXPECT_EQ(bytes.substr(0, 4), "FLPM");
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 1U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 8), 3U);
  const auto people = at<std::uint32_t>(bytes, 12);
  const auto marks = at<std::uint32_t>(bytes, 16);
  ASSERT_EQ(people, small_.plan.tracks.size());
  const std::size_t first = 20;
  const std::size_t times = first + (people + 1) * 4;
  const std::size_t cells = times + marks * 4;
  ASSERT_EQ(bytes.size(), cells + marks * 4);
  for (std::size_t p = 0; p < people; ++p) {
    const auto from = at<std::uint32_t>(bytes, first + p * 4);
    const auto to = at<std::uint32_t>(bytes, first + p * 4 + 4);
    std::vector<Mark> track;
    for (std::size_t m = from; m < to; ++m) {
      track.push_back({instant_at(at<float>(bytes, times + m * 4)),
                       CellIndex::of(static_cast<std::size_t>(at<std::uint32_t>(bytes, cells + m * 4)))});
    }
    for (double t = -1; t < 20; t += 0.37) {
      const Point told = position_at(small_.plan.stage.grid, track, instant_at(t));
      const Point true_place = position_at(small_.plan.stage.grid, small_.plan.tracks[p], instant_at(t));
      EXPECT_LT(distance(told, true_place), 1e-4) << p << " at " << t;
    }
  }
}

TEST_F(ShowDocumentTest, TheShowIsWholeWithoutBuses) {
  small_.show.title = "\"</script><b>\xff";
  const auto json = nlohmann::json::parse(show_json({small_.show, small_.plan}));
  EXPECT_EQ(json["title"], "\"</script><b>\xef\xbf\xbd");
  EXPECT_EQ(json["performers"].size(), 12U);
  EXPECT_EQ(json["groups"].size(), 2U);
  EXPECT_EQ(json["stage"]["grid"], "square");
  EXPECT_EQ(json["stage"]["columns"], 8);
  EXPECT_EQ(json["sections"].size(), 2U);
  EXPECT_EQ(json["formations"].size(), small_.plan.formations.size());
  EXPECT_EQ(json["cues"].size(), 2U);
  EXPECT_FALSE(json["cues"][0].contains("most_percent"));
  EXPECT_EQ(json["tempo"][0]["count"], 1);
  EXPECT_EQ(json["rig"].size(), 0U);
  EXPECT_EQ(json["switches"], 0);
}

TEST_F(ShowDocumentTest, LooksAreThoseOfTheSchedule) {
  const auto used = with_schedule(small_.show, small_.plan, small_.rig,
                                  [&](const SimulatedSchedule& built) { compare(built.schedule); });
  ASSERT_TRUE(used) << used.error().message;
}

void ShowDocumentTest::compare(const controller::CueSchedule& schedule) const {
  const std::vector<controller::TempoLimit> limits{{118, "walks"}, {200, ""}};
  const auto json = nlohmann::json::parse(show_json({small_.show, small_.plan, &small_.rig, &schedule, &limits, 2}));
  EXPECT_EQ(json["epoch"], 2);
  EXPECT_EQ(json["markers"], 48);
  EXPECT_EQ(json["rig"].size(), small_.rig.nodes.size());
  EXPECT_EQ(json["rig"][0]["channels"][3], small_.rig.nodes[0].channels[3].cell.value());
  EXPECT_EQ(json["switch_at"].size(), schedule.switches().size());
  EXPECT_EQ(json["looks"].size(), schedule.looks().size());
  EXPECT_EQ(json["cues"][0]["most_percent"], 118);
  for (std::size_t k = 0; k < schedule.switches().size(); ++k) {
    const auto bytes = looks_bytes(schedule, small_.rig.nodes.size(), k, 2);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(at<std::uint32_t>(*bytes, 12), k);
    ASSERT_EQ(bytes->size(), 20 + small_.rig.nodes.size() * 32);
    for (std::size_t n = 0; n < small_.rig.nodes.size(); ++n) {
      const auto looks = schedule.looks_of(k, NodeIndex::of(n));
      EXPECT_TRUE(std::ranges::equal(looks, bytes->substr(20 + n * 32, 32), {}, {},
                                     [](char c) { return static_cast<LookIndex>(c); }));
    }
  }
  for (const std::size_t k : {schedule.switches().size(), std::size_t{1} << 31, std::size_t{0xffff'ffff}}) {
    EXPECT_FALSE(looks_bytes(schedule, small_.rig.nodes.size(), k, 2)) << k;
  }
}

}  // namespace
}  // namespace footlight::app
