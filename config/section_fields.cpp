// SPDX-License-Identifier: Apache-2.0
// Keys of a section: its pictures, how they are sampled, how it is planned.
#include "config/motion_part.hpp"
#include "config/show_fields.hpp"

namespace footlight::config {
namespace {

const Listing& source_listing() {
  static const Listing kListing = [] {
    Listing out{
        "sections[].from",
        "Where the formations come from. `fit`, `threshold` and `invert` go with a video or an image. The keys of a "
        "single drawing may stand here, too: `{shape: circle, radius: 6 m}`; an image that has a place or a size "
        "is laid there with people evenly in it, another one fills the floor as `fit` asks.",
        {},
        "video image cells parts shape text mesh painting"};
    const auto add = [&](std::vector<Field> fields) {
      for (Field& field : fields) out.fields.push_back(std::move(field));
    };
    add({
        {.key = "video", .type = Type::file, .doc = "A monochrome video, planned key frame by key frame."},
        {.key = "image", .type = Type::file, .doc = "One picture (PNG, JPEG, BMP, PBM, PGM, SVG), one formation."},
        {.key = "cells",
         .type = Type::file,
         .doc = "A CSV file of cells, one formation: `performer,col,row`, by groups `group,col,row`, or `col,row`."},
        {.key = "parts",
         .type = Type::mapping,
         .doc = "Drawings that are one formation together.",
         .listing = &part_listing(),
         .list = true},
        {.key = "painting",
         .type = Type::file,
         .doc = "A painting in colours (PNG, JPEG, BMP, SVG) that says where people are, where they go and what is in "
                "the way."},
    });
    add(drawing_fields());
    add({
        {.key = "frames",
         .type = Type::frames,
         .doc = "First and last frame of the video, from 0, the last included; `100-` goes to the end.",
         .otherwise = "the whole video"},
        {.key = "fit",
         .type = Type::choice,
         .doc = "`area`: the largest key frame fills as many cells as there are people; `contain`: the whole frame "
                "lies on the stage without the reserve's columns; `cover`: the frame covers the stage.",
         .fallback = "area",
         .choices = {"area", "contain", "cover"}},
    });
    add(picture_fields());
    add(size_fields());
    return out;
  }();
  return kListing;
}

const Listing& sampling_listing() {
  static const Listing kListing{"sections[].sampling",
                                "Which frames of a video become formations.",
                                {
                                    {.key = "interval",
                                     .type = Type::time,
                                     .doc = "Longest time between two formations, in time of the show.",
                                     .fallback = "3.2 s",
                                     .range = {0, 3600, true}},
                                    {.key = "hash",
                                     .type = Type::number,
                                     .doc = "Share of differing bits of the average hash that makes a new formation.",
                                     .fallback = "0.10",
                                     .range = {0, 1, true}},
                                    {.key = "snap",
                                     .type = Type::choice,
                                     .doc = "Formations fall on whole counts, or where the frame falls.",
                                     .fallback = "count",
                                     .choices = {"count", "none"}},
                                }};
  return kListing;
}

const Listing& region_listing() {
  static const Listing kListing{
      "sections[].planner.region",
      "Bounds of a region of people who move together.",
      {
          {.key = "size",
           .type = Type::integer,
           .doc = "Most people in a region of the first division; a layer more divides it into quarters.",
           .fallback = "60",
           .range = {1, 100'000}},
          {.key = "variance",
           .type = Type::area,
           .doc = "Largest mean squared distance from a region's anchor; a bare number "
                  "means m2.",
           .fallback = "30 m2",
           .range = {0, kMostCounts, true},
           .bare = true},
      }};
  return kListing;
}

Listing planner_keys() {
  return {
      "sections[].planner",
      "How people are matched with the cells of the next formation.",
      {
          {.key = "model",
           .type = Type::choice,
           .doc =
               "`joint` plans the drawing of a video and everybody's walks together, `hierarchical` keeps regions of "
               "people together, `flat` matches everybody at once; what is no video is matched as by `hierarchical` "
               "where it says `joint`.",
           .fallback = "joint",
           .choices = {"joint", "hierarchical", "flat"}},
          {.key = "layers", .type = Type::integer, .doc = "Layers of the hierarchy.", .fallback = "2", .range = {1, 6}},
          {.key = "region",
           .type = Type::mapping,
           .doc = "Bounds of a region.",
           .otherwise = "as below",
           .listing = &region_listing()},
          {.key = "cost",
           .type = Type::choice,
           .doc = "What is kept small: the sum of squared distances, or of distances.",
           .fallback = "squared",
           .choices = {"squared", "euclidean"}},
          {.key = "effort",
           .type = Type::number,
           .doc = "`joint`: how much walking counts against the drawing; 2 spares people twice as much.",
           .fallback = "1",
           .range = {0.01, 100}},
      }};
}

/// With a mapping for each model of motion.
const Listing& planner_listing() {
  static const Listing kListing = [] {
    Listing out = planner_keys();
    for (const MotionModel& one : motion_models()) {
      out.fields.front().choices.push_back(one.name);
      out.fields.push_back(
          {.key = one.name, .type = Type::mapping, .doc = one.doc, .otherwise = "as below", .listing = &one.listing()});
    }
    return out;
  }();
  return kListing;
}

const Listing& override_listing() {
  static const Listing kListing{
      "sections[].overrides[]",
      "What the director changes by hand in one formation, all at once. It becomes a key formation, and gives way "
      "where "
      "walking takes too long unless `keys` names it.",
      {
          {.key = "at", .type = Type::at_count, .doc = "The formation at this count.", .range = {1, kMostCounts}},
          {.key = "formation",
           .type = Type::integer,
           .doc = "The section's formation with this number, from 1, as in `growth/12`.",
           .range = {1, 100'000}},
          {.key = "move",
           .type = Type::move,
           .doc = "Who stands on the first cell stands on the second instead.",
           .otherwise = "none",
           .list = true},
          {.key = "add",
           .type = Type::cells,
           .doc = "Cells that somebody from the reserve takes.",
           .otherwise = "none",
           .list = true},
          {.key = "remove",
           .type = Type::cells,
           .doc = "Cells that are left empty: their people wait in the reserve.",
           .otherwise = "none",
           .list = true},
          {.key = "pin",
           .type = Type::pin,
           .doc = "Who stands on which cell, by name.",
           .otherwise = "none",
           .list = true},
      },
      "at formation"};
  return kListing;
}

const Listing& region_of_group_listing() {
  static const Listing kListing{
      "sections[].regions[]",
      "Which places of the section's formations are a group's.",
      {
          {.key = "group", .type = Type::text, .doc = "Name of a group.", .required = true},
          {.key = "cells",
           .type = Type::cells,
           .doc = "The group takes the places of each formation that lie here; where they are too few, the nearest "
                  "ones beside them, and the reserve as before.",
           .required = true,
           .list = true},
      }};
  return kListing;
}

Listing section_keys() {
  return {"sections[]",
          "A stretch of the show with one source of formations. Sections do not overlap.",
          {
              {.key = "name", .type = Type::text, .doc = "Unique.", .required = true},
              {.key = "from",
               .type = Type::mapping,
               .doc = "The formations.",
               .required = true,
               .listing = &source_listing()},
              {.key = "start",
               .type = Type::at_count,
               .doc = "Everybody stands in the first formation at this count.",
               .required = true,
               .range = {1, kMostCounts}},
              {.key = "duration",
               .type = Type::counts,
               .doc = "The video is stretched over it; a model of motion moves people so long.",
               .otherwise = "the video's own length",
               .range = {0, kMostCounts, true}},
              {.key = "hold",
               .type = Type::counts,
               .doc = "Everybody stands still that long after the last formation.",
               .fallback = "0 counts",
               .range = {0, kMostCounts}},
              {.key = "sampling",
               .type = Type::mapping,
               .doc = "Which frames of a video become formations.",
               .otherwise = "as below",
               .listing = &sampling_listing()},
              {.key = "planner",
               .type = Type::mapping,
               .doc = "How people are matched with cells.",
               .otherwise = "as below",
               .listing = &planner_listing()},
              {.key = "max_speed",
               .type = Type::speed,
               .doc = "Nobody walks faster in this section, nor into it.",
               .otherwise = "`stage.max_speed`",
               .range = {0, 20, true}},
              {.key = "keys",
               .type = Type::instant,
               .doc = "Counts, or times of the video's file, whose frames are the director's "
                      "key formations: exact, whatever is sampled between.",
               .otherwise = "the sampled formations",
               .list = true},
              {.key = "overrides",
               .type = Type::mapping,
               .doc = "Formations changed by hand.",
               .otherwise = "none",
               .listing = &override_listing(),
               .list = true},
              {.key = "regions",
               .type = Type::mapping,
               .doc = "Groups bound to parts of the floor.",
               .otherwise = "none",
               .listing = &region_of_group_listing(),
               .list = true},
          }};
}

}  // namespace

const Listing& section_listing() {
  static const Listing kListing = [] {
    Listing out = section_keys();
    for (Field& field : motion_fields()) out.fields.push_back(std::move(field));
    return out;
  }();
  return kListing;
}

}  // namespace footlight::config
