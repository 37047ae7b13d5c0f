// SPDX-License-Identifier: Apache-2.0
#include "config/motion_part.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "config/nearest.hpp"
#include "config/show_fields.hpp"

namespace footlight::config {
namespace {

const Listing& path_listing() {
  static const Listing kListing{
      "sections[].paths[]",
      "The way of a group through a section with a model of motion, straight from place to place.",
      {
          {.key = "group",
           .type = Type::text,
           .doc = "Name of a group.",
           .otherwise = "everybody who is in no other path's group"},
          {.key = "through",
           .type = Type::point,
           .doc = "Places on the floor, in their order.",
           .required = true,
           .range = {-1e5, 1e5},
           .list = true},
      }};
  return kListing;
}

const Listing& obstacle_at_listing() {
  static const Listing kListing{
      "sections[].obstacles[].at[]",
      "Where the middle of a moving obstacle is at one count.",
      {
          {.key = "count",
           .type = Type::number,
           .doc = "Of the music, later than the one before.",
           .required = true,
           .range = {1, kMostCounts}},
          {.key = "x",
           .type = Type::length,
           .doc = "From the centre line to stage left.",
           .required = true,
           .range = {-1e5, 1e5}},
          {.key = "y", .type = Type::length, .doc = "From the downstage edge.", .required = true, .range = {-1e5, 1e5}},
      }};
  return kListing;
}

const Listing& obstacle_listing() {
  static const Listing kListing{
      "sections[].obstacles[]",
      "Something round that moves through a section with a model of motion, straight and evenly between the counts "
      "where it is "
      "given, at rest before and after: a car, a lift. Nobody comes nearer to it than to a blocked cell.",
      {
          {.key = "radius",
           .type = Type::length,
           .doc = "Half of its width.",
           .required = true,
           .range = {0, 1000, true}},
          {.key = "at",
           .type = Type::mapping,
           .doc = "Where it is.",
           .required = true,
           .listing = &obstacle_at_listing(),
           .list = true},
      }};
  return kListing;
}

std::string names_of_models() {
  std::string out;
  for (const MotionModel& one : motion_models()) out += (out.empty() ? "" : ", ") + std::string(one.name);
  return out;
}

const MotionModel* motion_model(PlannerModel model) {
  const auto& models = motion_models();
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const MotionModel& one) { return one.model == model; });
  return found == models.end() ? nullptr : &*found;
}

void refuse(MappingReader& reader, std::initializer_list<std::string_view> keys, const std::string& hint) {
  for (const std::string_view key : keys) {
    if (reader.has(key)) reader.error(reader.key_position(key), reader.path(key), "the key has no meaning here", hint);
  }
}

std::vector<GroupPath> read_paths(ShowReading& show, MappingReader& section) {
  std::vector<GroupPath> out;
  for (MappingReader& reader : section.mappings("paths")) {
    GroupPath path;
    path.position = reader.position();
    path.through = reader.points("through");
    const auto name = reader.written("group");
    if (name && show.has_performers) path.group = find_group(show, reader, *name);
    const bool wrong = name && !path.group;
    const auto same = [&](const GroupPath& other) { return other.group == path.group; };
    if (!wrong && std::any_of(out.begin(), out.end(), same)) {
      reader.error(path.position, reader.path(),
                   name ? "the group " + in_quotes(name->text) + " has a path already"
                        : "there is a path without a group already",
                   "one path leads through all of its places");
    }
    if (!wrong) out.push_back(std::move(path));
  }
  return out;
}

std::vector<MovingObstacle> read_obstacles(MappingReader& section) {
  std::vector<MovingObstacle> out;
  for (MappingReader& reader : section.mappings("obstacles")) {
    MovingObstacle& obstacle = out.emplace_back();
    obstacle.position = reader.position();
    obstacle.radius_m = reader.quantity("radius").value_or(1);
    for (MappingReader& place : reader.mappings("at")) {
      const auto count = place.number("count");
      const auto x = place.quantity("x");
      const auto y = place.quantity("y");
      if (!count || !x || !y) continue;
      if (!obstacle.at.empty() && *count <= obstacle.at.back().count) {
        place.error("count", "count " + plain(*count) + " is not after count " + plain(obstacle.at.back().count),
                    "write the places in the order of time");
        continue;
      }
      obstacle.at.push_back({*count, {*x, *y}});
    }
    if (obstacle.at.empty()) out.pop_back();
  }
  return out;
}

