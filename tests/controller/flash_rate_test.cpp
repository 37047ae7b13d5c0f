// SPDX-License-Identifier: Apache-2.0
#include "controller/flash_rate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "controller/bus_budget.hpp"
#include "controller/cue_engine.hpp"
#include "controller/tempo_limit.hpp"
#include "core/rng.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::controller {
namespace {

constexpr Look kDarkLook{{0, 0, 0}, Effect::steady, 0};
Look lit(Effect effect) { return {{200, 0, 0}, effect, 255}; }

TEST(FlashRate, ALampThatIsSwitchedOnAndOffFlashesWithTheTempo) {
  // On and off every quarter of a second at the written tempo: two flashes a second.
  std::vector<LampStretch> stretches;
  for (int i = 0; i < 40; ++i)
    stretches.push_back({instant_at(0.25 * i), i % 2 == 0 ? kDarkLook : lit(Effect::steady)});
  EXPECT_EQ(most_flashes(stretches, 50), 1);
  EXPECT_EQ(most_flashes(stretches, 100), 2);
  EXPECT_EQ(most_flashes(stretches, 149), 3);
  EXPECT_EQ(most_flashes(stretches, 152), 4);
}

TEST(FlashRate, AnEffectKeepsItsOwnTime) {
  for (const Effect effect : {Effect::blink, Effect::pulse, Effect::count_down, Effect::double_blink}) {
    const std::vector<LampStretch> always{{kStart, lit(effect)}};
    EXPECT_LE(most_flashes(always, 25), 2);
    EXPECT_EQ(most_flashes(always, 25), most_flashes(always, 200));
  }
}

/// Whether a lamp with an effect is lit `t_s` after the effect began.
bool is_lit(const Look& look, double t_s) {
  if (look.brightness == 0) return false;
  switch (look.effect) {
    case Effect::steady:
      return true;
    case Effect::blink:
    case Effect::count_down:
      return std::fmod(t_s, 1.0) < 0.5;
    case Effect::pulse:
      return std::fmod(t_s, 2.0) < 1.0;
    case Effect::double_blink: {
      const double t = std::fmod(t_s, 1.2);
      return t < 0.2 || (t >= 0.4 && t < 0.6);
    }
  }
  return false;
}

/// Most times that it lights up within a second, seen every 5 ms. @param phase_s of the effects, on the marker's clock
int seen(const std::vector<LampStretch>& stretches, int percent, double phase_s) {
  std::vector<double> lights_up_s;
  bool before = false;
  std::size_t k = 0;
  const double end_s = to_seconds(stretches.back().from) * 100 / percent + 3;
  for (double t = 0; t < end_s; t += 0.005) {
    const std::size_t was = k;
    while (k + 1 < stretches.size() && to_seconds(stretches[k + 1].from) * 100 / percent <= t) ++k;
    const bool now = is_lit(stretches[k].look, t + phase_s);
    // Another look in the place of a lit one is seen, too.
    if (now && (!before || k != was)) lights_up_s.push_back(t);
    before = now;
  }
  std::size_t most = 0;
  for (std::size_t i = 0; i < lights_up_s.size(); ++i) {
    std::size_t j = i;
    while (j < lights_up_s.size() && lights_up_s[j] < lights_up_s[i] + 1 - 0.011) ++j;
    most = std::max(most, j - i);
  }
  return static_cast<int>(most);
}

TEST(FlashRateProperty, IsNoLessThanWhatIsSeen) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Rng rng(seed);
    std::vector<LampStretch> stretches;
    double at_s = 0;
    for (int i = 0; i < 12; ++i) {
      const auto effect = static_cast<Effect>(rng.below(5));
      stretches.push_back({instant_at(at_s), rng.below(3) == 0 ? kDarkLook : lit(effect)});
      at_s += 0.1 + 2 * rng.uniform() * rng.uniform();
    }
    const int percent = 25 + static_cast<int>(rng.below(176));
    RC_ASSERT(seen(stretches, percent, 5 * rng.uniform()) <= most_flashes(stretches, percent));
  }));
}

TEST(FlashRateProperty, NoLampOfAShowFlashesAboveThreeHertzAtAnyTempoThatIsAllowed) {
  int limited = 0;
  EXPECT_TRUE(rc::check([&](std::uint64_t seed) {
    // Everybody's walks take half a second, so that floor lamps change at every count.
    tests::SmallShow small = tests::random_show(4, 4, 7, 2, 6, seed);
    for (auto& track : small.plan.tracks) {
      for (Mark& mark : track) mark.time = Instant(mark.time.time_since_epoch() / 3);
    }
    for (PlanSection& section : small.plan.sections) {
      section.start = Instant(section.start.time_since_epoch() / 3);
      section.end = Instant(section.end.time_since_epoch() / 3);
      section.max_speed_mps = 100;
    }
    small.show.tempo = TempoMap(180);
    small.rig = tests::lamps_everywhere(small.plan.stage.grid, {BusKind::serial}, 115'200);
    small.rig.buses.clear();  // whatever a bus can carry
    const auto schedule = build_schedule(small.show, small.plan, small.rig, {});
    RC_ASSERT(static_cast<bool>(schedule));
    const auto plays = cue_plays(small.show, small.plan);
    const auto limits = tempo_limits(small.plan, small.show.tempo, plays, *schedule, {}, small.rig);
    Rng rng(seed);
    for (std::size_t channel = 0; channel < 16; ++channel) {
      std::vector<LampStretch> stretches;
      for (std::size_t k = 0; k < schedule->switches().size(); ++k) {
        const Look look = schedule->looks()[schedule->looks_of(k, NodeIndex(0))[channel]];
        if (stretches.empty() || stretches.back().look != look)
          stretches.push_back({schedule->switches()[k].time, look});
      }
      const int most = std::min(limits[0].percent, limits[1].percent);
      limited += limits[0].percent < kFastest_percent ? 1 : 0;
      if (most == 100 && most_flashes(stretches, 100) > kMostFlashes) continue;  // told, and never faster
      for (const int percent : {25, 50, 100, most}) {
        RC_ASSERT(seen(stretches, std::min(percent, most), 5 * rng.uniform()) <= kMostFlashes);
      }
    }
  }));
  EXPECT_GT(limited, 0) << "some of these shows would flash at 200 %";
}

}  // namespace
}  // namespace footlight::controller
