// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMostParts = 1000;
constexpr std::size_t kLongestText = 1000;  // bytes

bool is_placed(const MappingReader& from) {
  constexpr std::array kPlacing{"at", "width", "height", "spacing", "turn"};
  return std::any_of(kPlacing.begin(), kPlacing.end(), [&](const char* key) { return from.has(key); });
}

bool is_round(Shape::Kind kind) {
  return kind == Shape::Kind::circle || kind == Shape::Kind::ring || kind == Shape::Kind::arc ||
         kind == Shape::Kind::spiral;
}

Shape read_shape(MappingReader& from) {
  Shape out;
  const auto kind = from.choice("shape");
  if (!kind) return out;
  out.kind = static_cast<Shape::Kind>(*kind);
  out.rows = from.integer("rows").value_or(0);
  out.angle_rad = from.quantity("angle").value_or(out.angle_rad);
  out.turns = from.number("turns").value_or(out.turns);
  if (out.kind != Shape::Kind::block) refuse_keys(from, {"rows"}, "only a block has rows");
  if (out.kind != Shape::Kind::arc) refuse_keys(from, {"angle"}, "only an arc has an angle");
  if (out.kind != Shape::Kind::spiral) refuse_keys(from, {"turns"}, "only a spiral has turns");
  if (is_round(out.kind)) {
    refuse_keys(from, {"width", "height"}, "its size is its radius");
  } else {
    refuse_keys(from, {"radius"}, "a circle, ring, arc or spiral has a radius");
  }
  if (out.kind == Shape::Kind::line) refuse_keys(from, {"height"}, "a line has a width");
  refuse_keys(from, {"font"}, "it goes with a text");
  refuse_keys(from, {"view"}, "it goes with a mesh");
  return out;
}

Lettering read_lettering(MappingReader& from) {
  Lettering out;
  out.text = from.text("text").value_or("?");
  out.font = from.text("font").value_or("");
  if (std::all_of(out.text.begin(), out.text.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; })) {
    from.error("text", "there is nothing to draw in it", "write a word or a sign");
  } else if (out.text.size() > kLongestText) {
    from.error("text", std::to_string(out.text.size()) + " bytes are too many", "at most 1000");
  }
  return out;
}

class PartReader {
 public:
  PartReader(ShowReading& show, MappingReader& from) : show_(show), from_(from) {}

  Part read(bool one_of_several) {
    Part out;
    out.position = from_.position();
    out.drawing = drawing();
    if (one_of_several) {
      const auto name = from_.written("group");
      if (name && show_.has_performers) out.group = find_group(show_, from_, *name);
      out.people = from_.integer("people");
    }
    out.at = from_.point("at");
    out.width_m = from_.quantity("width").value_or(0);
    out.height_m = from_.quantity("height").value_or(0);
    out.radius_m = from_.quantity("radius").value_or(0);
    out.spacing_m = from_.quantity("spacing").value_or(0);
    out.turn_rad = from_.quantity("turn").value_or(0);
    const bool sized = from_.has("width") || from_.has("height") || from_.has("radius");
    if (sized) refuse_keys(from_, {"spacing"}, "its size says how far people are from each other");
    return out;
  }

 private:
  Drawing drawing() {
    if (!from_.has("image")) refuse_keys(from_, {"threshold", "invert", "colour"}, "it goes with an image");
    if (from_.has("shape")) return read_shape(from_);
    refuse_keys(from_, {"rows", "angle", "turns", "radius"}, "it goes with a shape");
    if (from_.has("text")) {
      refuse_keys(from_, {"view"}, "it goes with a mesh");
      return read_lettering(from_);
    }
    refuse_keys(from_, {"font"}, "it goes with a text");
    if (from_.has("mesh")) {
      Mesh out;
      out.view = static_cast<Mesh::View>(from_.choice("view").value_or(0));
      out.path = existing_file(from_, "mesh", show_.folder, show_.loaded.files);
      if (!out.path.empty()) out.vertices = read_mesh(out.path, from_.reading().diagnostics);
      return out;
    }
    refuse_keys(from_, {"view"}, "it goes with a mesh");
    if (!from_.has("image")) return Shape{};  // said already
    return Picture{existing_file(from_, "image", show_.folder, show_.loaded.files), read_picture(from_)};
  }

  ShowReading& show_;
  MappingReader& from_;
};

}  // namespace

bool is_one_part(const MappingReader& from) {
  return from.has("shape") || from.has("text") || from.has("mesh") || (from.has("image") && is_placed(from));
}

PartsSource read_parts(ShowReading& show, MappingReader& from) {
  auto out = std::make_shared<std::vector<Part>>();
  if (!from.has("parts")) {
    out->push_back(PartReader(show, from).read(false));
    return {out};
  }
  refuse_keys(from,
              {"at", "width", "height", "radius", "spacing", "turn", "rows", "angle", "turns", "font", "view",
               "threshold", "invert", "colour"},
              "write it into a part");
  auto readers = from.mappings("parts");
  if (readers.empty()) from.error("parts", "the list is empty", "at least one part is needed");
  if (readers.size() > kMostParts) {
    from.error("parts", std::to_string(readers.size()) + " parts are too many", "at most 1000");
    return {out};
  }
  for (MappingReader& reader : readers) out->push_back(PartReader(show, reader).read(true));
  return {out};
}

}  // namespace footlight::config
