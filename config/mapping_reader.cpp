// SPDX-License-Identifier: Apache-2.0
#include "config/mapping_reader.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "config/nearest.hpp"
#include "core/check.hpp"

namespace footlight::config {
namespace {

std::string_view found(const TextNode& node) {
  switch (node.kind) {
    case TextNode::Kind::null:
      return "nothing";
    case TextNode::Kind::scalar:
      return "a single value";
    case TextNode::Kind::sequence:
      return "a list";
    case TextNode::Kind::mapping:
      return "a mapping";
  }
  return "nothing";
}

std::vector<std::string> keys_of(const Listing& listing) {
  std::vector<std::string> out;
  for (const Field& field : listing.fields) out.emplace_back(field.key);
  return out;
}

std::string element(const std::string& path, std::size_t index) { return path + "[" + std::to_string(index) + "]"; }

}  // namespace

MappingReader::MappingReader(Reading& reading, std::shared_ptr<const TextNode> node, std::string path,
                             Position key_position, const Listing& listing)
    : reading_(&reading),
      node_(std::move(node)),
      path_(std::move(path)),
      key_position_(std::move(key_position)),
      listing_(&listing) {
  check_keys();
  check_one_of();
}

void MappingReader::check_keys() {
  for (const TextEntry& e : node_->entries) {
    if (listing_->find(e.key) == nullptr) {
      reading_->diagnostics.error({reading_->file, e.line, e.column}, path(e.key), "unknown key",
                                  suggestion(e.key, keys_of(*listing_), "known keys"));
    }
  }
  for (const Field& f : listing_->fields) {
    if (f.required && !has(f.key)) {
      reading_->diagnostics.error(key_position_, path(f.key), "the key is missing", std::string(f.doc));
    }
  }
}

void MappingReader::check_one_of() {
  if (listing_->one_of.empty()) return;
  std::istringstream words{std::string(listing_->one_of)};
  std::string all;
  std::vector<std::string> given;
  for (std::string word; words >> word;) {
    all += (all.empty() ? "" : ", ") + word;
    if (has(word)) given.push_back(word);
  }
  if (given.empty()) {
    error(key_position_, path_, "one of the keys " + all + " is missing", "give exactly one of them");
  } else if (given.size() > 1) {
    error(key_position(given[1]), path(given[1]), "does not go with \"" + given[0] + "\"",
          "give exactly one of " + all);
  }
}

const TextEntry* MappingReader::entry(std::string_view key) const {
  const auto& entries = node_->entries;
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const TextEntry& e) { return e.key == key; });
  return at == entries.end() ? nullptr : &*at;
}

const Field& MappingReader::field(std::string_view key) const {
  const Field* found_field = listing_->find(key);
  FL_CHECK(found_field != nullptr);
  return *found_field;
}

Position MappingReader::at(std::string_view key) const {
  const TextEntry* e = entry(key);
  if (e == nullptr) return key_position_;
  if (e->value->kind == TextNode::Kind::null) return {reading_->file, e->line, e->column};
  return reading_->at(*e->value);
}

Position MappingReader::key_position(std::string_view key) const {
  const TextEntry* e = entry(key);
  return e == nullptr ? key_position_ : Position{reading_->file, e->line, e->column};
}

std::string MappingReader::path(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void MappingReader::error(std::string_view key, std::string what, std::string hint) {
  error(at(key), path(key), std::move(what), std::move(hint));
}

void MappingReader::error(const Written& written, std::string what, std::string hint) {
  error(written.position, written.path, std::move(what), std::move(hint));
}

void MappingReader::error(const Position& position, const std::string& where, std::string what, std::string hint) {
  reading_->diagnostics.error(position, where, std::move(what), std::move(hint));
}

std::optional<Written> MappingReader::scalar_of(const TextNode& node, const std::string& where, const Position& key) {
  if (node.kind == TextNode::Kind::scalar) return Written{node.text, node.quoted, reading_->at(node), where};
  if (node.kind == TextNode::Kind::null) {
    error(key, where, "the key has no value", "write one, or leave the key out");
  } else {
    error(reading_->at(node), where, std::string(found(node)) + " stands where a single value belongs");
  }
  return std::nullopt;
}

std::optional<Written> MappingReader::written(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(!f.list && f.type != Type::mapping);
  if (const TextEntry* e = entry(key)) return scalar_of(*e->value, path(key), key_position(key));
  if (f.fallback.empty()) return std::nullopt;
  return Written{std::string(f.fallback), true, key_position_, path(key)};
}

std::optional<double> MappingReader::in_range(const Written& value_text, const Field& f, double value,
                                              std::string_view unit) {
  if (f.range.contains(value)) return value;
  error(value_text, in_quotes(value_text.text) + " is out of range", to_text(f.range, unit));
  return std::nullopt;
}

std::optional<int> MappingReader::integer(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::integer);
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  const auto value = parse_integer(value_text->text);
  if (!value) {
    error(*value_text, in_quotes(value_text->text) + " is not a whole number", to_text(f.range, ""));
    return std::nullopt;
  }
  return in_range(*value_text, f, *value, "") ? value : std::nullopt;
}

