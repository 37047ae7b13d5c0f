// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/field.hpp"
#include "config/remote_file.hpp"
#include "config/rig_file.hpp"
#include "config/show_file.hpp"
#include "core/check.hpp"

namespace footlight::config {
namespace {

using Json = nlohmann::ordered_json;

Json object_of(const Listing& listing);

Json text_of(std::string_view pattern) { return {{"type", "string"}, {"pattern", pattern}}; }

constexpr std::string_view kCells = "^[A-Za-z]+[1-9][0-9]*(:[A-Za-z]+[1-9][0-9]*)?$";
constexpr std::string_view kCount = "^count +[0-9]*\\.?[0-9]+ *$";
constexpr std::string_view kColour = "^#[0-9A-Fa-f]{6}$";

/// Bounds of a number that has no unit; those of quantities are beyond what a pattern can say.
void add_range(Json& schema, const Range& range) {
  const auto bound = [](double value) { return value == std::floor(value) ? Json(std::llround(value)) : Json(value); };
  if (range.min > -1e300) schema[range.above_min ? "exclusiveMinimum" : "minimum"] = bound(range.min);
  if (range.max < 1e300) schema["maximum"] = bound(range.max);
}

Json number_of(const Field& field) {
  Json out{{"type", field.type == Type::integer ? "integer" : "number"}};
  add_range(out, field.range);
  return out;
}

Json quantity_of(const Field& field) {
  Json out = text_of(pattern_of(dimension_of(field.type)));
  if (!field.bare) return out;
  Json bare{{"type", "number"}};
  add_range(bare, field.range);
  return {{"anyOf", Json::array({std::move(out), std::move(bare)})}};
}

/// [x, y]
Json point_schema() {
  return {{"type", "array"}, {"items", text_of(pattern_of(Dimension::length))}, {"minItems", 2}, {"maxItems", 2}};
}

/// A single value of the field's type.
Json value_of(const Field& field) {
  switch (field.type) {
    case Type::integer:
    case Type::number:
      return number_of(field);
    case Type::text:
      return {{"type", Json::array({"string", "number"})}};
    case Type::file:
      return {{"type", "string"}, {"minLength", 1}};
    case Type::boolean:
      return {{"type", "boolean"}};
    case Type::choice:
      return {{"enum", field.choices}};
    case Type::length:
    case Type::speed:
    case Type::time:
    case Type::area:
    case Type::counts:
    case Type::current:
    case Type::angle:
      return quantity_of(field);
    case Type::at_count:
      return text_of(kCount);
    case Type::colour:
      return text_of(kColour);
    case Type::look_colour:
      return {{"anyOf", Json::array({Json{{"const", "group"}}, text_of(kColour)})}};
    case Type::cue_number:
      return text_of("^[0-9]{1,9}(\\.[0-9]{1,6})?$");
    case Type::meter:
      return text_of("^[0-9]+/[0-9]+$");
    case Type::cells:
      return text_of(kCells);
    case Type::frames:
      return text_of("^[0-9]+-[0-9]*$");
    case Type::members:
      return {{"type", Json::array({"string", "integer"})}};
    case Type::threshold:
      return {{"anyOf",
               Json::array({Json{{"const", "otsu"}}, Json{{"type", "integer"}, {"minimum", 0}, {"maximum", 255}}})}};
    case Type::instant:
      return {{"anyOf", Json::array({text_of(kCount), text_of(pattern_of(Dimension::time))})}};
    case Type::move:
      return text_of("^ *[A-Za-z]+[1-9][0-9]* *-> *[A-Za-z]+[1-9][0-9]* *$");
    case Type::pin:
      return text_of("^.+-> *[A-Za-z]+[1-9][0-9]* *$");
    case Type::point:
      return point_schema();
    case Type::polygon:
      return {{"type", "array"}, {"items", point_schema()}, {"minItems", 3}};
    case Type::mapping:
      return object_of(*field.listing);
    case Type::lamp:
      return {{"anyOf", Json::array({Json{{"const", kUnusedChannel}}, text_of(kCells), object_of(*field.listing)})}};
  }
  FL_CHECK(false);
}

/// The default as a value of its JSON type.
Json default_of(const Field& field) {
  const std::string text(field.fallback);
  switch (field.type) {
    case Type::integer:
      return parse_integer(text).value();
    case Type::number:
      return parse_number(text).value();
    case Type::boolean:
      return text == "true";
    default:
      return text;
  }
}

Json property_of(const Field& field) {
  Json out = value_of(field);
  if (field.list) {
    Json items = std::move(out);
    out = {{"type", "array"}, {"items", items}};
    // As the reader has it, a single value may stand for a list of one.
    if (field.type != Type::mapping && field.type != Type::point)
      out = {{"anyOf", Json::array({std::move(out), std::move(items)})}};
  }
  out["description"] = field.doc;
  if (!field.fallback.empty()) out["default"] = default_of(field);
  return out;
}

Json object_of(const Listing& listing) {
  Json properties = Json::object();
  Json required = Json::array();
  for (const Field& field : listing.fields) {
    properties[std::string(field.key)] = property_of(field);
    if (field.required) required.push_back(field.key);
  }
  Json out{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
  if (!required.empty()) out["required"] = std::move(required);
  if (listing.one_of.empty()) return out;
  Json alternatives = Json::array();
  for (std::string_view rest = listing.one_of; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    alternatives.push_back({{"required", Json::array({word})}});
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  out["oneOf"] = std::move(alternatives);
  return out;
}

std::string schema_text(const Listing& listing, std::string_view title) {
  Json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}, {"description", listing.doc}};
  out.update(object_of(listing));
  return out.dump(2) + "\n";
}

}  // namespace

std::string show_schema() { return schema_text(show_listing(), "Footlight show file"); }
std::string rig_schema() { return schema_text(rig_listing(), "Footlight rig file"); }
std::string remote_schema() { return schema_text(remote_listing(), "Footlight remote control file"); }
std::string profile_schema() { return schema_text(profile_listing(), "Footlight device profile"); }

}  // namespace footlight::config
