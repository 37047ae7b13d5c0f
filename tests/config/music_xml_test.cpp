// SPDX-License-Identifier: Apache-2.0
#include "config/music_xml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"
#include "tests/support/program.hpp"

namespace footlight::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string score_with(const std::string& measures) {
  return "<?xml version=\"1.0\"?>\n<!DOCTYPE score-partwise PUBLIC \"-//Recordare//DTD MusicXML 4.0 Partwise//EN\" "
         "\"http://www.musicxml.org/dtds/partwise.dtd\">\n<score-partwise version=\"4.0\">\n"
         "<part-list><score-part id=\"P1\"><part-name>Snare</part-name></score-part></part-list>\n<part id=\"P1\">\n" +
         measures + "</part>\n</score-partwise>\n";
}
std::string note(int duration) { return "<note><rest/><duration>" + std::to_string(duration) + "</duration></note>"; }
std::string attributes(int divisions, int beats, int type) {
  return "<attributes><divisions>" + std::to_string(divisions) + "</divisions><time><beats>" + std::to_string(beats) +
         "</beats><beat-type>" + std::to_string(type) + "</beat-type></time></attributes>";
}
std::string measure(const std::string& content, const std::string& more = "") {
  return "<measure number=\"1\"" + more + ">" + content + "</measure>\n";
}
std::string sound(const std::string& tempo) {
  return "<direction><direction-type><words>Allegro</words></direction-type><sound tempo=\"" + tempo +
         "\"/></direction>";
}
std::string rehearsal(const std::string& text) {
  return "<direction><direction-type><rehearsal>" + text + "</rehearsal></direction-type></direction>";
}
Score score(const std::string& xml) {
  const auto events = read_music_xml(xml, "song.musicxml");
  EXPECT_TRUE(events) << events.error();
  auto out = score_of(*events, CountUnit::beat, "song.musicxml");
  EXPECT_TRUE(out) << out.error();
  return *out;
}
std::string error_of(const std::string& xml) { return read_music_xml(xml, "song.musicxml").error().message; }

TEST(MusicXml, TempoMeterAndRehearsalMarks) {
  const Score read = score(score_with(measure(attributes(2, 4, 4) + sound("132") + note(8)) +
                                      measure(rehearsal("A") + note(4) + sound("66") + note(4)) +
                                      measure(attributes(2, 3, 4) + rehearsal("B") + note(6)) + measure(note(6))));
  TempoMap expected = *TempoMap::from({{1, 132}, {7, 66}}, 4);
  ASSERT_TRUE(expected.change_meter(9, 3));
  EXPECT_EQ(read.tempo, expected);
  EXPECT_EQ(read.counts, 14);
  ASSERT_EQ(read.rehearsals.size(), 2U);
  EXPECT_EQ(read.rehearsals[0].count, 5);
  EXPECT_EQ(read.rehearsals[1].count, 9);
  EXPECT_EQ(read.rehearsals[1].text, "B");
}

TEST(MusicXml, AFirstMeasureThatIsNotFullIsAPickUp) {
  const Score read =
      score(score_with(measure(attributes(1, 4, 4) + sound("120") + note(1), " implicit=\"yes\"") + measure(note(4))));
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 120}}, 4, 1));
  EXPECT_EQ(read.tempo.measure_beat(2), "1:1");
}

TEST(MusicXml, MetronomeMarksSayWhatSoundDoesNot) {
  const std::string mark =
      "<direction><direction-type><metronome><beat-unit>quarter</beat-unit><beat-unit-dot/><per-minute>80</per-minute>"
      "</metronome></direction-type></direction>";
  const Score read = score(score_with(measure(attributes(2, 6, 8) + mark + note(6))));
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 80}}, 2)) << "6/8 has two counts";
}

