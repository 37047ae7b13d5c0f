// SPDX-License-Identifier: Apache-2.0
// `planner: {model: painted, painted: {...}}` and `paint`: what the colours of a painting mean.
#include <algorithm>
#include <string>

#include "config/motion_part.hpp"
#include "config/nearest.hpp"
#include "core/motion/painted_options.hpp"

namespace footlight::config {
namespace {

const Listing& paint_listing() {
  static const Listing kListing{
      "sections[].paint[]",
      "What one colour of a painting means. Grey is background and white is floor without being named.",
      {
          {.key = "colour", .type = Type::colour, .doc = "`#RRGGBB`, in quotes.", .required = true},
          {.key = "role",
           .type = Type::choice,
           .doc = "`shape`: people stand there at the beginning, on the way or at the end; `stroke`: the way from one "
                  "shape to the next, bright where people come from.",
           .required = true,
           .choices = {"shape", "stroke"}},
          {.key = "group",
           .type = Type::text,
           .doc = "Whose it is: name of a group.",
           .otherwise = "of everybody in no other paint's group"},
          {.key = "order",
           .type = Type::integer,
           .doc = "Of a shape its place in the sequence; of a stroke the order of the shape where it begins.",
           .fallback = "1",
           .range = {1, 100}},
          {.key = "tolerance",
           .type = Type::number,
           .doc = "Of a shape the largest difference in one of red, green and blue; of a stroke that of the hue, in "
                  "degrees, whatever the brightness.",
           .fallback = "20",
           .range = {0, 255}},
      }};
  return kListing;
}

}  // namespace

const Listing& painted_listing() {
  static const Listing kListing{
      "sections[].planner.painted",
      "How people follow a painting (docs/algorithms/painted.md); `footlight painting` draws what is understood of it. "
      "Forces are weights, 1 as they were tuned, 0 without.",
      {
          {.key = "background",
           .type = Type::choice,
           .doc = "Grey in the painting: `repel`: walls, which block their cells all show long and keep people off; "
                  "`attract`: no obstacle, people gather along its outlines; `none`: not looked at.",
           .fallback = "repel",
           .choices = {"repel", "attract", "none"}},
          {.key = "resolution",
           .type = Type::integer,
           .doc = "Pixels of the longer side of the floor as it is worked on; the paper's is 64.",
           .fallback = "128",
           .range = {32, 512}},
          {.key = "iterations",
           .type = Type::integer,
           .doc = "Inputs that each map of a shape is shown; at least 20 a person.",
           .fallback = "3000",
           .range = {100, 1'000'000}},
          {.key = "grey",
           .type = Type::number,
           .doc = "Largest difference between red, green and blue of a grey.",
           .fallback = "12",
           .range = {0, 100}},
          {.key = "stroke", .type = Type::number, .doc = "Of the strokes' field.", .fallback = "1", .range = {0, 10}},
          {.key = "walls",
           .type = Type::number,
           .doc = "Of the background's field.",
           .fallback = "1",
           .range = {0, 10}},
          {.key = "flow",
           .type = Type::number,
           .doc = "Of the incompressible flow within strokes.",
           .fallback = "0.5",
           .range = {0, 10}},
          {.key = "people",
           .type = Type::number,
           .doc = "Of the pressure and viscosity between people.",
           .fallback = "1",
           .range = {0, 10}},
          {.key = "viscosity",
           .type = Type::number,
           .doc = "How much people take on of their neighbours' velocity, m2/s.",
           .fallback = "0.5",
           .range = {0, 10}},
          {.key = "reaction",
           .type = Type::time,
           .doc = "Time to reach a wanted velocity.",
           .fallback = "0.5 s",
           .range = {0, 10, true}},
          {.key = "step", .type = Type::time, .doc = "Of the simulation.", .fallback = "0.1 s", .range = {0.01, 0.5}},
      }};
  return kListing;
}

MotionOptions read_painted(ShowReading&, MappingReader reader) {
  PaintedOptions out;
  out.background = static_cast<PaintedOptions::Background>(reader.choice("background").value_or(0));
  out.resolution = reader.integer("resolution").value_or(out.resolution);
  out.iterations = reader.integer("iterations").value_or(out.iterations);
  out.grey_tolerance = reader.number("grey").value_or(out.grey_tolerance);
  out.stroke_force = reader.number("stroke").value_or(out.stroke_force);
  out.background_force = reader.number("walls").value_or(out.background_force);
  out.flow_force = reader.number("flow").value_or(out.flow_force);
  out.people_force = reader.number("people").value_or(out.people_force);
  out.viscosity = reader.number("viscosity").value_or(out.viscosity);
  out.reaction_s = reader.quantity("reaction").value_or(out.reaction_s);
  out.step_s = reader.quantity("step").value_or(out.step_s);
  return out;
}

Field paint_field() {
  return {.key = "paint",
          .type = Type::mapping,
          .doc = "What the colours of a painting mean, with `model: painted`.",
          .otherwise = "no colour means anything",
          .listing = &paint_listing(),
          .list = true};
}

std::vector<Paint> read_paint(ShowReading& show, MappingReader& section) {
  std::vector<Paint> out;
  for (MappingReader& reader : section.mappings("paint")) {
    Paint paint;
    paint.position = reader.position();
    const auto colour = reader.written("colour");
    const auto parsed = colour ? parse_colour(colour->text) : std::nullopt;
    if (colour && !parsed) {
      reader.error(*colour, in_quotes(colour->text) + " is not a colour", "write \"#RRGGBB\", in quotes");
    }
    const auto role = reader.choice("role");
    const auto name = reader.written("group");
    if (name && show.has_performers) paint.group = find_group(show, reader, *name);
    paint.order = reader.integer("order").value_or(1);
    paint.tolerance = reader.number("tolerance").value_or(paint.tolerance);
    if (!parsed || !role || (name && !paint.group)) continue;
    paint.colour = *parsed;
    paint.role = static_cast<Paint::Role>(*role);
    const auto same = [&](const Paint& other) { return other.colour == paint.colour; };
    if (std::any_of(out.begin(), out.end(), same)) {
      reader.error(*colour, "the colour " + to_text(paint.colour) + " is bound a second time",
                   "a colour means one thing");
      continue;
    }
    out.push_back(paint);
  }
  return out;
}

}  // namespace footlight::config
