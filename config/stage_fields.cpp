// SPDX-License-Identifier: Apache-2.0
#include "config/show_fields.hpp"

namespace footlight::config {
namespace {

const Listing& grid_listing() {
  static const Listing kListing{
      "stage.grid",
      "The floor: equal cells, one lamp and at most one person each.",
      {
          {.key = "kind",
           .type = Type::choice,
           .doc = "Shape of the cells.",
           .fallback = "square",
           .choices = {"square", "hexagonal", "triangular"}},
          {.key = "columns",
           .type = Type::integer,
           .doc = "Cells from stage right to stage left; columns x rows is at most 4,000,000.",
           .required = true,
           .range = {1, 4096}},
          {.key = "rows",
           .type = Type::integer,
           .doc = "Cells from downstage to upstage.",
           .required = true,
           .range = {1, 4096}},
          {.key = "pitch",
           .type = Type::length,
           .doc = "Distance of neighbouring centres.",
           .fallback = "1 m",
           .range = {0, 100, true}},
      }};
  return kListing;
}

const Listing& obstacle_listing() {
  static const Listing kListing{
      "stage.obstacles[]",
      "Something that stands on the floor: every cell into which it reaches is blocked.",
      {
          {.key = "polygon",
           .type = Type::polygon,
           .doc = "Its corners in order, to stage left of the centre line and upstage of the edge.",
           .range = {-10'000, 10'000}},
          {.key = "map",
           .type = Type::file,
           .doc = "A grey map of the floor (PNG, JPEG, BMP, PBM, PGM) from edge to edge, upstage at its top: what is "
                  "dark is in the way."},
          {.key = "threshold",
           .type = Type::threshold,
           .doc = "Of a map: pixels as dark as this are in the way; `otsu` finds a value.",
           .fallback = "otsu"},
      },
      "polygon map"};
  return kListing;
}

const Listing& terrain_listing() {
  static const Listing kListing{
      "stage.terrain",
      "How the ground slows people down. Models of motion keep to it as their pages say; the limit of speed that a "
      "plan "
      "is judged by is `max_speed` everywhere.",
      {
          {.key = "map",
           .type = Type::file,
           .doc = "A grey picture (PNG, JPEG, BMP), stretched over the whole floor, its top upstage: black is level "
                  "ground, white is where people are slowest, even between.",
           .required = true},
          {.key = "slowest",
           .type = Type::number,
           .doc = "Share of everybody's speed that is left on white.",
           .fallback = "0.5",
           .range = {0.1, 1}},
      }};
  return kListing;
}

}  // namespace

const Listing& stage_listing() {
  static const Listing kListing{
      "stage",
      "The floor and the limits that hold on it.",
      {
          {.key = "grid", .type = Type::mapping, .doc = "The cells.", .required = true, .listing = &grid_listing()},
          {.key = "blocked",
           .type = Type::cells,
           .doc = "Set pieces, pits: nobody stands or walks here, no lamp.",
           .otherwise = "none",
           .list = true},
          {.key = "obstacles",
           .type = Type::mapping,
           .doc = "The same by their outlines, in metres, or from a map.",
           .otherwise = "none",
           .listing = &obstacle_listing(),
           .list = true},
          {.key = "reserve",
           .type = Type::cells,
           .doc = "The wings: who is not in the picture stands here, dark.",
           .otherwise = "none",
           .list = true},
          {.key = "clearance",
           .type = Type::length,
           .doc = "Nobody comes nearer to anybody than this, centre to centre, or than the sum of the two people's "
                  "radii where that is more.",
           .fallback = "0.5 m",
           .range = {0, 100}},
          {.key = "max_speed",
           .type = Type::speed,
           .doc = "Nobody walks faster; a section or a person may have a limit of its own.",
           .fallback = "1.4 m/s",
           .range = {0, 20, true}},
          {.key = "lag",
           .type = Type::time,
           .doc = "How late anybody may start or stop without coming too close; reported for each transition.",
           .fallback = "0.2 s",
           .range = {0, 10}},
          {.key = "terrain",
           .type = Type::mapping,
           .doc = "Hills: where people walk more slowly.",
           .otherwise = "level ground",
           .listing = &terrain_listing()},
      }};
  return kListing;
}

}  // namespace footlight::config
