// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include <gtest/gtest.h>

#include "core/parts.hpp"

namespace footlight::app {
namespace {

constexpr const char* kVideo = FOOTLIGHT_TEST_DATA "/moving_square_40x30_12_frames_10fps.avi";
constexpr const char* kImage = FOOTLIGHT_TEST_DATA "/block_40x30.png";

Section section(const std::string& name, Source from, double start, int line) {
  Section out;
  out.name = name;
  out.from = std::move(from);
  out.start_count = start;
  out.position = {"show.yaml", line, 5};
  return out;
}

Source video(const std::string& path) {
  VideoSource out;
  out.path = path;
  return out;
}
Source image(const std::string& path) {
  ImageSource out;
  out.path = path;
  return out;
}

class DecodeFilms : public ::testing::Test {
 protected:
  Result<Films> decode() { return decode_films(session_, loaded_); }
  std::vector<Section>& sections() { return loaded_.show.sections; }

  std::atomic<bool> stop_ = false;
  Session session_{stop_};
  config::LoadedShow loaded_;
};

TEST_F(DecodeFilms, GivesAFilmForEachVideoAndImage) {
  sections() = {section("a", video(kVideo), 1, 10), section("b", CellsSource{}, 100, 11),
                section("c", image(kImage), 200, 12)};
  const auto films = decode();
  ASSERT_TRUE(films) << films.error().message;
  ASSERT_EQ(films->size(), 3U);
  EXPECT_EQ((*films)[0]->frames.size(), 12U);
  EXPECT_FALSE((*films)[1]);
  EXPECT_EQ((*films)[2]->frames.size(), 1U);
  EXPECT_TRUE((*films)[2]->frames[0].at(20, 15));
}

TEST_F(DecodeFilms, AVideoWithoutADurationKeepsItsOwnLength) {
  loaded_.show.tempo = TempoMap(120, 4);
  sections() = {section("a", video(kVideo), 1, 10)};
  ASSERT_TRUE(decode());
  EXPECT_NEAR(sections()[0].duration_counts, 11 / 10.0 * 2,
              1e-9);  // 11 steps of a tenth of a second, 2 counts a second
}

TEST_F(DecodeFilms, AGivenDurationStays) {
  sections() = {section("a", video(kVideo), 1, 10)};
  sections()[0].duration_counts = 64;
  ASSERT_TRUE(decode());
  EXPECT_EQ(sections()[0].duration_counts, 64);
}

TEST_F(DecodeFilms, AFilmThatRunsIntoTheNextSectionIsReportedThere) {
  loaded_.show.tempo = TempoMap(120, 4);
  sections() = {section("a", video(kVideo), 1, 10), section("b", image(kImage), 3, 11)};
  const auto films = decode();
  ASSERT_FALSE(films);
  EXPECT_EQ(films.error(), input_error("show.yaml:11:5: error: sections[1].start: section \"b\" starts at count 3, and "
                                       "section \"a\" lasts until count "
                                       "3.2 (start it at count 3.2 or later)"));
}

TEST_F(DecodeFilms, EveryWrongFilmIsReportedAtItsSection) {
  sections() = {section("a", video("/nowhere/a.mp4"), 1, 10), section("b", image("/nowhere/b.png"), 9, 12)};
  const auto films = decode();
  ASSERT_FALSE(films);
  EXPECT_EQ(films.error(),
            input_error("show.yaml:10:5: error: sections[0].from.video: cannot read '/nowhere/a.mp4': No such file or "
                        "directory\n"
                        "show.yaml:12:5: error: sections[1].from.image: cannot read '/nowhere/b.png': No such file or "
                        "directory"));
}

TEST_F(DecodeFilms, OfPartsHaveAFrameForEachPictureAndAreReportedAtTheirPart) {
  Part shape;
  Part word;
  word.drawing = Lettering{"A", "DejaVu Sans"};
  word.position = {"show.yaml", 11, 7};
  Part block;
  block.drawing = Picture{kImage, {}};
  const auto source = [](std::vector<Part> parts) {
    return PartsSource{std::make_shared<const std::vector<Part>>(std::move(parts))};
  };
  sections() = {section("a", source({shape}), 1, 10), section("b", source({word, shape, block}), 9, 10)};
  const auto films = decode();
  ASSERT_TRUE(films) << films.error().message;
  EXPECT_FALSE((*films)[0]);
  EXPECT_EQ((*films)[1]->frames.size(), 2U);
  word.drawing = Lettering{"\xE8\xB5\xB0", "DejaVu Sans"};
  sections() = {section("b", source({shape, word}), 9, 10)};
  const auto refused = decode();
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      refused.error(),
      input_error("show.yaml:11:7: error: sections[0].from.parts[1].text: the font 'DejaVu Sans' has no character "
                  "'\xE8\xB5\xB0' (U+8D70) (another font may have it)"));
}

TEST_F(DecodeFilms, OfAPaintingAreItsColours) {
  sections() = {section("a", PaintingSource{kImage}, 1, 10), section("b", PaintingSource{"/nowhere/c.png"}, 9, 12)};
  const auto films = decode();
  ASSERT_FALSE(films);
  EXPECT_EQ(films.error(), input_error("show.yaml:12:5: error: sections[1].from.painting: cannot read "
                                       "'/nowhere/c.png': No such file or directory"));
  sections().pop_back();
  const auto one = decode();
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ((*one)[0]->rgb.size(), 3U * 40 * 30);
}

TEST_F(DecodeFilms, AnInterruptionIsNoErrorOfTheFile) {
  stop_ = true;
  sections() = {section("a", video(kVideo), 1, 10)};
  const auto films = decode();
  ASSERT_FALSE(films);
  EXPECT_EQ(films.error().kind, ErrorKind::interrupted);
}

TEST(TakeDurations, AreThoseOfThePlan) {
  Show show;
  show.tempo = TempoMap(120, 4);
  show.sections = {section("a", video("v"), 1, 1), section("b", video("v"), 50, 2)};
  show.sections[0].hold_counts = 2;
  show.sections[1].duration_counts = 7;
  Plan plan;
  plan.sections.resize(2);
  plan.sections[0].end = instant_at(10);  // count 21
  take_durations(show, plan);
  EXPECT_DOUBLE_EQ(show.sections[0].duration_counts, 18);
  EXPECT_EQ(show.sections[1].duration_counts, 7);
}

TEST(TakePeople, LeavesOutWhomThePlanDoesWithout) {
  config::LoadedShow loaded;
  Show& show = loaded.show;
  for (const char* id : {"a", "b", "c"}) show.performers.emplace_back().id = id;
  const std::vector<CellIndex> cells{CellIndex(10), CellIndex(20), CellIndex(30)};
  show.sections = {section("named", CellsSource{"n.csv", cells}, 1, 1),
                   section("free", CellsSource{"f.csv", cells, false}, 5, 1)};
  show.sections[0].overrides.emplace_back().pin = {{PerformerIndex(1), cells[0], {}},
                                                   {PerformerIndex(2), cells[1], {}}};
  loaded.rig.nodes.emplace_back().channels = {{Channel::Kind::wearable, {}, PerformerIndex(1)},
                                              {Channel::Kind::wearable, {}, PerformerIndex(2)},
                                              {Channel::Kind::cell, CellIndex(3), {}}};
  Plan plan;
  plan.performers = {"a", "c"};
  plan.formations.resize(2);
  plan.formations[1].section = SectionIndex(1);
  plan.formations[1].cells = {cells[2], cells[1]};
  take_people(loaded, plan);
  ASSERT_EQ(show.performers.size(), 2U);
  EXPECT_EQ(show.performers[1].id, "c");
  EXPECT_EQ(std::get<CellsSource>(show.sections[0].from).cells, (std::vector<CellIndex>{cells[0], cells[2]}));
  EXPECT_EQ(std::get<CellsSource>(show.sections[1].from).cells, (std::vector<CellIndex>{cells[1], cells[2]}));
  ASSERT_EQ(show.sections[0].overrides[0].pin.size(), 1U);
  EXPECT_EQ(show.sections[0].overrides[0].pin[0].performer, PerformerIndex(1));
  const auto& channels = loaded.rig.nodes[0].channels;
  EXPECT_EQ(channels[0].kind, Channel::Kind::unused);
  EXPECT_EQ(channels[1].kind, Channel::Kind::wearable);
  EXPECT_EQ(channels[1].performer, PerformerIndex(1));
  EXPECT_EQ(channels[2].cell, CellIndex(3));
}

}  // namespace
}  // namespace footlight::app
