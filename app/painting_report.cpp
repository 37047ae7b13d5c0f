// SPDX-License-Identifier: Apache-2.0
#include "app/painting_report.hpp"

#include <cstddef>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/paper/painting_overlay.hpp"

namespace footlight::app {
namespace {

using nlohmann::ordered_json;
using planner::PaintedScene;

ordered_json stroke_json(const PaintedScene& scene, const planner::Stroke& stroke) {
  const Point tail = scene.floor.to_floor(stroke.line.front());
  const Point head = scene.floor.to_floor(stroke.line.back());
  ordered_json line = ordered_json::array();
  for (std::size_t i = 0; i < stroke.line.size(); ++i) {
    const Point at = scene.floor.to_floor(stroke.line[i]);
    line.push_back({at.x, at.y, 2 * stroke.half_width[i] * scene.floor.pixel_m});
  }
  return {{"length_m", stroke.length_px() * scene.floor.pixel_m},
          {"width_m", mean_width_m(scene, stroke)},
          {"fall", stroke.fall},
          {"tail", {tail.x, tail.y}},
          {"head", {head.x, head.y}},
          {"line", std::move(line)}};
}

ordered_json party_json(const Show& show, const PaintedScene& scene, const PaintedScene::Party& party) {
  ordered_json shapes = ordered_json::array();
  for (std::size_t s = 0; s < party.shapes.size(); ++s) {
    shapes.push_back({{"order", party.orders[s]}, {"area_m2", area_m2(scene, party.shapes[s])}});
  }
  ordered_json legs = ordered_json::array();
  for (std::size_t l = 0; l < party.legs.size(); ++l) {
    ordered_json strokes = ordered_json::array();
    for (const planner::Stroke& stroke : party.legs[l].strokes) strokes.push_back(stroke_json(scene, stroke));
    legs.push_back({{"from", party.orders[l]}, {"to", party.orders[l + 1]}, {"strokes", std::move(strokes)}});
  }
  ordered_json out;
  out["group"] = party.group ? ordered_json(show.groups[party.group->at()].name) : ordered_json();
  out["people"] = party.people;
  out["shapes"] = std::move(shapes);
  out["legs"] = std::move(legs);
  return out;
}

const std::string& path_of(const Show& show, SectionIndex section) {
  return std::get<PaintingSource>(show.sections[section.at()].from).path;
}

}  // namespace

std::string painting_text(const Show& show, SectionIndex section, const PaintedScene& scene, const std::string& file) {
  std::string out =
      fmt::format("{}: '{}', {} x {} pixels, {:.3g} m each\n", show.sections[section.at()].name, path_of(show, section),
                  scene.picture_width, scene.picture_height, scene.picture.pixel_m);
  for (const PaintedScene::Party& party : scene.parties) {
    out += party_name(show, party) + "\n";
    for (const std::string& line : party_lines(scene, party)) out += "  " + line + "\n";
  }
  out += fmt::format("{} cells are blocked", scene.ways->blocked().size());
  if (!file.empty()) out += "\n" + file;
  return out;
}

std::string painting_json(const Show& show, SectionIndex section, const PaintedScene& scene, const std::string& file) {
  ordered_json out;
  out["section"] = show.sections[section.at()].name;
  out["painting"] = {{"file", path_of(show, section)},
                     {"width", scene.picture_width},
                     {"height", scene.picture_height},
                     {"pixel_m", scene.picture.pixel_m}};
  out["parties"] = ordered_json::array();
  for (const PaintedScene::Party& party : scene.parties) out["parties"].push_back(party_json(show, scene, party));
  out["blocked_cells"] = scene.ways->blocked().size();
  out["warnings"] = scene.notes;
  out["files"] = ordered_json::array();
  if (!file.empty()) out["files"].push_back(file);
  return out.dump(2);
}

}  // namespace footlight::app
