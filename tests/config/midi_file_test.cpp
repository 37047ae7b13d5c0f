// SPDX-License-Identifier: Apache-2.0
#include "config/midi_file.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core/rng.hpp"
#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"
#include "tests/support/program.hpp"

namespace footlight::config {
namespace {

std::string big_endian(std::uint32_t value, int bytes) {
  std::string out;
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(value >> static_cast<unsigned>(8 * k) & 0xFFU);
  return out;
}
std::string variable(std::uint32_t value) {
  std::string out(1, static_cast<char>(value & 0x7FU));
  while ((value >>= 7U) != 0) out.insert(out.begin(), static_cast<char>(0x80U | (value & 0x7FU)));
  return out;
}
std::string meta(std::uint32_t delta, int type, const std::string& data) {
  return variable(delta) + '\xFF' + static_cast<char>(type) + variable(static_cast<std::uint32_t>(data.size())) + data;
}
std::string tempo(std::uint32_t delta, std::uint32_t quarter_us) {
  return meta(delta, 0x51, big_endian(quarter_us, 3));
}
std::string meter(std::uint32_t delta, int beats, int power) {
  return meta(delta, 0x58, std::string{static_cast<char>(beats), static_cast<char>(power), 24, 8});
}
std::string chunk(const std::string& name, const std::string& content) {
  return name + big_endian(static_cast<std::uint32_t>(content.size()), 4) + content;
}
std::string end(std::uint32_t delta) { return meta(delta, 0x2F, ""); }
std::string midi(int format, std::uint32_t division, const std::vector<std::string>& tracks) {
  std::string out =
      chunk("MThd", big_endian(static_cast<std::uint32_t>(format), 2) +
                        big_endian(static_cast<std::uint32_t>(tracks.size()), 2) + big_endian(division, 2));
  for (const std::string& track : tracks) out += chunk("MTrk", track);
  return out;
}
Score score(const std::string& bytes, CountUnit unit = CountUnit::beat) {
  const auto events = read_midi(bytes, "song.mid");
  EXPECT_TRUE(events) << events.error();
  auto out = score_of(*events, unit, "song.mid");
  EXPECT_TRUE(out) << out.error();
  return *out;
}

TEST(Midi, TempoAndMeterOfASongOfOneTrack) {
  const Score read =
      score(midi(0, 480,
                 {tempo(0, 500'000) + meter(0, 3, 2) + std::string("\0\x90\x40\x40", 4) + variable(480) + "\x40" +
                  std::string(1, '\0') + tempo(960, 1'000'000) + meta(0, 0x06, "B") + end(1440)}));
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 120}, {4, 60}}, 3));
  EXPECT_EQ(read.counts, 6);
  ASSERT_EQ(read.rehearsals.size(), 1U);
  EXPECT_EQ(read.rehearsals[0].text, "B");
  EXPECT_EQ(read.rehearsals[0].count, 4);
  EXPECT_TRUE(read.ignored.empty());
}

TEST(Midi, TracksOfFormatOneBelongTogether) {
  const Score read =
      score(midi(1, 96, {meter(0, 4, 2) + end(0), tempo(0, 600'000) + end(96 * 8), tempo(96 * 4, 300'000) + end(0)}));
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 100}, {5, 200}}, 4));
  EXPECT_EQ(read.counts, 8);
}

