// SPDX-License-Identifier: Apache-2.0
#include "config/starter_show.hpp"

#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

TEST(StarterShow, LoadsAsItIs) {
  ShowFolder folder;
  for (const auto& [name, content] : starter_show("My \"first\" show: a\\b")) folder.write(name, content);
  const auto loaded = load_show(folder.path("show.yaml"));
  ASSERT_TRUE(loaded) << loaded.error().to_text();
  const Show& show = loaded.value().show;
  EXPECT_EQ(show.title, "My \"first\" show: a\\b");
  EXPECT_EQ(show.performers.size(), 12U);
  EXPECT_EQ(show.sections.size(), 3U);
  EXPECT_EQ(show.cues.size(), 3U);
  EXPECT_TRUE(loaded.value().warnings.empty());
  EXPECT_EQ(loaded.value().rig.buses.size(), 3U);
}

TEST(StarterShow, SurvivesAnyTitle) {
  for (const char* title : {"", "# no comment", "{", "a\nb", "Grüße – 舞台", "\xFF"}) {
    ShowFolder folder;
    for (const auto& [name, content] : starter_show(title)) folder.write(name, content);
    const auto loaded = load_show(folder.path("show.yaml"));
    EXPECT_TRUE(loaded) << title;
  }
}

TEST(StarterShow, NobodyNeedsToRunNorToSqueezeThrough) {
  ShowFolder folder;
  for (const auto& [name, content] : starter_show("x")) folder.write(name, content);
  const auto loaded = load_show(folder.path("show.yaml"));
  ASSERT_TRUE(loaded) << loaded.error().to_text();
  const Show& show = loaded.value().show;
  for (std::size_t s = 1; s < show.sections.size(); ++s) {
    const auto& from = std::get<CellsSource>(show.sections[s - 1].from).cells;
    const auto& to = std::get<CellsSource>(show.sections[s].from).cells;
    const double walk_s =
        to_seconds(show.tempo.at(show.sections[s].start_count) - show.tempo.at(show.sections[s - 1].end_count()));
    for (std::size_t p = 0; p < from.size(); ++p) {
      const double walk_m = distance(show.stage.grid.centre(from[p]), show.stage.grid.centre(to[p]));
      EXPECT_LE(walk_m / walk_s, 0.8 * show.stage.max_speed_mps) << show.performers[p].id;
      for (std::size_t q = 0; q < p; ++q) {
        for (int step = 0; step <= 1000; ++step) {
          const auto at = [&](std::size_t who) {
            const Point a = show.stage.grid.centre(from[who]);
            return a + step / 1000.0 * (show.stage.grid.centre(to[who]) - a);
          };
          ASSERT_GE(distance(at(p), at(q)), show.stage.clearance_m) << p << " and " << q;
        }
      }
    }
  }
}

}  // namespace
}  // namespace footlight::config
