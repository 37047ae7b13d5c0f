// SPDX-License-Identifier: Apache-2.0
#include "config/show_fields.hpp"

namespace footlight::config {
namespace {

const Listing& group_listing() {
  static const Listing kListing{
      "performers.groups[]",
      "People who belong together.",
      {
          {.key = "name", .type = Type::text, .doc = "Unique.", .required = true},
          {.key = "members",
           .type = Type::members,
           .doc = "Ids, or ranges of numbers as 1-300; nobody is in two groups. With a roster its column `group` may "
                  "say it instead.",
           .otherwise = "as the roster says",
           .list = true},
          {.key = "colour", .type = Type::colour, .doc = "Of their lamps.", .required = true},
          {.key = "max_speed",
           .type = Type::speed,
           .doc = "Nobody in the group walks faster; a person's own limit in the roster goes before it.",
           .otherwise = "the section's or the stage's",
           .range = {0, 20, true}},
          {.key = "agility",
           .type = Type::number,
           .doc = "What `model: srd` multiplies stepping aside by for the people of the group; a person's own in the "
                  "roster goes before it.",
           .otherwise = "`srd.agility`, spread by `srd.variation`",
           .range = {0, 4}},
          {.key = "reaction",
           .type = Type::time,
           .doc = "Before one of the group leaves the formation for others, and before she returns to it, in `model: "
                  "srd`; less is quicker; a person's own in the roster goes before it.",
           .otherwise = "`srd.reaction`, spread by `srd.variation`",
           .range = {0, 10}},
          {.key = "exchange",
           .type = Type::boolean,
           .doc = "`false`: from the first formation to the last nobody else takes a place of the group; `true`: only "
                  "between formations that give places to groups.",
           .fallback = "true"},
      }};
  return kListing;
}

const Listing& understudy_listing() {
  static const Listing kListing{
      "performers.understudies[]",
      "Somebody who stands by, with no place of her own until she covers somebody.",
      {
          {.key = "id", .type = Type::text, .doc = "Unique, and no performer's.", .required = true},
          {.key = "name", .type = Type::text, .doc = "As people call her.", .otherwise = "the id"},
          {.key = "covers",
           .type = Type::members,
           .doc = "Whose way she has learned, as `members`: `cover 4` asks for her. She can be told to cover anybody.",
           .otherwise = "nobody",
           .list = true},
          {.key = "radius",
           .type = Type::length,
           .doc = "Of her body, as in a roster.",
           .otherwise = "the stage's clearance holds",
           .range = {0, 10, true}},
          {.key = "max_speed",
           .type = Type::speed,
           .doc = "She walks no faster; a way that is faster is refused.",
           .otherwise = "the section's or the stage's",
           .range = {0, 20, true}},
      }};
  return kListing;
}

const Listing& performers_listing() {
  static const Listing kListing{
      "performers",
      "Who is on stage: a number of people, or a roster.",
      {
          {.key = "count",
           .type = Type::integer,
           .doc = "That many people with the ids 1, 2, 3 ...",
           .range = {1, 100'000}},
          {.key = "from", .type = Type::file, .doc = "Roster: a CSV file, one row a person."},
          {.key = "groups",
           .type = Type::mapping,
           .doc = "Groups and their colours.",
           .otherwise = "none",
           .listing = &group_listing(),
           .list = true},
          {.key = "understudies",
           .type = Type::mapping,
           .doc = "Who stands by for absent people.",
           .otherwise = "nobody",
           .listing = &understudy_listing(),
           .list = true},
          {.key = "colour", .type = Type::colour, .doc = "Of who is in no group.", .fallback = "#FFFFFF"},
      },
      "count from"};
  return kListing;
}

const Listing& tempo_listing() {
  static const Listing kListing{"music.changes[]",
                                "A tempo or a meter from a count on.",
                                {
                                    {.key = "at",
                                     .type = Type::at_count,
                                     .doc = "Counts increase down the list; the first is count 1.",
                                     .required = true,
                                     .range = {1, kMostCounts}},
                                    {.key = "tempo",
                                     .type = Type::number,
                                     .doc = "Counts a minute; required at count 1.",
                                     .otherwise = "as before",
                                     .range = {1, 1000}},
                                    {.key = "meter",
                                     .type = Type::meter,
                                     .doc = "Counts a measure from here on, where a measure begins; not at count 1.",
                                     .otherwise = "as before"},
                                }};
  return kListing;
}

const Listing& music_listing() {
  static const Listing kListing{"music",
                                "How counts become time.",
                                {
                                    {.key = "tempo",
                                     .type = Type::number,
                                     .doc = "Counts a minute, for the whole show.",
                                     .otherwise = "120, unless `changes` is given",
                                     .range = {1, 1000}},
                                    {.key = "changes",
                                     .type = Type::mapping,
                                     .doc = "A tempo map instead of one tempo.",
                                     .otherwise = "none",
                                     .listing = &tempo_listing(),
                                     .list = true},
                                    {.key = "meter",
                                     .type = Type::meter,
                                     .doc = "Counts a measure (the upper number), for measure and beat in print.",
                                     .fallback = "4/4"},
                                    {.key = "pickup",
                                     .type = Type::counts,
                                     .doc = "Counts before measure 1 begins, fewer than a measure has.",
                                     .fallback = "0 counts",
                                     .range = {0, 64}},
                                }};
  return kListing;
}

const Listing& time_listing() {
  static const Listing kListing{
      "time",
      "Where the show's time comes from, and what happens when that fails.",
      {
          {.key = "source",
           .type = Type::text,
           .doc = "As `footlight run --time`, which goes before it: `audio:FILE`, `ltc:FILE`, `ltc:alsa:DEVICE`, "
                  "`mtc:PORT`, `midi-clock:PORT`, `osc:PORT`.",
           .otherwise = "the machine's own clock"},
          {.key = "start", .type = Type::text, .doc = "Timecode of the source at count 1.", .fallback = "00:00:00:00"},
          {.key = "frame_rate",
           .type = Type::choice,
           .doc = "Frames a second, in which `start` is written; LTC is taken for it until it has told its own.",
           .fallback = "25",
           .choices = {"24", "25", "29.97df", "30"}},
          {.key = "lost",
           .type = Type::choice,
           .doc =
               "What the show does when nothing more comes from the source: `continue` by its own clock; go on to the "
               "`next-hold-point`, where everybody stands; `hold` at once.",
           .fallback = "next-hold-point",
           .choices = {"continue", "next-hold-point", "hold"}},
          {.key = "freewheel",
           .type = Type::time,
           .doc = "The show goes on through a silence of the source for so long; then `lost` holds.",
           .fallback = "2 s",
           .range = {0.2, 60}},
      }};
  return kListing;
}

const Listing& cue_listing() {
  static const Listing kListing{
      "cues[]",
      "What GO starts.",
      {
          {.key = "number",
           .type = Type::cue_number,
           .doc = "Unique; \"12.10\" equals \"12.1\"; at most six decimals.",
           .required = true},
          {.key = "section", .type = Type::text, .doc = "Name of the section that starts.", .required = true},
          {.key = "name", .type = Type::text, .doc = "For the console.", .otherwise = "the section's name"},
          {.key = "continue",
           .type = Type::choice,
           .doc =
               "What brings the next cue: GO; `auto-continue`: `post_wait` after this cue's start, but not before its "
               "section ends; `auto-follow`: `post_wait` after its end. The next cue's `pre_wait` comes on top.",
           .fallback = "manual",
           .choices = {"manual", "auto-continue", "auto-follow"}},
          {.key = "pre_wait",
           .type = Type::time,
           .doc = "From GO until the cue starts.",
           .fallback = "0 s",
           .range = {0, 86'400}},
          {.key = "post_wait",
           .type = Type::time,
           .doc = "Before an automatic next cue, counted as `continue` says.",
           .fallback = "0 s",
           .range = {0, 86'400}},
          {.key = "notes", .type = Type::text, .doc = "For whoever calls the show.", .otherwise = "none"},
          {.key = "gates",
           .type = Type::text,
           .doc =
               "Of the show's `gates`, those without which this cue does not run: GO is refused, and a cue that runs "
               "holds when one is lost.",
           .otherwise = "none",
           .list = true},
      }};
  return kListing;
}

/// The four roles differ in their default effect only.
Listing look_listing(std::string_view name, std::string_view doc, std::string_view effect) {
  return {name,
          doc,
          {
              {.key = "colour",
               .type = Type::look_colour,
               .doc = "`group`: the colour of the person's group.",
               .fallback = "group"},
              {.key = "effect",
               .type = Type::choice,
               .doc = "Nothing flashes above 3 Hz.",
               .fallback = effect,
               .choices = {"steady", "blink", "pulse", "double-blink", "count-down"}},
              {.key = "brightness", .type = Type::integer, .doc = "0 is dark.", .fallback = "255", .range = {0, 255}},
          }};
}

const Listing& looks_listing() {
  static const Listing kHere = look_listing("looks.here", "Somebody stands here now and stays.", "steady");
  static const Listing kArrive = look_listing("looks.arrive", "Somebody is walking to this cell now.", "steady");
  static const Listing kNext =
      look_listing("looks.next", "Somebody will walk to this cell at the next move.", "count-down");
  static const Listing kHandover = look_listing(
      "looks.handover", "Somebody stands here and leaves at the next move, and somebody else comes.", "double-blink");
  static const Listing kListing{
      "looks",
      "What a cell's lamp tells.",
      {
          {.key = "here", .type = Type::mapping, .doc = kHere.doc, .otherwise = "as below", .listing = &kHere},
          {.key = "arrive", .type = Type::mapping, .doc = kArrive.doc, .otherwise = "as below", .listing = &kArrive},
          {.key = "next", .type = Type::mapping, .doc = kNext.doc, .otherwise = "as below", .listing = &kNext},
          {.key = "handover",
           .type = Type::mapping,
           .doc = kHandover.doc,
           .otherwise = "as below",
           .listing = &kHandover},
      }};
  return kListing;
}

}  // namespace

const Listing& show_listing() {
  static const Listing kListing{
      "show.yaml",
      "The whole show.",
      {
          {.key = "footlight",
           .type = Type::integer,
           .doc = "Version of this format.",
           .required = true,
           .range = {1, 1}},
          {.key = "title", .type = Type::text, .doc = "For people.", .required = true},
          {.key = "version",
           .type = Type::text,
           .doc = "Of the show, as its people call it: \"2\", \"dress rehearsal\". Stands on every page and picture.",
           .otherwise = "none"},
          {.key = "stage", .type = Type::mapping, .doc = "The floor.", .required = true, .listing = &stage_listing()},
          {.key = "walk",
           .type = Type::choice,
           .doc =
               "How people go from one formation to the next. `straight`: each in a line at constant speed. `cells`: "
               "over neighbouring cells, one cell a count, on whole counts; every second, third count where one is too "
               "short.",
           .fallback = "straight",
           .choices = {"straight", "cells"}},
          {.key = "performers",
           .type = Type::mapping,
           .doc = "Who is on it.",
           .required = true,
           .listing = &performers_listing()},
          {.key = "music",
           .type = Type::mapping,
           .doc = "Tempo and meter.",
           .otherwise = "120 counts a minute in 4/4",
           .listing = &music_listing()},
          {.key = "time",
           .type = Type::mapping,
           .doc = "A source of time: timecode, music.",
           .otherwise = "the machine's own clock",
           .listing = &time_listing()},
          {.key = "sections",
           .type = Type::mapping,
           .doc = "The pictures, in time; at least one.",
           .required = true,
           .listing = &section_listing(),
           .list = true},
          {.key = "cues",
           .type = Type::mapping,
           .doc = "What GO starts.",
           .otherwise = "one for each section, numbered from 1, each following the one before",
           .listing = &cue_listing(),
           .list = true},
          {.key = "gates",
           .type = Type::text,
           .doc = "Names of what has to be safe before people walk there, at most 32: \"trap closed\", \"lift level\". "
                  "What tells it stands in the file of `footlight run --remote`.",
           .otherwise = "none",
           .list = true},
          {.key = "looks",
           .type = Type::mapping,
           .doc = "What lamps look like.",
           .otherwise = "as below",
           .listing = &looks_listing()},
          {.key = "announce",
           .type = Type::counts,
           .doc = "How long before a move the next places light up.",
           .fallback = "4 counts",
           .range = {0, 1000}},
          {.key = "absent",
           .type = Type::members,
           .doc =
               "Who does not come, as `members`: whoever is on stage least, in the reserve if possible, walks the way "
               "instead of her own, or the place stays empty; nobody else's marks change.",
           .otherwise = "everybody comes",
           .list = true},
          {.key = "rig",
           .type = Type::file,
           .doc = "Buses, nodes and lamps.",
           .otherwise = "simulated buses of three kinds that carry a lamp for every cell"},
      }};
  return kListing;
}

}  // namespace footlight::config
