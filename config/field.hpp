// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/quantity.hpp"

namespace footlight::config {

/// What the value of a key is. Reader, JSON Schema and reference tables all go by it.
enum class Type {
  integer,
  number,
  text,     ///< any scalar
  boolean,  ///< true or false
  choice,   ///< one of Field::choices
  length,   ///< quantities with a unit, as Dimension
  speed,
  time,
  area,
  counts,
  at_count,     ///< "count 233"
  colour,       ///< "#RRGGBB"
  look_colour,  ///< "#RRGGBB" or group
  cue_number,   ///< quoted decimal
  meter,        ///< "4/4"
  file,         ///< path, relative to the folder of the file that names it
  cells,        ///< cell or range of cells, "A1" or "A1:J48"
  frames,       ///< "0-249"
  members,      ///< performer id or range of numbers, "1-300"
  threshold,    ///< otsu or 0..255
  mapping,      ///< Field::listing
  instant,      ///< "count 17", or a time of a video as "2.4 s"
  move,         ///< "B4 -> C4": cell, cell
  pin,          ///< "17 -> C4": performer, cell
  lamp,         ///< cells, or a mapping as Field::listing
  current,      ///< a quantity, as length
  angle,        ///< a quantity, as length
  point,        ///< a place on the floor: [x, y], two lengths
  polygon,      ///< three points or more
};

struct Listing;

/// One key of a mapping: the single source for reading it, for refusing it, for the JSON Schema and for the tables of
/// the documentation.
struct Field {
  std::string_view key;
  Type type = Type::text;
  std::string_view doc;  ///< one sentence
  bool required = false;
  std::string_view fallback{};   ///< the default as one would write it; empty: none
  std::string_view otherwise{};  ///< what holds without it, where that is no constant
  Range range{};                 ///< of numbers and quantities, in the base unit
  std::vector<std::string_view> choices{};
  const Listing* listing = nullptr;  ///< of a mapping, or of a list's items
  bool bare = false;                 ///< a quantity may be written without its unit, then in the base unit
  bool list = false;                 ///< a list of `type`; a single value may stand for a list of one where not mapping
};

/// The keys of one kind of mapping, in the order in which they are documented.
struct Listing {
  std::string_view name;  ///< as in the headings of the documentation
  std::string_view doc;
  std::vector<Field> fields;
  std::string_view one_of{};  ///< keys of which exactly one is given, separated by blanks

  [[nodiscard]] const Field* find(std::string_view key) const;
};

/// Dimension of a quantity type; FL_CHECK for others.
[[nodiscard]] Dimension dimension_of(Type type);
[[nodiscard]] bool is_quantity(Type type);
/// "length", "whole number", "list of cells" ...: for tables and messages.
[[nodiscard]] std::string type_name(const Field& field);

// The listings. Each is made once and lives for ever.
[[nodiscard]] const Listing& show_listing();
[[nodiscard]] const Listing& rig_listing();
[[nodiscard]] const Listing& profile_listing();
[[nodiscard]] const Listing& remote_listing();
/// What lamps take, in a rig and in a profile.
[[nodiscard]] const Listing& currents_listing();

}  // namespace footlight::config
