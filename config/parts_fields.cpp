// SPDX-License-Identifier: Apache-2.0
// Keys of a drawing on the floor: what it is, how large, where.
#include "config/show_fields.hpp"

namespace footlight::config {
namespace {

constexpr double kLargest_m = 10'000;

const Listing& colour_range_listing() {
  static const Listing kListing{"sections[].from.colour",
                                "Which colours are the picture: each of red, green and blue from the one to the other.",
                                {
                                    {.key = "from", .type = Type::colour, .doc = "The darkest.", .required = true},
                                    {.key = "to", .type = Type::colour, .doc = "The lightest.", .required = true},
                                }};
  return kListing;
}

/// Names of shapes in the order of Shape::Kind.
std::vector<std::string_view> shapes() {
  return {"line", "block", "circle", "ring", "arc", "spiral", "wedge", "chevron"};
}

}  // namespace

std::vector<Field> drawing_fields() {
  return {
      {.key = "shape",
       .type = Type::choice,
       .doc = "People evenly on a figure: `circle` is filled and `ring` its edge, `arc` opens downstage, `wedge` "
              "(filled) and `chevron` (two lines) have their point downstage.",
       .choices = shapes()},
      {.key = "text", .type = Type::text, .doc = "Words in any script, one line or several; one formation."},
      {.key = "mesh",
       .type = Type::file,
       .doc =
           "The corners of a body from an OBJ file (its lines `v`), seen from one side, thinned to as many as people."},
  };
}

std::vector<Field> picture_fields() {
  return {
      {.key = "threshold",
       .type = Type::threshold,
       .doc = "Pixels brighter than this are the picture; `otsu` finds one value for the section.",
       .fallback = "otsu"},
      {.key = "invert", .type = Type::boolean, .doc = "Dark pixels are the picture.", .fallback = "false"},
      {.key = "colour",
       .type = Type::mapping,
       .doc = "Of an image, in the place of the threshold: which colours are the picture.",
       .otherwise = "the threshold decides",
       .listing = &colour_range_listing()},
  };
}

std::vector<Field> size_fields() {
  return {
      {.key = "at",
       .type = Type::point,
       .doc = "Its middle, to stage left of the centre line and upstage of the edge.",
       .otherwise = "the middle of the floor without the reserve",
       .range = {-kLargest_m, kLargest_m}},
      {.key = "width",
       .type = Type::length,
       .doc = "Of a line, block, wedge, chevron, text, mesh or image, before it is turned; without `height` the "
              "proportions are kept.",
       .otherwise = "as `height` or `spacing` asks",
       .range = {0, kLargest_m, true}},
      {.key = "height",
       .type = Type::length,
       .doc = "Of a block, wedge, chevron, text, mesh or image; of two that do not fit its proportions an image and a "
              "text keep within both.",
       .otherwise = "as `width` or `spacing` asks",
       .range = {0, kLargest_m, true}},
      {.key = "radius",
       .type = Type::length,
       .doc = "Of a circle, ring, arc or spiral.",
       .otherwise = "as `spacing` asks",
       .range = {0, kLargest_m, true}},
      {.key = "spacing",
       .type = Type::length,
       .doc = "Where no size is given: how far neighbours are from each other.",
       .otherwise = "one and a half pitches, or clearances where that is more",
       .range = {0, 1000, true}},
      {.key = "turn",
       .type = Type::angle,
       .doc = "Counter-clockwise as seen from above.",
       .fallback = "0 deg",
       .range = {-7, 7}},
      {.key = "rows",
       .type = Type::integer,
       .doc = "Ranks of a block.",
       .otherwise = "as its size asks, else as many as files",
       .range = {1, 100'000}},
      {.key = "angle",
       .type = Type::angle,
       .doc = "Of an arc, from its first to its last person.",
       .otherwise = "180 deg",
       .range = {0, 6.2832, true}},
      {.key = "turns", .type = Type::number, .doc = "Of a spiral.", .otherwise = "2", .range = {0, 100, true}},
      {.key = "font",
       .type = Type::text,
       .doc = "Of a text: family and style, as `Noto Sans CJK SC Bold`; it must have every character.",
       .otherwise = "whatever fonts have the characters, bold"},
      {.key = "view",
       .type = Type::choice,
       .doc = "Of a mesh: which side is seen from above; its y axis points up, its z axis to the front.",
       .otherwise = "`top`",
       .choices = {"top", "front", "side"}},
  };
}

const Listing& part_listing() {
  static const Listing kListing = [] {
    Listing out{
        "sections[].from.parts[]", "One drawing of a formation, for some of the people.", {}, "shape text mesh image"};
    const auto add = [&](std::vector<Field> fields) {
      for (Field& field : fields) out.fields.push_back(std::move(field));
    };
    add({{.key = "group",
          .type = Type::text,
          .doc = "Whose places they are.",
          .otherwise = "of everybody in no other part's group"},
         {.key = "people",
          .type = Type::integer,
          .doc = "How many of them.",
          .otherwise = "who is left, shared evenly by the parts that say nothing",
          .range = {1, 100'000}}});
    add(drawing_fields());
    add({{.key = "image", .type = Type::file, .doc = "A picture (PNG, JPEG, BMP, PBM, PGM) or an SVG drawing."}});
    add(picture_fields());
    add(size_fields());
    return out;
  }();
  return kListing;
}

}  // namespace footlight::config
