// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/field.hpp"
#include "config/text_tree.hpp"
#include "core/diagnostic.hpp"
#include "core/grid.hpp"

namespace footlight::config {

/// One file that is being read, and what is found wrong with it.
struct Reading {
  std::string file;
  Diagnostics& diagnostics;

  [[nodiscard]] Position at(const TextNode& node) const { return {file, node.line, node.column}; }
};

/// A scalar as written, with its place.
struct Written {
  std::string text;
  bool quoted = false;
  Position position;
  std::string path;
};

/// Reads a mapping by its listing. Construction reports keys that are unknown or missing; each getter reports what is
/// wrong with its value, and answers nothing then. A default of the listing goes the same way as a written value.
/// Asking for a key that the listing does not have, or as another type, is a programmer error.
class MappingReader {
 public:
  /// @param path of the mapping, empty for the root  @param key_position of the key whose value it is
  MappingReader(Reading& reading, std::shared_ptr<const TextNode> node, std::string path, Position key_position,
                const Listing& listing);

  [[nodiscard]] bool has(std::string_view key) const { return entry(key) != nullptr; }
  /// Place of the value, or of the mapping's own key where the value is missing.
  [[nodiscard]] Position at(std::string_view key) const;
  [[nodiscard]] Position key_position(std::string_view key) const;
  [[nodiscard]] const Position& position() const { return key_position_; }
  [[nodiscard]] std::string path(std::string_view key) const;
  [[nodiscard]] const std::string& path() const { return path_; }

  [[nodiscard]] std::optional<int> integer(std::string_view key);
  [[nodiscard]] std::optional<double> number(std::string_view key);
  [[nodiscard]] std::optional<bool> boolean(std::string_view key);
  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  /// Index into the field's choices.
  [[nodiscard]] std::optional<int> choice(std::string_view key);
  /// In the base unit of the field's type; at_count: the count.
  [[nodiscard]] std::optional<double> quantity(std::string_view key);
  /// A place on the floor, metres.
  [[nodiscard]] std::optional<Point> point(std::string_view key);
  /// A list of places; what is wrong with one of them is reported and leaves it out.
  [[nodiscard]] std::vector<Point> points(std::string_view key);
  /// At least three corners; empty after an error.
  [[nodiscard]] std::vector<Point> polygon(std::string_view key);
  /// A scalar that the caller converts; the default counts as written.
  [[nodiscard]] std::optional<Written> written(std::string_view key);
  /// The scalars of a list; a single scalar is a list of one. Mappings in it are reported.
  [[nodiscard]] std::vector<Written> list(std::string_view key);
  /// A mapping; an empty one where the key is missing, so that defaults come out of its listing. Nothing when the value
  /// is something else, or when a required mapping is missing.
  [[nodiscard]] std::optional<MappingReader> mapping(std::string_view key);
  [[nodiscard]] std::vector<MappingReader> mappings(std::string_view key);
  /// Nodes of a list whose items are scalars or mappings (Type::lamp).
  struct Item;
  [[nodiscard]] std::vector<Item> items(std::string_view key);

  void error(std::string_view key, std::string what, std::string hint = {});
  void error(const Written& written, std::string what, std::string hint = {});
  void error(const Position& position, const std::string& path, std::string what, std::string hint = {});
  [[nodiscard]] Reading& reading() const { return *reading_; }

 private:
  [[nodiscard]] const TextEntry* entry(std::string_view key) const;
  [[nodiscard]] const Field& field(std::string_view key) const;
  [[nodiscard]] std::optional<Written> scalar_of(const TextNode& node, const std::string& path, const Position& key);
  [[nodiscard]] std::vector<Item> items_of(std::string_view key, bool scalars, bool mappings);
  [[nodiscard]] std::optional<Point> point_of(const TextNode& node, const std::string& where, const Field& field);
  [[nodiscard]] std::vector<Point> points_of(std::string_view key, const Field& field);
  [[nodiscard]] std::optional<double> in_range(const Written& written, const Field& field, double value,
                                               std::string_view unit);
  void check_keys();
  void check_one_of();

  Reading* reading_;
  std::shared_ptr<const TextNode> node_;
  std::string path_;
  Position key_position_;
  const Listing* listing_;
};

/// One of the two.
struct MappingReader::Item {
  std::optional<Written> scalar;
  std::optional<MappingReader> mapping;
};

/// The whole file as a mapping of `listing`; nothing when its text cannot be read as YAML or is no mapping.
[[nodiscard]] std::optional<MappingReader> read_root(Reading& reading, std::string_view bytes, const Listing& listing);

}  // namespace footlight::config
