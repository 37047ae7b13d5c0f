// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/result.hpp"

namespace footlight::config {

struct TextNode;
using TextNodes = std::vector<std::shared_ptr<const TextNode>>;

/// One key of a mapping with its place; line and column count from 1, columns in code points.
struct TextEntry {
  std::string key;
  int line = 0;
  int column = 0;
  std::shared_ptr<const TextNode> value;
};

/// A node of a YAML document: text as written, nothing converted yet.
struct TextNode {
  enum class Kind { null, scalar, sequence, mapping };
  Kind kind = Kind::null;
  bool quoted = false;  ///< scalar in quotes or as a block: certainly meant as text
  int line = 0;
  int column = 0;
  std::string text;                ///< scalar
  TextNodes items;                 ///< sequence
  std::vector<TextEntry> entries;  ///< mapping, in the order of the file, keys unique
};

/// What a file may cost at most; more is refused with the place where the bound was passed.
struct TextLimits {
  std::size_t max_bytes = std::size_t{1} << 20U;
  std::size_t max_flow_bytes = std::size_t{256} << 10U;  ///< of one [...] or {...} with all that is inside
  std::size_t max_nodes = 200'000;                       ///< aliases count as often as they are used
  int max_depth = 24;
};

/// Parses one YAML document. Keys that stand twice are reported and the first is kept; anything else that is wrong with
/// the text ends the reading with one more error. Aliases share their node; their expansion counts towards the limits
/// before anybody walks it, and an alias inside its own anchor is refused.
/// @param file name for messages
/// @return the root, or nothing when an error was added
[[nodiscard]] std::shared_ptr<const TextNode> parse_text_tree(std::string_view bytes, const std::string& file,
                                                              Diagnostics& diagnostics, const TextLimits& limits = {});

/// The bytes of a regular file of at most `max_bytes`; larger files are refused unread. The message names the file.
[[nodiscard]] Result<std::string> read_bounded(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace footlight::config
