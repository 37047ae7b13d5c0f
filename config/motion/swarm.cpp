// SPDX-License-Identifier: Apache-2.0
#include "config/motion_part.hpp"
#include "core/motion/swarm_options.hpp"

namespace footlight::config {

const Listing& swarm_listing() {
  static const Listing kListing{
      "sections[].planner.swarm",
      "`model: swarm`: people as a particle swarm (Lin 2007; docs/algorithms/swarm.md). With a path the target of its "
      "group moves along it, and the group follows.",
      {
          {.key = "method",
           .type = Type::choice,
           .doc =
               "`proposed`: nobody touches anybody; `original`: the plain particle swarm, in which people walk through "
               "each other, for comparison.",
           .fallback = "proposed",
           .choices = {"proposed", "original"}},
          {.key = "best",
           .type = Type::choice,
           .doc = "What the swarm knows to be best (P_BGS): its `target`, or what anybody of the `swarm` has found so "
                  "far.",
           .fallback = "target",
           .choices = {"target", "swarm"}},
          {.key = "inertia",
           .type = Type::number,
           .doc = "How much of the last direction is kept (w).",
           .fallback = "1",
           .range = {0, 2}},
          {.key = "cognitive",
           .type = Type::number,
           .doc = "Pull of the best place that somebody has been at herself (c1).",
           .fallback = "0.5",
           .range = {0, 4}},
          {.key = "social",
           .type = Type::number,
           .doc = "Pull of the swarm's best (c2).",
           .fallback = "0.5",
           .range = {0, 4}},
          {.key = "avoid",
           .type = Type::number,
           .doc = "How much people and obstacles count against the target (c_obj).",
           .fallback = "0.05",
           .range = {0, 100}},
          {.key = "hardness",
           .type = Type::number,
           .doc =
               "k: nobody comes nearer to anybody than its square root times both scopes. Below 1 the boundary would "
               "lie inside of obstacles.",
           .fallback = "1",
           .range = {1, 4}},
          {.key = "person",
           .type = Type::length,
           .doc = "Scope of a person (sigma).",
           .otherwise = "half of the room that she needs",
           .range = {0, 10, true}},
          {.key = "pace_spread",
           .type = Type::number,
           .doc = "Everybody has a fastest pace of her own, between 1 minus this and 1 times the limit.",
           .fallback = "0.2",
           .range = {0, 0.9}},
          {.key = "directions",
           .type = Type::integer,
           .doc = "Tries with a random angle where a step is not accepted.",
           .fallback = "8",
           .range = {1, 64}},
          {.key = "grid_angle",
           .type = Type::angle,
           .doc = "Step of the grid of angles around the best of them.",
           .fallback = "15 deg",
           .range = {0.0174, 0.7855}},
          {.key = "grid_steps",
           .type = Type::integer,
           .doc = "Steps of that grid to each side.",
           .fallback = "3",
           .range = {0, 12}},
          {.key = "slow",
           .type = Type::length,
           .doc = "Nearer to the target people walk the slower the nearer they are.",
           .fallback = "1 m",
           .range = {0, 20, true}},
          {.key = "follow",
           .type = Type::number,
           .doc = "Share of the duration in which a target goes along its path; then it rests.",
           .fallback = "0.8",
           .range = {0, 1, true}},
          {.key = "step", .type = Type::time, .doc = "Time of one step.", .fallback = "0.2 s", .range = {0.02, 2}},
      }};
  return kListing;
}

MotionOptions read_swarm(ShowReading&, MappingReader reader) {
  SwarmOptions out;
  using Method = SwarmOptions::Method;
  using Best = SwarmOptions::Best;
  out.method = reader.choice("method").value_or(0) == 0 ? Method::proposed : Method::original;
  out.best = reader.choice("best").value_or(0) == 0 ? Best::target : Best::swarm;
  out.inertia = reader.number("inertia").value_or(out.inertia);
  out.cognitive = reader.number("cognitive").value_or(out.cognitive);
  out.social = reader.number("social").value_or(out.social);
  out.avoid = reader.number("avoid").value_or(out.avoid);
  out.hardness = reader.number("hardness").value_or(out.hardness);
  out.person_m = reader.quantity("person");
  out.pace_spread = reader.number("pace_spread").value_or(out.pace_spread);
  out.directions = reader.integer("directions").value_or(out.directions);
  out.grid_angle_rad = reader.quantity("grid_angle").value_or(out.grid_angle_rad);
  out.grid_steps = reader.integer("grid_steps").value_or(out.grid_steps);
  out.slow_m = reader.quantity("slow").value_or(out.slow_m);
  out.follow = reader.number("follow").value_or(out.follow);
  out.step_s = reader.quantity("step").value_or(out.step_s);
  return out;
}

}  // namespace footlight::config
