// SPDX-License-Identifier: Apache-2.0
#include "app/import/show_files.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "core/rng.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

Show written_and_read(const Show& show) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "formations");
  for (const auto& [name, content] : show_files(show, {"of\na test"})) folder.write(name, content);
  const auto loaded = config::load_show(folder.path() / "show.yaml");
  EXPECT_TRUE(loaded) << loaded.error().to_text() << folder.read("show.yaml");
  return loaded ? loaded->show : Show();
}

Show odd_show() {
  Show show;
  show.title = "\"Übung\": # 1\n\\ {x} \x7F";
  show.stage.grid = *Grid::make(GridKind::hexagonal, 9, 7, 0.7);
  show.stage.walk = WalkKind::straight;
  show.stage.clearance_m = 0.45;
  show.stage.max_speed_mps = 2.3;
  show.stage.lag = milliseconds(150);
  for (const int cell : {0, 1, 2, 9, 10, 11, 30}) show.stage.reserve.push_back(CellIndex::of(cell));
  show.stage.blocked = {CellIndex::of(62)};
  show.groups = {{"#1, \"one\"", {1, 2, 3}, true}, {"two", {255, 0, 0}, false}};
  for (const char* id : {"1", "#2", "D,3", "\"4\"", " 5", "é"}) {
    Performer performer;
    performer.id = performer.name = id;
    if (show.performers.size() % 2 == 0) performer.group = GroupIndex::of(show.performers.size() % 4 / 2);
    show.performers.push_back(performer);
  }
  show.performers[1].radius_m = 0.3;
  show.performers[2].max_speed_mps = 0.9;
  show.performers[3].wearable = "W,1";
  TempoMap tempo = *TempoMap::from({{1, 60e6 / 455'123}, {4.125, 90}, {12, 1.0 / 3 + 60}}, 3, 2);
  EXPECT_TRUE(tempo.change_meter(12, 5));
  show.tempo = tempo;
  for (int s = 0; s < 3; ++s) {
    Section section;
    section.name = "set " + std::to_string(s) + ": \"#\"";
    section.start_count = 1.25 + 9.001 * s;
    section.hold_counts = s * 1.5;
    CellsSource cells;
    for (int p = 0; p < 6; ++p) cells.cells.push_back(CellIndex::of(12 + 3 * p + s));
    section.from = cells;
    show.sections.push_back(section);
  }
  return show;
}

TEST(ShowFiles, AreReadBackAsTheSameShow) {
  const Show show = odd_show();
  const Show back = written_and_read(show);
  EXPECT_EQ(back.title, "\"Übung\": # 1 \\ {x}  ");
  EXPECT_EQ(back.stage, show.stage);
  EXPECT_EQ(back.tempo, show.tempo);
  ASSERT_EQ(back.performers.size(), show.performers.size());
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    EXPECT_EQ(back.performers[p].id, show.performers[p].id);
    EXPECT_EQ(back.performers[p].group, show.performers[p].group);
    EXPECT_EQ(back.performers[p].radius_m, show.performers[p].radius_m);
    EXPECT_EQ(back.performers[p].max_speed_mps, show.performers[p].max_speed_mps);
    EXPECT_EQ(back.performers[p].wearable, show.performers[p].wearable);
  }
  ASSERT_EQ(back.groups.size(), 2U);
  EXPECT_EQ(back.groups[0].name, "#1, \"one\"");
  EXPECT_FALSE(back.groups[1].exchange);
  ASSERT_EQ(back.sections.size(), 3U);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(back.sections[s].name, show.sections[s].name);
    EXPECT_EQ(back.sections[s].start_count, show.sections[s].start_count);
    EXPECT_EQ(back.sections[s].hold_counts, show.sections[s].hold_counts);
    EXPECT_EQ(std::get<CellsSource>(back.sections[s].from).cells, std::get<CellsSource>(show.sections[s].from).cells);
  }
}

TEST(ShowFiles, ManyCellsAreFewRectangles) {
  Show show = odd_show();
  show.stage.grid = *Grid::make(GridKind::square, 300, 300, 1);
  show.stage.blocked.clear();
  show.stage.reserve.clear();
  Rng rng(7);
  for (int cell = 0; cell < 90'000; ++cell) {
    if (cell / 300 > 100 || rng.below(3) == 0) show.stage.reserve.push_back(CellIndex::of(cell));
  }
  EXPECT_EQ(written_and_read(show).stage.reserve, show.stage.reserve);
}

TEST(MusicYaml, SaysTempoMeterPickUpAndMarks) {
  EXPECT_EQ(music_yaml(TempoMap(100, 3), {}), "music:\n  tempo: 100\n  meter: 3/4\n");
  TempoMap tempo = *TempoMap::from({{1, 120}, {10, 60}}, 4, 1);
  ASSERT_TRUE(tempo.change_meter(10, 3));
  EXPECT_EQ(music_yaml(tempo, {{10, "B\nroll"}}),
            "music:\n  meter: 4/4\n  pickup: 1 counts\n  changes:\n    - {at: count 1, tempo: 120}\n"
            "    - {at: count 10, tempo: 60, meter: 3/4}\n  # count 10 (measure 3:1): B roll\n");
}

}  // namespace
}  // namespace footlight::app