TEST(MusicXml, RepeatsArePlayedOutWithTheTempoThatStandsThere) {
  const std::string back = "<barline location=\"right\"><repeat direction=\"backward\"/></barline>";
  const std::string forth = "<barline location=\"left\"><repeat direction=\"forward\"/></barline>";
  const Score read = score(score_with(measure(attributes(1, 2, 4) + sound("60") + note(2)) +
                                      measure(forth + rehearsal("A") + note(2)) +
                                      measure(sound("90") + note(2) + back) + measure(note(2))));
  EXPECT_EQ(read.counts, 12);
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 60}, {5, 90}, {7, 60}, {9, 90}}, 2));
  ASSERT_EQ(read.rehearsals.size(), 2U);
  EXPECT_EQ(read.rehearsals[1].count, 7);
  EXPECT_THAT(read.ignored, ElementsAre(HasSubstr("repeats are played out")));
}

TEST(MusicXml, OtherPartsAddTheirMarksAndLengths) {
  const std::string xml = score_with(measure(attributes(1, 4, 4) + sound("100") + note(4)) + measure(note(4)));
  const std::string second = "</part><part id=\"P2\">" + measure(attributes(3, 4, 4) + note(12)) +
                             measure(note(6) + rehearsal("X") + "<backup><duration>6</duration></backup>" + note(12));
  std::string both = xml;
  both.insert(both.find("</part>\n</score"), second);
  const Score read = score(both);
  EXPECT_EQ(read.counts, 8);
  ASSERT_EQ(read.rehearsals.size(), 1U);
  EXPECT_EQ(read.rehearsals[0].count, 7);
}

TEST(MusicXml, WhatIsNotKeptIsTold) {
  const Score read =
      score(score_with(measure(attributes(1, 4, 4) + sound("100") +
                               "<direction><direction-type><words>molto rit.</words></direction-type></direction>" +
                               "<note><rest/><duration>4</duration><notations><fermata/></notations></note>")));
  EXPECT_THAT(read.ignored,
              ElementsAre("\"molto rit.\": words do not change the tempo, marks do", "fermatas: nobody waits on them"));
}

TEST(MusicXml, WrongScoresAreRefusedWithTheirPlace) {
  EXPECT_EQ(error_of("<score-timewise/>"),
            "song.musicxml:1:2: error: a score-timewise (save it as score-partwise, as programs do by themselves)");
  EXPECT_EQ(error_of("<html></html>"), "song.musicxml:1:2: error: \"html\" is no MusicXML score (score-partwise)");
  EXPECT_EQ(error_of("<score-partwise>\n<part>\n<oops</part>"),
            "song.musicxml:3:7: error: no XML that can be read: Error parsing start element tag");
  EXPECT_EQ(error_of("<score-partwise/>"), "song.musicxml:1:2: error: no measure is in the score");
  EXPECT_EQ(error_of(score_with(measure(note(4)))),
            "song.musicxml:6:22: error: no <divisions> say before here how long a duration is");
  EXPECT_EQ(error_of(score_with(measure(attributes(1, 4, 4) + "<sound tempo=\"fast\"/>"))),
            "song.musicxml:6:124: error: \"fast\" is no number of <sound> (0 to 1e+06)");
  EXPECT_EQ(error_of(score_with(measure(attributes(1, 4, 3)))),
            "song.musicxml:6:58: error: a time signature of 4/3 (1 to 64 over 1, 2, 4 ... 64)");
  EXPECT_THAT(error_of(score_with(measure(attributes(1, 4, 4) + note(4) + "<sound dacapo=\"yes\"/>"))),
              HasSubstr("a jump (da capo) is not played out (write the music as it is played, or save it as MIDI)"));
}

