// SPDX-License-Identifier: Apache-2.0
#include "config/motion_part.hpp"
#include "core/motion/collective_options.hpp"

namespace footlight::config {
namespace {

const Listing& pairing_listing() {
  static const Listing kListing{
      "sections[].planner.collective.pairing",
      "Who goes to which place.",
      {
          {.key = "cost",
           .type = Type::choice,
           .doc =
               "What is kept small over everybody: `least effort` the squares of the ways and of the changes of local "
               "density, `euclidean` the ways, `manhattan` the ways along the axes; around what is blocked.",
           .fallback = "least effort",
           .choices = {"least effort", "euclidean", "manhattan"}},
          {.key = "lambda",
           .type = Type::number,
           .doc = "`least effort`: 1 counts ways alone, 0 local density alone.",
           .fallback = "0.5",
           .range = {0, 1}},
      }};
  return kListing;
}

const Listing& forces_listing() {
  static const Listing kListing{"sections[].planner.collective.forces",
                                "What people do to each other while they walk; accelerations in m/s2.",
                                {
                                    {.key = "reaction",
                                     .type = Type::time,
                                     .doc = "Time in which somebody takes up the speed she wants.",
                                     .fallback = "0.5 s",
                                     .range = {0.1, 5}},
                                    {.key = "repulsion",
                                     .type = Type::number,
                                     .doc = "Of people and of what is blocked, where they touch, m/s2.",
                                     .fallback = "2",
                                     .range = {0, 20}},
                                    {.key = "range",
                                     .type = Type::length,
                                     .doc = "Within which it falls to a third (1/e).",
                                     .fallback = "0.3 m",
                                     .range = {0.05, 5}},
                                    {.key = "fluctuation",
                                     .type = Type::number,
                                     .doc = "Largest push by chance, m/s2.",
                                     .fallback = "0.02",
                                     .range = {0, 5}},
                                }};
  return kListing;
}

const Listing& subgroups_listing() {
  static const Listing kListing{
      "sections[].planner.collective.subgroups",
      "People who can keep together on their way, found by affinity propagation.",
      {
          {.key = "on", .type = Type::boolean, .doc = "Whether there are any.", .fallback = "true"},
          {.key = "cohesion",
           .type = Type::number,
           .doc = "Largest pull to where the others of the sub-group have her place, m/s2.",
           .fallback = "1",
           .range = {0, 20}},
          {.key = "separation",
           .type = Type::number,
           .doc = "Push of who is in another sub-group, where they touch, m/s2.",
           .fallback = "0.2",
           .range = {0, 20}},
          {.key = "range",
           .type = Type::length,
           .doc = "Within which the push falls, and the pull comes near to its largest.",
           .fallback = "0.5 m",
           .range = {0.05, 20}},
          {.key = "rigidity",
           .type = Type::number,
           .doc =
               "Share of strangers' pushes that a sub-group takes as one; above 0 groups that meet pass between each "
               "other's files and keep their shape.",
           .fallback = "0.8",
           .range = {0, 1}},
          {.key = "damping",
           .type = Type::number,
           .doc = "Of affinity propagation.",
           .fallback = "0.9",
           .range = {0.5, 0.99}},
          {.key = "rounds",
           .type = Type::integer,
           .doc = "Of affinity propagation, at most.",
           .fallback = "1000",
           .range = {10, 10'000}},
      }};
  return kListing;
}

const Listing& feedback_listing() {
  static const Listing kListing{
      "sections[].planner.collective.feedback",
      "Headings and speeds drawn toward those of the people around, as far as places tell how people walk.",
      {
          {.key = "on", .type = Type::boolean, .doc = "Whether there is any.", .fallback = "true"},
          {.key = "bin",
           .type = Type::length,
           .doc = "Side of a square of people who are around each other.",
           .fallback = "5 m",
           .range = {0.5, 1000}},
          {.key = "sectors",
           .type = Type::integer,
           .doc = "Classes of direction, and of speed.",
           .fallback = "8",
           .range = {2, 64}},
      }};
  return kListing;
}

}  // namespace

const Listing& collective_listing() {
  static const Listing kListing{
      "sections[].planner.collective",
      "`model: collective`: a pairing of least effort, sub-groups, social forces and feedback (Xu et al. 2015).",
      {
          {.key = "pairing",
           .type = Type::mapping,
           .doc = "Who goes to which place.",
           .otherwise = "as below",
           .listing = &pairing_listing()},
          {.key = "forces",
           .type = Type::mapping,
           .doc = "What people do to each other.",
           .otherwise = "as below",
           .listing = &forces_listing()},
          {.key = "subgroups",
           .type = Type::mapping,
           .doc = "People who keep together.",
           .otherwise = "as below",
           .listing = &subgroups_listing()},
          {.key = "feedback",
           .type = Type::mapping,
           .doc = "Mutual information.",
           .otherwise = "as below",
           .listing = &feedback_listing()},
      }};
  return kListing;
}

MotionOptions read_collective(ShowReading&, MappingReader reader) {
  CollectiveOptions out;
  if (auto pairing = reader.mapping("pairing")) {
    if (const auto cost = pairing->choice("cost")) out.pairing = static_cast<CollectiveOptions::Pairing>(*cost);
    out.lambda = pairing->number("lambda").value_or(out.lambda);
  }
  if (auto forces = reader.mapping("forces")) {
    out.reaction_s = forces->quantity("reaction").value_or(out.reaction_s);
    out.repulsion_mps2 = forces->number("repulsion").value_or(out.repulsion_mps2);
    out.repulsion_range_m = forces->quantity("range").value_or(out.repulsion_range_m);
    out.fluctuation_mps2 = forces->number("fluctuation").value_or(out.fluctuation_mps2);
  }
  if (auto subgroups = reader.mapping("subgroups")) {
    out.subgroups = subgroups->boolean("on").value_or(out.subgroups);
    out.cohesion_mps2 = subgroups->number("cohesion").value_or(out.cohesion_mps2);
    out.separation_mps2 = subgroups->number("separation").value_or(out.separation_mps2);
    out.group_range_m = subgroups->quantity("range").value_or(out.group_range_m);
    out.rigidity = subgroups->number("rigidity").value_or(out.rigidity);
    out.damping = subgroups->number("damping").value_or(out.damping);
    out.rounds = subgroups->integer("rounds").value_or(out.rounds);
  }
  if (auto feedback = reader.mapping("feedback")) {
    out.feedback = feedback->boolean("on").value_or(out.feedback);
    out.bin_m = feedback->quantity("bin").value_or(out.bin_m);
    out.sectors = feedback->integer("sectors").value_or(out.sectors);
  }
  return out;
}

}  // namespace footlight::config
