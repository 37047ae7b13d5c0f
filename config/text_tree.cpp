// SPDX-License-Identifier: Apache-2.0
#include "config/text_tree.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "config/text_scan.hpp"

namespace footlight::config {
namespace {

/// Ends the parser's run; never leaves this file.
struct Refusal {
  YAML::Mark mark;
  std::string text;
  std::string hint;
};

/// Builds the tree from the parser's events, so that no alias is ever followed and every limit holds while it is read.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const LineIndex& lines, const std::string& file, Diagnostics& diagnostics, const TextLimits& limits)
      : lines_(lines), file_(file), diagnostics_(diagnostics), limits_(limits) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (!open_.empty() && wants_key())
      throw Refusal{mark, "a key is missing before the colon", "a key is a plain word"};
    leaf(make(mark, TextNode::Kind::null), anchor, mark);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      throw Refusal{mark, "this alias stands inside of what it repeats", "an alias cannot contain itself"};
    }
    if (!open_.empty() && wants_key())
      throw Refusal{mark, "an alias stands where a key belongs", "write the key itself"};
    count(found->second.nodes, mark);
    attach(found->second.node, found->second.nodes, mark);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(tag, mark);
    if (!open_.empty() && wants_key()) {
      if (anchor != 0) throw Refusal{mark, "a key carries an anchor", "anchors belong to values"};
      return take_key(value, mark);
    }
    auto node = make(mark, TextNode::Kind::scalar);
    node->text = value;
    node->quoted = tag == "!";
    leaf(std::move(node), anchor, mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    refuse_tag(tag, mark);
    open(make(mark, TextNode::Kind::sequence), anchor, mark);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    refuse_tag(tag, mark);
    open(make(mark, TextNode::Kind::mapping), anchor, mark);
  }
  void OnMapEnd() override { close(); }

  [[nodiscard]] std::shared_ptr<const TextNode> root() const { return root_; }

 private:
  struct Open {
    std::shared_ptr<TextNode> node;
    YAML::anchor_t anchor = 0;
    std::size_t nodes = 1;
    YAML::Mark mark;
    std::optional<TextEntry> key;     // mapping: read, its value is awaited
    bool key_twice = false;           // its value is read and dropped
    std::map<std::string, int> seen;  // mapping: key -> line
  };
  struct Anchored {
    std::shared_ptr<const TextNode> node;
    std::size_t nodes = 1;
  };

  std::shared_ptr<TextNode> make(const YAML::Mark& mark, TextNode::Kind kind) const {
    auto node = std::make_shared<TextNode>();
    const LineIndex::Place place = lines_.place(mark.line, mark.column);
    node->kind = kind;
    node->line = place.line;
    node->column = place.column;
    return node;
  }

  [[nodiscard]] bool wants_key() const {
    return open_.back().node->kind == TextNode::Kind::mapping && !open_.back().key;
  }

  static void refuse_tag(const std::string& tag, const YAML::Mark& mark) {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Refusal{mark, "the tag " + tag + " has no meaning here", "leave it out"};
  }

  void count(std::size_t nodes, const YAML::Mark& mark) {
    count_ += nodes;
    if (count_ > limits_.max_nodes) {
      throw Refusal{mark, "the file has more than " + std::to_string(limits_.max_nodes) + " values, aliases expanded",
                    "long data belong in CSV files"};
    }
  }

  void take_key(const std::string& key, const YAML::Mark& mark) {
    Open& top = open_.back();
    const LineIndex::Place place = lines_.place(mark.line, mark.column);
    count(1, mark);
    top.key = TextEntry{key, place.line, place.column, nullptr};
    const auto [first, is_new] = top.seen.emplace(key, place.line);
    top.key_twice = !is_new;
    if (!is_new) {
      diagnostics_.error({file_, place.line, place.column}, path_to(key), "the key stands here for the second time",
                         "first in line " + std::to_string(first->second) + "; keep one of the two");
    }
  }

