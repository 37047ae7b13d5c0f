// SPDX-License-Identifier: Apache-2.0
#include "config/text_tree.hpp"

#include <gtest/gtest.h>

#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

std::shared_ptr<const TextNode> parse(std::string_view text, Diagnostics& diagnostics) {
  return parse_text_tree(text, "f.yaml", diagnostics);
}

/// All messages for a text that is refused.
std::string refused(std::string_view text) {
  Diagnostics diagnostics;
  EXPECT_EQ(parse(text, diagnostics), nullptr);
  return diagnostics.to_text();
}

TEST(TextTree, KeepsTextAndPlacesFromOne) {
  Diagnostics diagnostics;
  const auto root = parse("a: 1\nb:\n  - \"x\"\n  - {c: y}\n", diagnostics);
  ASSERT_NE(root, nullptr) << diagnostics.to_text();
  ASSERT_EQ(root->entries.size(), 2U);
  EXPECT_EQ(root->entries[0].value->text, "1");
  EXPECT_FALSE(root->entries[0].value->quoted);
  EXPECT_EQ(root->entries[0].value->line, 1);
  EXPECT_EQ(root->entries[0].value->column, 4);
  EXPECT_EQ(root->entries[1].line, 2);
  const TextNode& list = *root->entries[1].value;
  ASSERT_EQ(list.items.size(), 2U);
  EXPECT_TRUE(list.items[0]->quoted);
  EXPECT_EQ(list.items[0]->line, 3);
  EXPECT_EQ(list.items[0]->column, 5);
  EXPECT_EQ(list.items[1]->entries[0].value->column, 9);
}

TEST(TextTree, CountsColumnsInCodePoints) {
  Diagnostics diagnostics;
  const auto root = parse("{ä: 舞台, c: d}\n", diagnostics);
  ASSERT_NE(root, nullptr) << diagnostics.to_text();
  EXPECT_EQ(root->entries[1].column, 9);
  EXPECT_EQ(root->entries[1].value->column, 12);
}

TEST(TextTree, LeavesAByteOrderMarkOutOfTheColumns) {
  Diagnostics diagnostics;
  const auto root = parse(
      "\xEF\xBB\xBF"
      "a: 1\n",
      diagnostics);
  ASSERT_NE(root, nullptr) << diagnostics.to_text();
  EXPECT_EQ(root->entries[0].column, 1);
}

TEST(TextTree, ReportsEveryKeyThatStandsTwiceAndKeepsTheFirst) {
  Diagnostics diagnostics;
  const auto root = parse("a: 1\ns:\n  - {b: 1, b: 2}\na: 3\n", diagnostics);
  ASSERT_NE(root, nullptr);
  EXPECT_EQ(root->entries[0].value->text, "1");
  EXPECT_EQ(
      diagnostics.to_text(),
      "f.yaml:3:12: error: s[0].b: the key stands here for the second time (first in line 3; keep one of the two)\n"
      "f.yaml:4:1: error: a: the key stands here for the second time (first in line 1; keep one of the two)\n");
}

TEST(TextTree, SharesWhatAnAliasRepeats) {
  Diagnostics diagnostics;
  const auto root = parse("a: &x {b: 1}\nc: *x\n", diagnostics);
  ASSERT_NE(root, nullptr) << diagnostics.to_text();
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
}

TEST(TextTree, RefusesAnAliasInsideOfItsOwnAnchor) {
  EXPECT_EQ(refused("a: &x [*x]\n"),
            "f.yaml:1:8: error: this alias stands inside of what it repeats (an alias cannot contain itself)\n");
}

TEST(TextTree, RefusesAnAliasBombWithoutExpandingIt) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int level = 1; level < 12; ++level) {
    const std::string before = "*a" + std::to_string(level - 1);
    bomb += "a" + std::to_string(level) + ": &a" + std::to_string(level) + " [";
    for (int k = 0; k < 10; ++k) bomb += (k == 0 ? "" : ", ") + before;
    bomb += "]\n";
  }
  EXPECT_EQ(
      refused(bomb),
      "f.yaml:6:10: error: the file has more than 200000 values, aliases expanded (long data belong in CSV files)\n");
}

TEST(TextTree, RefusesDepthInFlowAndInBlocks) {
  EXPECT_EQ(refused("a: " + std::string(100'000, '[')),
            "f.yaml:1:28: error: lists and mappings are nested too deep (at most 24 levels and 256 KiB; long data "
            "belong in CSV files)\n");
  std::string blocks;
  for (int level = 0; level < 600; ++level) blocks += "- ";
  EXPECT_EQ(refused(blocks + "x\n"),
            "f.yaml:1:49: error: lists and mappings are nested too deep (at most 24 levels)\n");
}

TEST(TextTree, RefusesALongFlowCollection) {
  std::string flow = "a: [";
  while (flow.size() < 300'000) flow += "1, ";
  EXPECT_EQ(refused(flow + "1]\n"),
            "f.yaml:1:262148: error: a [...] or {...} is too long (at most 24 levels and 256 KiB; long data belong in "
            "CSV files)\n");
}

TEST(TextTree, RefusesBytesThatAreNoText) {
  EXPECT_EQ(refused(std::string_view("a: b\0c\n", 7)), "f.yaml:1:5: error: a NUL byte (a show file is UTF-8 text)\n");
  EXPECT_EQ(refused("a: \x07\n"), "f.yaml:1:4: error: the control character 0x07 (a show file is UTF-8 text)\n");
  EXPECT_EQ(refused("a: b\nc: \xC3(\n"), "f.yaml:2:4: error: the byte 0xC3 is not UTF-8 (save the file as UTF-8)\n");
}

TEST(TextTree, RefusesWhatYamlCanButAShowCannot) {
  EXPECT_EQ(refused("a: !!python/object x\n"),
            "f.yaml:1:4: error: the tag tag:yaml.org,2002:python/object has no meaning here (leave it out)\n");
  EXPECT_EQ(refused("a: 1\n---\nb: 2\n"),
            "f.yaml:1:1: error: the file has more than one document (remove what follows the second ---)\n");
  EXPECT_EQ(refused("[a, b]: 1\n"),
            "f.yaml:1:1: error: a list or mapping stands where a key belongs (a key is a plain word)\n");
  EXPECT_EQ(refused(""), "f.yaml: error: the file is empty (docs/show-file.md has an example to begin with)\n");
}

TEST(TextTree, SaysWhereTextIsNotYaml) {
  EXPECT_EQ(refused("a: [1, 2\nb: 3\n"),
            "f.yaml:2:2: error: this is not YAML: end of sequence flow not found (look for a missing space, quote or "
            "bracket at or before this place)\n");
}

TEST(ReadBounded, RefusesWhatIsTooLargeUnread) {
  ShowFolder folder;
  folder.write("big.yaml", std::string(2000, 'x'));
  EXPECT_EQ(folder.without_folder(read_bounded(folder.path("big.yaml"), 1000).error().message),
            "the file \"big.yaml\" has 2000 bytes, more than 1000");
  EXPECT_EQ(folder.without_folder(read_bounded(folder.path("none.yaml"), 1000).error().message),
            "the file \"none.yaml\" is missing");
  EXPECT_EQ(read_bounded("/dev/zero", 1000).error().message, "\"/dev/zero\" is not a file");
  EXPECT_EQ(read_bounded(folder.path("big.yaml"), 2000).value().size(), 2000U);
}

}  // namespace
}  // namespace footlight::config