TEST(MusicXml, EntitiesAreNotFollowed) {
  std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\">";
  for (char c = 'b'; c < 'k'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int k = 0; k < 10; ++k) bomb += std::string("&") + static_cast<char>(c - 1) + ";";
    bomb += "\">";
  }
  bomb += "<!ENTITY file SYSTEM \"file:///etc/passwd\">]>\n<score-partwise><part id=\"P1\"><measure>" +
          attributes(1, 4, 4) + rehearsal("&j;&file;") + note(4) + "</measure></part></score-partwise>";
  const Score read = score(bomb);
  ASSERT_EQ(read.rehearsals.size(), 1U);
  EXPECT_EQ(read.rehearsals[0].text, "&j;&file;");
}

TEST(MusicXml, DeepScoresAreAnswered) {
  std::string deep;
  for (int k = 0; k < 200'000; ++k) deep += "<a>";
  EXPECT_THAT(error_of(deep), HasSubstr("no XML that can be read"));
}

TEST(CompressedMusicXml, IsTheScoreThatItsContainerNames) {
  const test::TemporaryFolder folder;
  folder.write("song.xml", score_with(measure(attributes(1, 4, 4) + sound("96") + note(4))));
  const test::Ran ran = test::run_program({"python3", "-c",
                                           "import sys, zipfile\n"
                                           "z = zipfile.ZipFile(sys.argv[2], 'w', zipfile.ZIP_DEFLATED)\n"
                                           "z.writestr('META-INF/container.xml', '<container><rootfiles><rootfile "
                                           "full-path=\"score/a.xml\"/></rootfiles></container>')\n"
                                           "z.write(sys.argv[1], 'score/a.xml')\nz.close()\n"
                                           "z = zipfile.ZipFile(sys.argv[3], 'w')\n"
                                           "z.writestr('META-INF/container.xml', '<container><rootfiles><rootfile "
                                           "full-path=\"b.xml\"/></rootfiles></container>')\nz.close()\n",
                                           folder / "song.xml", folder / "song.mxl", folder / "lost.mxl"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  ASSERT_TRUE(looks_like_score(folder.read("song.mxl")));
  const auto read = read_score(folder.read("song.mxl"), "song.mxl");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(score_of(*read, CountUnit::beat, "song.mxl")->tempo, TempoMap(96, 4));
  EXPECT_EQ(read_score(folder.read("lost.mxl"), "lost.mxl").error().message,
            "lost.mxl/META-INF/container.xml: error: the score \"b.xml\" is not in the zip");
  const std::string whole = folder.read("song.mxl");
  for (std::uint64_t seed = 0; seed < test::tries<std::uint64_t>(300, 20'000); ++seed) {
    const auto harmed = read_compressed_music_xml(test::mutated(whole, Rng(seed)), "song.mxl");
    if (!harmed) {
      EXPECT_THAT(harmed.error().message, HasSubstr("song.mxl"));
    }
  }
}

TEST(MusicXml, MutationsAreSurvived) {
  const std::string whole = score_with(
      measure(attributes(2, 6, 8) + sound("132") + rehearsal("A") + note(6) +
              "<barline location=\"left\"><ending number=\"1, 2\" type=\"start\"/><repeat "
              "direction=\"forward\"/></barline>") +
      measure(note(3) + "<backup><duration>3</duration></backup>" + note(6) +
              "<barline><ending number=\"1\" type=\"stop\"/><repeat direction=\"backward\" times=\"3\"/></barline>"));
  ASSERT_TRUE(read_music_xml(whole, "song.musicxml"));
  const std::uint64_t seeds = test::tries<std::uint64_t>(1'500, 100'000);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto events = read_music_xml(test::mutated(whole, Rng(seed), "<>/=\"' \n0129-+.e&;"), "song.musicxml");
    if (!events) {
      EXPECT_TRUE(events.error().message.starts_with("song.musicxml:")) << events.error();
      continue;
    }
    const auto made = score_of(*events, CountUnit::beat, "song.musicxml");
    if (!made) {
      EXPECT_TRUE(made.error().message.starts_with("song.musicxml: error: ")) << made.error();
    }
  }
}

}  // namespace
}  // namespace footlight::config