std::optional<double> MappingReader::number(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::number);
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  const auto value = parse_number(value_text->text);
  if (!value) {
    error(*value_text, in_quotes(value_text->text) + " is not a number", to_text(f.range, ""));
    return std::nullopt;
  }
  return in_range(*value_text, f, *value, "");
}

std::optional<bool> MappingReader::boolean(std::string_view key) {
  FL_CHECK(field(key).type == Type::boolean);
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  if (value_text->text == "true") return true;
  if (value_text->text == "false") return false;
  error(*value_text, in_quotes(value_text->text) + " is neither true nor false", "write true or false");
  return std::nullopt;
}

std::optional<std::string> MappingReader::text(std::string_view key) {
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  if (value_text->text.empty() && has(key)) {
    error(*value_text, "the text is empty", "write one, or leave the key out");
    return std::nullopt;
  }
  return value_text->text;
}

std::optional<int> MappingReader::choice(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::choice);
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  const auto at_choice = std::find(f.choices.begin(), f.choices.end(), value_text->text);
  if (at_choice != f.choices.end()) return static_cast<int>(at_choice - f.choices.begin());
  error(*value_text, in_quotes(value_text->text) + " is not one of the choices",
        suggestion(value_text->text, {f.choices.begin(), f.choices.end()}, "choices"));
  return std::nullopt;
}

std::optional<double> MappingReader::quantity(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(is_quantity(f.type) || f.type == Type::at_count);
  const auto value_text = written(key);
  if (!value_text) return std::nullopt;
  const bool instant = f.type == Type::at_count;
  if (const auto bare = parse_number(value_text->text); f.bare && bare) {
    return in_range(*value_text, f, *bare, base_unit(dimension_of(f.type)));
  }
  const ParsedQuantity parsed =
      instant ? parse_at_count(value_text->text) : parse_quantity(value_text->text, dimension_of(f.type));
  if (!parsed.value) {
    error(*value_text, parsed.text, parsed.hint);
    return std::nullopt;
  }
  return in_range(*value_text, f, *parsed.value, instant ? "" : base_unit(dimension_of(f.type)));
}

std::optional<Point> MappingReader::point_of(const TextNode& node, const std::string& where, const Field& f) {
  constexpr const char* kHint =
      "write for example [-20 m, 10 m]: to stage left of the centre line, upstage of the edge";
  if (node.kind != TextNode::Kind::sequence || node.items.size() != 2) {
    const bool list = node.kind == TextNode::Kind::sequence;
    error(reading_->at(node), where,
          (list ? "a list of " + std::to_string(node.items.size()) : std::string(found(node))) +
              " stands where a place [x, y] belongs",
          kHint);
    return std::nullopt;
  }
  std::array<double, 2> metres{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto value_text = scalar_of(*node.items[i], element(where, i), reading_->at(*node.items[i]));
    if (!value_text) return std::nullopt;
    const ParsedQuantity parsed = parse_quantity(value_text->text, Dimension::length);
    if (!parsed.value) {
      error(*value_text, parsed.text, parsed.hint);
      return std::nullopt;
    }
    const auto value = in_range(*value_text, f, *parsed.value, base_unit(Dimension::length));
    if (!value) return std::nullopt;
    metres[i] = *value;
  }
  return Point{metres[0], metres[1]};
}

std::optional<Point> MappingReader::point(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::point && !f.list);
  const TextEntry* e = entry(key);
  return e == nullptr ? std::nullopt : point_of(*e->value, path(key), f);
}