TEST(Midi, ACountIsTheBeatTheNoteOrTheQuarter) {
  // 6/8 at 60 dotted quarters, then 2/4 at the same quarters.
  const std::string song = midi(0, 480, {tempo(0, 666'667) + meter(0, 6, 3) + meter(480 * 6, 2, 2) + end(480 * 4)});
  const Score beat = score(song);
  EXPECT_EQ(beat.tempo.beats_per_measure(), 2);
  EXPECT_NEAR(beat.tempo.bpm_at(1), 60, 1e-4);
  EXPECT_EQ(beat.tempo.changes()[1].count, 5) << "a count is longer before";
  EXPECT_NEAR(beat.tempo.bpm_at(5), 90, 1e-4);
  EXPECT_EQ(beat.counts, 8);
  const Score note = score(song, CountUnit::note);
  EXPECT_EQ(note.tempo.measure_beat(13), "3:1");
  EXPECT_EQ(note.counts, 16);
  const Score quarter = score(song, CountUnit::quarter);
  EXPECT_EQ(quarter.counts, 10);
  EXPECT_EQ(quarter.tempo.beats_per_measure(), 3);
  for (const Score* read : {&beat, &note, &quarter}) {
    EXPECT_NEAR(to_seconds(read->tempo.at(1 + read->counts)), 10 * 0.666667, 1e-8);
  }
}

TEST(Midi, FramesOfTimecodeAreTimeWhateverTheTempo) {
  // 25 frames of 40 ticks: milliseconds. Two seconds at 120, then 60.
  const std::string song = midi(0, 0xE728, {tempo(0, 500'000) + tempo(2000, 1'000'000) + end(3000)});
  const Score read = score(song);
  EXPECT_EQ(read.tempo, *TempoMap::from({{1, 120}, {5, 60}}, 4));
  EXPECT_EQ(read.counts, 7);
  EXPECT_EQ(read.tempo.at(8), instant_at(5));
  // 29 is 30 frames drop: 30,000 / 1,001 a second.
  const Score drop = score(midi(0, 0xE301, {tempo(0, 1'000'000) + end(30'000)}));
  EXPECT_NEAR(drop.counts, 1001, 1e-6);
}

TEST(Midi, WhatIsNotKeptIsTold) {
  const Score read = score(midi(0, 480, {meter(0, 4, 2) + meter(480 * 2, 3, 2) + end(0)}));
  EXPECT_EQ(read.ignored, (std::vector<std::string>{
                              "no tempo stands at the beginning: 120 quarter notes a minute are taken",
                              "the meter 3/4 at count 3: no measure begins here; the next one does at count 5"}));
  const Score seven = score(midi(0, 480, {tempo(0, 500'000) + meter(0, 7, 3) + end(0)}), CountUnit::quarter);
  EXPECT_EQ(seven.ignored,
            (std::vector<std::string>{"the meter 7/8 has no whole number of counts: measures of 4 counts are taken"}));
}

TEST(Midi, WrongFilesAreRefusedWithTheirPlace) {
  const auto error_of = [](const std::string& bytes) { return read_midi(bytes, "song.mid").error().message; };
  EXPECT_EQ(error_of("RIFF"), "song.mid: error: byte 0: no MIDI file begins like this (MThd)");
  EXPECT_EQ(error_of("MThd\0\0"), "song.mid: error: byte 4: the header is shorter than six bytes");
  EXPECT_EQ(error_of(midi(2, 480, {end(0)})),
            "song.mid: error: byte 8: format 2: its tracks do not belong to one time (save it as format 0 or 1)");
  EXPECT_EQ(error_of(midi(0, 0, {end(0)})), "song.mid: error: byte 12: 0x0000 is no division of time");
  EXPECT_EQ(error_of(midi(0, 480, {tempo(0, 0)})),
            "song.mid: error: byte 22: a tempo of 0 microseconds a quarter note");
  EXPECT_EQ(error_of(midi(0, 480, {meter(0, 0, 2)})),
            "song.mid: error: byte 22: a time signature of 0 over 2^2 (1 to 64 over 1 to 64)");
  EXPECT_EQ(error_of(midi(0, 480, {variable(0) + "\x40"})), "song.mid: error: byte 22: no event begins here");
  EXPECT_EQ(error_of(midi(0, 480, {variable(0) + "\x90\x40"})),
            "song.mid: error: byte 22: the track ends in the middle of this event");
  const std::string whole = midi(1, 480, {tempo(0, 500'000) + end(0), end(0)});
  EXPECT_EQ(error_of(whole.substr(0, whole.size() - 12)),
            "song.mid: error: byte 33: the file ends after 1 of 2 tracks");
  EXPECT_EQ(error_of(whole.substr(0, whole.size() - 1)),
            "song.mid: error: byte 33: the file ends in the middle of this chunk");
}

TEST(Midi, TemposThatNoShowCanHaveAreRefused) {
  const auto events = read_midi(midi(0, 480, {tempo(0, 10'000) + end(0)}), "song.mid");
  EXPECT_EQ(score_of(*events, CountUnit::beat, "song.mid").error().message,
            "song.mid: error: 6000 counts a minute at count 1 (1 to 1000)");
  std::string many;
  for (int k = 0; k < 10'001; ++k) many += tempo(1, 500'000 + static_cast<std::uint32_t>(k));
  EXPECT_EQ(score_of(*read_midi(midi(0, 480, {many}), "song.mid"), CountUnit::beat, "song.mid").error().message,
            "song.mid: error: 10001 changes of tempo and meter (at most 10000)");
  const auto endless = read_midi(midi(0, 1, {tempo(0, 500'000) + end(0x0FFFFFFF)}), "song.mid");
  EXPECT_EQ(score_of(*endless, CountUnit::beat, "song.mid").error().message,
            "song.mid: error: the music has more than 1000000 counts");
}

/// Another hand writes the file and says when each of its ticks is.
TEST(Midi, TimesAreThoseOfAnotherProgram) {
  const test::TemporaryFolder folder;
  const std::string script = R"(
import sys, random
try:
    import mido
except ImportError:
    sys.exit(77)
random.seed(int(sys.argv[2]))
song = mido.MidiFile(type=random.choice([0, 1]), ticks_per_beat=random.choice([24, 96, 480, 960]))
track = mido.MidiTrack(); song.tracks.append(track)
tick, tempo, seconds = 0, 500000, 0.0
track.append(mido.MetaMessage('time_signature', numerator=4, denominator=4))
marks = []
for k in range(200):
    delta = random.randrange(0, 4 * song.ticks_per_beat)
    tick += delta
    seconds += mido.tick2second(delta, song.ticks_per_beat, tempo)
    kind = random.randrange(4)
    if kind == 0:
        tempo = random.randrange(200000, 1200000)
        track.append(mido.MetaMessage('set_tempo', tempo=tempo, time=delta))
    elif kind == 1:
        track.append(mido.MetaMessage('marker', text='m%d' % k, time=delta))
        marks.append((tick, seconds))
    else:
        track.append(mido.Message('note_on', note=60 + kind, velocity=64, time=delta))
song.save(sys.argv[1])
print(song.ticks_per_beat, song.length)
for mark in marks: print(mark[0], repr(mark[1]))
)";
  for (int seed = 0; seed < 3; ++seed) {
    const test::Ran ran =
        test::run_program({"/usr/bin/python3", "-c", script, folder / "song.mid", std::to_string(seed)});
    if (ran.status == 77) GTEST_SKIP() << "python3-mido is not here";
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::istringstream said(ran.out);
    double ticks_a_quarter = 0;
    double length_s = 0;
    said >> ticks_a_quarter >> length_s;
    const Score read = score(folder.read("song.mid"));
    EXPECT_NEAR(to_seconds(read.tempo.at(1 + read.counts)), length_s, 1e-6);
    std::size_t n = 0;
    double tick = 0;
    double seconds = 0;
    while (said >> tick >> seconds) {
      ASSERT_LT(n, read.rehearsals.size());
      EXPECT_NEAR(read.rehearsals[n].count, 1 + tick / ticks_a_quarter, 1e-8);
      EXPECT_NEAR(to_seconds(read.tempo.at(read.rehearsals[n].count)), seconds, 1e-6);
      ++n;
    }
    EXPECT_GT(n, 20U);
    EXPECT_EQ(n, read.rehearsals.size());
  }
}

TEST(Midi, MutationsAreSurvived) {
  const std::string whole = midi(
      1, 480,
      {tempo(0, 500'000) + meter(0, 6, 3) + meta(480, 0x06, "\xE9t\xE9") + meta(0, 0x54, "\x60\1\2\3\4") + end(960),
       std::string("\0\x90\x40\x40\x10\x40\0\0\xC0\1\0\xF0\3\1\2\xF7", 16) + tempo(96, 600'000) + end(10)});
  ASSERT_TRUE(read_midi(whole, "song.mid"));
  const std::uint64_t seeds = test::tries<std::uint64_t>(3'000, 300'000);
  std::size_t read_whole = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto events = read_midi(test::mutated(whole, Rng(seed)), "song.mid");
    if (!events) {
      EXPECT_TRUE(events.error().message.starts_with("song.mid: error: byte ")) << events.error();
      continue;
    }
    ++read_whole;
    const auto made = score_of(*events, CountUnit::beat, "song.mid");
    if (!made) {
      EXPECT_TRUE(made.error().message.starts_with("song.mid: error: ")) << made.error();
    }
  }
  EXPECT_GT(read_whole, 0U) << "some harm does no harm";
}

}  // namespace
}  // namespace footlight::config