  [[nodiscard]] std::string path_to(const std::string& key) const {
    std::string path;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const Open& level = open_[i];
      if (level.node->kind == TextNode::Kind::sequence) {
        path += "[" + std::to_string(level.node->items.size()) + "]";
      } else {
        path += (path.empty() ? "" : ".") + level.key->key;
      }
    }
    return path.empty() ? key : path + "." + key;
  }

  void leaf(std::shared_ptr<TextNode> node, YAML::anchor_t anchor, const YAML::Mark& mark) {
    count(1, mark);
    if (anchor != 0) anchors_[anchor] = {node, 1};
    attach(std::move(node), 1, mark);
  }

  void open(std::shared_ptr<TextNode> node, YAML::anchor_t anchor, const YAML::Mark& mark) {
    if (!open_.empty() && wants_key())
      throw Refusal{mark, "a list or mapping stands where a key belongs", "a key is a plain word"};
    if (static_cast<int>(open_.size()) >= limits_.max_depth) {
      throw Refusal{mark, "lists and mappings are nested too deep",
                    "at most " + std::to_string(limits_.max_depth) + " levels"};
    }
    count(1, mark);
    open_.push_back({std::move(node), anchor, 1, mark, {}, false, {}});
  }

  void close() {
    Open top = std::move(open_.back());
    open_.pop_back();
    if (top.anchor != 0) anchors_[top.anchor] = {top.node, top.nodes};
    attach(std::move(top.node), top.nodes, top.mark);
  }

  void attach(std::shared_ptr<const TextNode> node, std::size_t nodes, const YAML::Mark&) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    parent.nodes += nodes;
    if (parent.node->kind == TextNode::Kind::sequence) {
      parent.node->items.push_back(std::move(node));
      return;
    }
    if (!parent.key_twice) {
      parent.key->value = std::move(node);
      parent.node->entries.push_back(std::move(*parent.key));
    }
    parent.key.reset();
  }

  const LineIndex& lines_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  const TextLimits& limits_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  std::shared_ptr<const TextNode> root_;
  std::size_t count_ = 0;
};

/// Runs the parser over exactly one document. Throws Refusal or what yaml-cpp throws.
std::shared_ptr<const TextNode> run_parser(std::string_view bytes, TreeBuilder& builder) {
  std::istringstream stream{std::string(bytes)};
  YAML::Parser parser(stream);
  if (!parser.HandleNextDocument(builder)) return nullptr;
  const auto root = builder.root();
  if (parser.HandleNextDocument(builder)) {
    throw Refusal{YAML::Mark::null_mark(), "the file has more than one document", "remove what follows the second ---"};
  }
  return root;
}

}  // namespace

std::shared_ptr<const TextNode> parse_text_tree(std::string_view bytes, const std::string& file,
                                                Diagnostics& diagnostics, const TextLimits& limits) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);  // a byte order mark takes no column
  const LineIndex lines(bytes);
  const auto add = [&](LineIndex::Place place, std::string text, std::string hint) {
    diagnostics.error({file, place.line, place.column}, "", std::move(text), std::move(hint));
    return nullptr;
  };
  if (const auto findings = scan_text(bytes, limits); !findings.empty()) {
    return add(lines.place_of(findings.front().offset), findings.front().text, findings.front().hint);
  }
  TreeBuilder builder(lines, file, diagnostics, limits);
  try {
    auto root = run_parser(bytes, builder);
    if (!root)
      diagnostics.error({file, 0, 0}, "", "the file is empty", "docs/show-file.md has an example to begin with");
    return root;
  } catch (const Refusal& refusal) {
    return add(lines.place(refusal.mark.line, refusal.mark.column), refusal.text, refusal.hint);
  } catch (const YAML::Exception& error) {
    return add(lines.place(error.mark.line, error.mark.column), "this is not YAML: " + error.msg,
               "look for a missing space, quote or bracket at or before this place");
  }
}

Result<std::string> read_bounded(const std::filesystem::path& file, std::size_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return input_error("the file \"" + file.string() + "\" is missing");
  if (!std::filesystem::is_regular_file(status)) return input_error("\"" + file.string() + "\" is not a file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) return input_error("the file \"" + file.string() + "\" cannot be read: " + error.message());
  if (size > max_bytes) {
    return input_error("the file \"" + file.string() + "\" has " + std::to_string(size) + " bytes, more than " +
                       std::to_string(max_bytes));
  }
  std::ifstream in(file, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in || in.gcount() != static_cast<std::streamsize>(size)) {
    return input_error("the file \"" + file.string() + "\" cannot be read");
  }
  return bytes;
}

}  // namespace footlight::config
