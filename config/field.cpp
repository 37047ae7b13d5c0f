// SPDX-License-Identifier: Apache-2.0
#include "config/field.hpp"

#include <algorithm>
#include <array>

#include "core/check.hpp"

namespace footlight::config {
namespace {

std::string_view single_name(Type type) {
  constexpr std::array<std::string_view, 29> kNames{"whole number",
                                                    "number",
                                                    "text",
                                                    "true or false",
                                                    "choice",
                                                    "length",
                                                    "speed",
                                                    "time",
                                                    "area",
                                                    "counts",
                                                    "count",
                                                    "colour",
                                                    "colour or group",
                                                    "quoted decimal",
                                                    "meter",
                                                    "file",
                                                    "cells",
                                                    "frames",
                                                    "performers",
                                                    "0 to 255 or otsu",
                                                    "mapping",
                                                    "counts or times of the video",
                                                    "cell -> cell",
                                                    "performer -> cell",
                                                    "cells or wearable",
                                                    "current",
                                                    "angle",
                                                    "[x, y]",
                                                    "list of [x, y]"};
  return kNames.at(static_cast<std::size_t>(type));
}

}  // namespace

const Field* Listing::find(std::string_view key) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.key == key; });
  return found == fields.end() ? nullptr : &*found;
}

bool is_quantity(Type type) {
  return type == Type::length || type == Type::speed || type == Type::time || type == Type::area ||
         type == Type::counts || type == Type::current || type == Type::angle;
}

Dimension dimension_of(Type type) {
  switch (type) {
    case Type::length:
      return Dimension::length;
    case Type::speed:
      return Dimension::speed;
    case Type::time:
      return Dimension::time;
    case Type::area:
      return Dimension::area;
    case Type::current:
      return Dimension::current;
    case Type::angle:
      return Dimension::angle;
    default:
      FL_CHECK(type == Type::counts);
      return Dimension::counts;
  }
}

std::string type_name(const Field& field) {
  const std::string single(single_name(field.type));
  return field.list ? "list of " + single + (field.type == Type::mapping ? "s" : "") : single;
}

}  // namespace footlight::config
