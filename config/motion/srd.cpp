// SPDX-License-Identifier: Apache-2.0
#include "config/motion_part.hpp"
#include "core/motion/srd_options.hpp"

namespace footlight::config {

const Listing& srd_listing() {
  static const Listing kListing{
      "sections[].planner.srd",
      "`model: srd`: groups that keep their formation on their way, give it up where they meet others, and find it "
      "again (Son, Sung 2024).",
      {
          {.key = "orientation",
           .type = Type::choice,
           .doc = "How the formation lies along its path: `fixed` never turns; `path` faces along the path, who is "
                  "outrun in a turn catches up; `wheel` faces along the path and takes the time that the outer ones "
                  "need.",
           .fallback = "fixed",
           .choices = {"fixed", "path", "wheel"}},
          {.key = "formation",
           .type = Type::boolean,
           .doc = "`false`: nobody keeps a formation, each for herself (Weiss et al. 2017).",
           .fallback = "true"},
          {.key = "group_speed",
           .type = Type::speed,
           .doc = "How fast a group's centre moves.",
           .otherwise = "even, so that `settle` is left",
           .range = {0, 20, true}},
          {.key = "settle",
           .type = Type::number,
           .doc = "Share of the duration that is left when a group's centre arrives, less where the way takes longer.",
           .fallback = "0.15",
           .range = {0, 0.9}},
          {.key = "corner",
           .type = Type::length,
           .doc = "A formation turns within so much of its way before and after a corner of the path.",
           .fallback = "3 m",
           .range = {0, 100}},
          {.key = "step", .type = Type::time, .doc = "Time of one step.", .fallback = "0.1 s", .range = {0.01, 0.5}},
          {.key = "iterations",
           .type = Type::integer,
           .doc = "Times that all constraints are solved in a step.",
           .fallback = "4",
           .range = {1, 50}},
          {.key = "stiffness",
           .type = Type::number,
           .doc = "Share of the distance to her place in the formation that each iteration makes good.",
           .fallback = "0.5",
           .range = {0, 1}},
          {.key = "blending",
           .type = Type::number,
           .doc = "Share of the planned velocity in each step's; the rest goes on as before.",
           .fallback = "0.5",
           .range = {0, 1, true}},
          {.key = "steering",
           .type = Type::number,
           .doc = "Share of the steering toward her place that is added to somebody's velocity in each step.",
           .fallback = "0.3",
           .range = {0, 1}},
          {.key = "room",
           .type = Type::length,
           .doc =
               "So far apart people are kept, from centre to centre, where formations are loose enough for others to "
               "pass through at that distance; never less than their radii or the clearance ask.",
           .fallback = "1 m",
           .range = {0, 10}},
          {.key = "congestion",
           .type = Type::length,
           .doc = "Side of the squares of floor in which a formation is given up while people of several groups, or a "
                  "moving obstacle, are there.",
           .fallback = "2 m",
           .range = {0.1, 100}},
          {.key = "look",
           .type = Type::length,
           .doc = "So far around people look for whom they will meet.",
           .fallback = "5 m",
           .range = {0, 100}},
          {.key = "horizon", .type = Type::time, .doc = "And so far ahead.", .fallback = "5 s", .range = {0, 60, true}},
          {.key = "avoidance",
           .type = Type::number,
           .doc = "Share of a meeting to come that each iteration steps aside for.",
           .fallback = "0.24",
           .range = {0, 1}},
          {.key = "agility",
           .type = Type::number,
           .doc = "What people step aside is multiplied by.",
           .fallback = "1",
           .range = {0, 4}},
          {.key = "reaction",
           .type = Type::time,
           .doc = "Before somebody leaves the formation, and before she returns to it; less is quicker.",
           .fallback = "0.3 s",
           .range = {0, 10}},
          {.key = "variation",
           .type = Type::number,
           .doc = "People's agility and reaction differ by up to so much either way.",
           .fallback = "0.2",
           .range = {0, 1}},
      }};
  return kListing;
}

MotionOptions read_srd(ShowReading&, MappingReader from) {
  SrdOptions out;
  out.orientation = static_cast<SrdOptions::Orientation>(from.choice("orientation").value_or(0));
  out.formation = from.boolean("formation").value_or(out.formation);
  out.group_speed_mps = from.quantity("group_speed");
  out.settle = from.number("settle").value_or(out.settle);
  out.corner_m = from.quantity("corner").value_or(out.corner_m);
  out.step_s = from.quantity("step").value_or(out.step_s);
  out.iterations = from.integer("iterations").value_or(out.iterations);
  out.stiffness = from.number("stiffness").value_or(out.stiffness);
  out.blending = from.number("blending").value_or(out.blending);
  out.steering = from.number("steering").value_or(out.steering);
  out.room_m = from.quantity("room").value_or(out.room_m);
  out.congestion_m = from.quantity("congestion").value_or(out.congestion_m);
  out.look_m = from.quantity("look").value_or(out.look_m);
  out.horizon_s = from.quantity("horizon").value_or(out.horizon_s);
  out.avoidance = from.number("avoidance").value_or(out.avoidance);
  out.agility = from.number("agility").value_or(out.agility);
  out.reaction_s = from.quantity("reaction").value_or(out.reaction_s);
  out.variation = from.number("variation").value_or(out.variation);
  return out;
}

}  // namespace footlight::config