std::vector<Point> MappingReader::points_of(std::string_view key, const Field& f) {
  const TextEntry* e = entry(key);
  if (e == nullptr) return {};
  std::vector<Point> out;
  if (e->value->kind != TextNode::Kind::sequence) {
    error(key, std::string(found(*e->value)) + " stands where a list of places belongs",
          "write for example [[-20 m, 10 m], [20 m, 10 m]]");
    return out;
  }
  if (f.required && f.list && e->value->items.empty()) error(key, "the list is empty", "at least one is needed");
  for (std::size_t i = 0; i < e->value->items.size(); ++i) {
    if (const auto one = point_of(*e->value->items[i], element(path(key), i), f)) out.push_back(*one);
  }
  return out;
}

std::vector<Point> MappingReader::points(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::point && f.list);
  return points_of(key, f);
}

std::vector<Point> MappingReader::polygon(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::polygon);
  std::vector<Point> out = points_of(key, f);
  const TextEntry* e = entry(key);
  const bool whole = e != nullptr && e->value->kind == TextNode::Kind::sequence && e->value->items.size() == out.size();
  if (!whole) return {};
  if (out.size() >= 3) return out;
  error(key, "a polygon has three corners or more, and this has " + std::to_string(out.size()),
        "write for example [[0 m, 2 m], [4 m, 2 m], [2 m, 5 m]]");
  return {};
}

std::vector<MappingReader::Item> MappingReader::items_of(std::string_view key, bool scalars, bool mappings_too) {
  const Field& f = field(key);
  FL_CHECK(f.list);
  const TextEntry* e = entry(key);
  if (e == nullptr) return {};
  std::vector<Item> out;
  const auto take = [&](const std::shared_ptr<const TextNode>& node, const std::string& where) {
    if (mappings_too && node->kind == TextNode::Kind::mapping) {
      out.push_back({std::nullopt, MappingReader(*reading_, node, where, reading_->at(*node), *f.listing)});
    } else if (scalars) {
      if (auto value_text = scalar_of(*node, where, reading_->at(*node))) out.push_back({std::move(value_text), {}});
    } else {
      error(reading_->at(*node), where, std::string(found(*node)) + " stands where a mapping belongs",
            suggestion("", keys_of(*f.listing), "keys"));
    }
  };
  if (e->value->kind == TextNode::Kind::sequence) {
    if (f.required && e->value->items.empty()) error(key, "the list is empty", "at least one is needed");
    for (std::size_t i = 0; i < e->value->items.size(); ++i) take(e->value->items[i], element(path(key), i));
  } else if (scalars && e->value->kind == TextNode::Kind::scalar) {
    take(e->value, path(key));
  } else {
    error(key, std::string(found(*e->value)) + " stands where a list belongs",
          "write [...] or lines that begin with -");
  }
  return out;
}

std::vector<Written> MappingReader::list(std::string_view key) {
  std::vector<Written> out;
  for (Item& item : items_of(key, true, false)) out.push_back(std::move(*item.scalar));
  return out;
}

std::vector<MappingReader> MappingReader::mappings(std::string_view key) {
  std::vector<MappingReader> out;
  for (Item& item : items_of(key, false, true)) out.push_back(std::move(*item.mapping));
  return out;
}

std::vector<MappingReader::Item> MappingReader::items(std::string_view key) { return items_of(key, true, true); }

std::optional<MappingReader> MappingReader::mapping(std::string_view key) {
  const Field& f = field(key);
  FL_CHECK(f.type == Type::mapping && !f.list);
  const TextEntry* e = entry(key);
  if (e == nullptr) {
    if (f.required) return std::nullopt;
    return MappingReader(*reading_, std::make_shared<TextNode>(), path(key), key_position_, *f.listing);
  }
  if (e->value->kind == TextNode::Kind::mapping) {
    return MappingReader(*reading_, e->value, path(key), key_position(key), *f.listing);
  }
  error(key, std::string(found(*e->value)) + " stands where a mapping belongs",
        suggestion("", keys_of(*f.listing), "keys"));
  return std::nullopt;
}

std::optional<MappingReader> read_root(Reading& reading, std::string_view bytes, const Listing& listing) {
  const auto root = parse_text_tree(bytes, reading.file, reading.diagnostics);
  if (!root) return std::nullopt;
  if (root->kind != TextNode::Kind::mapping) {
    reading.diagnostics.error(reading.at(*root), "",
                              std::string(found(*root)) + " stands where the keys of the file belong",
                              suggestion("", keys_of(listing), "keys"));
    return std::nullopt;
  }
  return MappingReader(reading, root, "", {reading.file, 1, 1}, listing);
}

}  // namespace footlight::config
