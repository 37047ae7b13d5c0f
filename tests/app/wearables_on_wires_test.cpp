// SPDX-License-Identifier: Apache-2.0
// What wearables tell: from the plan over the real driver and a simulated line to the wearer.
#include <algorithm>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "app/simulated_buses.hpp"
#include "controller/bus_loop.hpp"
#include "controller/cue_schedule.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

/// Eight people, each with a wearable, four on a node of a serial line.
tests::SmallShow people_with_wearables() {
  tests::SmallShow small = tests::random_show(8, 6, 8, 1, 4, 3);
  Bus bus;
  bus.name = "air";
  bus.kind = BusKind::serial;
  bus.url = "sim://serial";
  small.rig.buses = {bus};
  small.rig.nodes.clear();
  for (int n = 0; n < 2; ++n) {
    Node node;
    node.name = "air-" + std::to_string(n + 1);
    node.bus = BusIndex(0);
    node.address = n + 1;
    for (int c = 0; c < 4; ++c) {
      node.channels.push_back({Channel::Kind::wearable, {}, PerformerIndex::of(static_cast<std::size_t>(4 * n + c))});
    }
    small.rig.nodes.push_back(node);
  }
  return small;
}

/// Plays the switches in virtual time. @return wearables that told something else than planned, just before a switch
struct Played {
  int compared = 0;
  int wrong = 0;
  int counted = 0;     ///< wearables that counted down
  int miscounted = 0;  ///< and were not at the count that the plan says
};

Played play(const std::string& faults, std::uint64_t seed) {
  const tests::SmallShow small = people_with_wearables();
  ManualClock clock;
  const sim::Faults wrong = faults.empty() ? sim::Faults{} : sim::Faults::parse(faults).value();
  sim::SimulatedRig simulated(small.rig, wrong, seed, clock, nullptr);
  auto drivers = drivers_on(simulated, small.rig, small.plan);
  EXPECT_TRUE(drivers);
  const auto schedule = controller::build_schedule(small.show, small.plan, small.rig, *drivers);
  EXPECT_TRUE(schedule) << (schedule ? "" : schedule.error().message);
  if (!drivers || !schedule) return {};
  controller::BusLoop loop(*schedule, drivers::node_addresses(small.rig, BusIndex(0)), *drivers->at(0));
  const auto& switches = schedule->switches();
  const Instant start = instant_at(5);  // of show time 0
  const auto at = [&](std::size_t k) { return start + switches[k].time.time_since_epoch(); };
  Played played;
  std::size_t current = 0;
  const Instant end = at(switches.size() - 1) + milliseconds(500);
  while (clock.now() < end) {
    const Instant now = clock.now();
    while (current + 1 < switches.size() && now >= at(current + 1)) ++current;
    controller::BusTarget target;
    target.current = current;
    target.next = std::min(current + 1, switches.size() - 1);
    target.next_at = target.next == current ? kNever : at(target.next);
    target.show_time = std::max(Duration{}, now - start);
    const Instant wish = loop.step(now, target);
    const Instant look = target.next_at == kNever ? kNever : target.next_at - milliseconds(50);
    if (look == now) {
      const controller::WearableContents& contents = schedule->contents();
      for (std::size_t w = 0; w < contents.worn.size(); ++w) {
        const drivers::WearableContent& planned = contents.at(current, w);
        const sim::NodeContent& told = simulated.content(contents.worn[w].node, contents.worn[w].channel);
        ++played.compared;
        const bool same =
            told.walks == planned.walks &&
            (!planned.walks || (told.direction == planned.direction && told.distance_cm == planned.distance_cm &&
                                told.starts_ms == planned.starts_ms && told.count_ms == planned.count_ms));
        played.wrong += same ? 0 : 1;
        const auto left = simulated.counts_left(contents.worn[w].node, contents.worn[w].channel);
        if (!same || !planned.walks || now < start) continue;
        const auto ms = static_cast<std::int64_t>(planned.starts_ms) - (now - start) / milliseconds(1);
        const auto counts = ms <= 0 ? 0 : (ms + planned.count_ms - 1) / planned.count_ms;
        ++played.counted;
        played.miscounted += left && *left == counts ? 0 : 1;
      }
    }
    Instant next = std::min({wish, simulated.next_event(), at(std::min(current + 1, switches.size() - 1)), end});
    if (look > now) next = std::min(next, look);
    simulated.advance_to(std::max(next, now + microseconds(1)));
  }
  return played;
}

TEST(Wearables, TellDirectionDistanceAndCountsOfTheirNextWalk) {
  const Played played = play("", 1);
  EXPECT_GT(played.compared, 40);
  EXPECT_EQ(played.wrong, 0);
  EXPECT_GT(played.counted, 20);
  EXPECT_EQ(played.miscounted, 0);
}

TEST(Wearables, AreToldAgainWhatGotLost) {
  int wrong = 0;
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Played played = play("loss=5%", seed);
    wrong += played.wrong;
    compared += played.compared;
  }
  EXPECT_LT(wrong, compared / 50) << "of " << compared;
}

}  // namespace
}  // namespace footlight::app