/// A painting and its model go together.
void read_painting(ShowReading& show, MappingReader& section, const Section& out, Motion& motion) {
  auto* painted = std::get_if<PaintedOptions>(&motion.options);
  const bool painting = std::holds_alternative<PaintingSource>(out.from);
  if (painted == nullptr) {
    refuse(section, {"paint"}, "it goes with model: painted");
    if (painting) {
      section.error(section.key_position("from"), section.path("from"), "only `model: painted` follows a painting",
                    "model: painted, or another source");
    }
    return;
  }
  refuse(section, {"paths"}, "the strokes of a painting are the paths");
  painted->paint = read_paint(show, section);
  if (!painting && section.has("from")) {
    section.error(section.key_position("from"), section.path("from"), "`model: painted` follows a painting",
                  "from: {painting: FILE.png}");
  }
  if (!section.has("paint")) {
    section.error(section.position(), section.path("paint"), "the key is missing",
                  "it says which colour of the painting means what");
  }
}

}  // namespace

const std::vector<MotionModel>& motion_models() {
  // A model adds one line.
  static const std::vector<MotionModel> kModels{
      {"collective", PlannerModel::collective,
       "Pairs people and places with the least effort and leads sub-groups by social forces.", collective_listing,
       read_collective},
      {"srd", PlannerModel::srd,
       "Groups keep their formation on their way, give it up where they meet others, and find it again.", srd_listing,
       read_srd},
      {"swarm", PlannerModel::swarm,
       "Everybody looks for a way of her own to her place or to a target that moves; one cost for targets, obstacles "
       "and people.",
       swarm_listing, read_swarm},
      {"painted", PlannerModel::painted, "People follow the shapes and strokes of a painting (Kang, Kim 2014).",
       painted_listing, read_painted},
  };
  return kModels;
}

std::vector<Field> motion_fields() {
  return {
      {.key = "paths",
       .type = Type::mapping,
       .doc = "Ways of groups through the section, where its planner is a model of motion.",
       .otherwise = "straight to the end",
       .listing = &path_listing(),
       .list = true},
      {.key = "obstacles",
       .type = Type::mapping,
       .doc = "What moves through the section and must be kept away from, where its planner is a model of motion.",
       .otherwise = "none",
       .listing = &obstacle_listing(),
       .list = true},
      {.key = "marks",
       .type = Type::counts,
       .doc = "With a model of motion: people have a mark every so many counts, more often where their way is not "
              "straight between.",
       .otherwise = "as often as people can walk from cell to cell in every direction",
       .range = {0, 64, true}},
      {.key = "seed",
       .type = Type::integer,
       .doc = "With a model of motion: another number, another chance.",
       .fallback = "1",
       .range = {0, 2'147'483'647}},
      paint_field(),
  };
}

void read_motion(ShowReading& show, MappingReader& section, MappingReader& planner, Section& out) {
  const MotionModel* const chosen = motion_model(out.planner.model);
  for (const MotionModel& one : motion_models()) {
    if (&one == chosen) continue;
    refuse(planner, {one.name}, "it goes with model: " + std::string(one.name));
  }
  if (chosen == nullptr) {
    refuse(section, {"paths", "obstacles", "marks", "seed", "paint"},
           "it goes with a model of motion: " + names_of_models());
    if (std::holds_alternative<PaintingSource>(out.from)) {
      section.error(section.key_position("from"), section.path("from"), "only `model: painted` follows a painting",
                    "planner: {model: painted}, or another source");
    }
    return;
  }
  const std::string name(chosen->name);
  refuse(planner, {"layers", "region", "cost", "effort"},
         "`model: " + name + "` is given by the mapping `" + name + "`");
  refuse(section, {"keys", "sampling", "overrides", "regions"}, "`model: " + name + "` has marks of its own");
  if (std::holds_alternative<VideoSource>(out.from)) {
    section.error(section.key_position("from"), section.path("from"),
                  "`model: " + name + "` leads people to one formation, and a video has many",
                  "an image, cells or parts; or model: joint, hierarchical or flat");
  }
  if (!section.has("duration")) {
    section.error(section.position(), section.path("duration"), "the key is missing",
                  "`model: " + name + "` moves people so long to the section's formation");
  }
  auto motion = std::make_shared<Motion>();
  if (auto options = planner.mapping(chosen->name)) motion->options = chosen->read(show, std::move(*options));
  read_painting(show, section, out, *motion);
  motion->paths = read_paths(show, section);
  motion->obstacles = read_obstacles(section);
  motion->mark_counts = section.quantity("marks");
  motion->seed = static_cast<std::uint64_t>(section.integer("seed").value_or(1));
  out.motion = std::move(motion);
}

}  // namespace footlight::config
