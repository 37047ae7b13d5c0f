// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "config/show_file.hpp"
#include "config/starter_show.hpp"
#include "core/rng.hpp"
#include "tests/config/show_folder.hpp"
#include "tests/support/full.hpp"
#include "tests/support/mutated.hpp"

namespace footlight::config {
namespace {

/// A show with every construct, whose bytes are then harmed.
std::string whole_show() {
  return R"(# comment
footlight: 1
title: "Everything: ä"
stage: &stage
  grid: {kind: hexagonal, columns: 12, rows: 8, pitch: 80 cm}
  blocked: [L8]
  clearance: 2 ft
performers: {count: 12, groups: [{name: odd, members: [1-3, 5], colour: "#7CFC00"}]}
music: {meter: 3/4, changes: [{at: count 1, tempo: 90}, {at: count 31, tempo: 60}]}
sections:
  - name: 'line'
    from: {cells: line.csv}
    start: count 1
    hold: &hold 8 counts
  - {name: ring, from: {cells: ring.csv}, start: count 25, hold: *hold}
cues:
  - {number: "1", section: line, continue: auto-follow, notes: "a\tb"}
  - number: "2.5"
    section: ring
    notes: |
      several
      lines [with {brackets
looks: {here: {colour: "#FFFFFF", effect: pulse}}
rig: rig.yaml
)";
}

constexpr const char* kRig =
    "rig: 1\nbuses: [{name: a, url: \"sim://rtu\", profile: footlight-marker}, {name: b, url: \"sim://can\"}]\n"
    "nodes: [{bus: a, address: 4, channels: [A1:D4]}]\nfloor: {buses: [a, b]}\n";

class HostileShow : public testing::Test {
 protected:
  void SetUp() override {
    for (const auto& [name, content] : starter_show("x")) folder_.write(name, content);
    folder_.write("rig.yaml", kRig);
    folder_.write("show.yaml", whole_show());
    ASSERT_TRUE(load_show(folder_.path("show.yaml"))) << load_show(folder_.path("show.yaml")).error().to_text();
  }
  /// Any answer is right but a crash, and an error says where it is.
  void survive(const std::string& file, const std::string& content) const {
    folder_.write(file, content);
    const auto result = load_show(folder_.path("show.yaml"));
    if (!result) {
      EXPECT_FALSE(result.error().sorted().empty()) << content;
      EXPECT_FALSE(result.error().sorted().front().position.file.empty()) << content;
    }
  }
  static std::string mutated(std::string text, Rng rng) {
    return test::mutated(std::move(text), rng, "[]{}:,-?&*!|>'\"%@`#\n\t 0a\\~<=\r\xC3\x80");
  }

  ShowFolder folder_;
};

TEST_F(HostileShow, TruncationsAreSurvived) {
  const std::string show = whole_show();
  const std::size_t step = test::tries<std::size_t>(7, 1);
  for (std::size_t length = 0; length < show.size(); length += step) survive("show.yaml", show.substr(0, length));
}

TEST_F(HostileShow, MutationsAreSurvived) {
  const std::string show = whole_show();
  const std::uint64_t seeds = test::tries<std::uint64_t>(300, 30'000);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) survive("show.yaml", mutated(show, Rng(seed)));
}

TEST_F(HostileShow, MutationsOfRigAndCsvAreSurvived) {
  std::ostringstream csv;
  csv << std::ifstream(folder_.path("line.csv")).rdbuf();
  const std::uint64_t seeds = test::tries<std::uint64_t>(60, 5'000);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    survive("rig.yaml", mutated(kRig, Rng(seed)));
    folder_.write("rig.yaml", kRig);
    survive("line.csv", mutated(csv.str(), Rng(seed)));
    folder_.write("line.csv", csv.str());
  }
}

/// Bytes of nearly 1 MiB made to be slow or large: each is answered, and quickly (seen when the suite's time is).
TEST_F(HostileShow, LargeAndStrangeFilesAreAnswered) {
  constexpr std::size_t kSize = 1'000'000;
  const auto repeated = [&](std::string_view unit, std::string text = "") {
    while (text.size() + unit.size() < kSize) text += unit;
    return text;
  };
  const std::vector<std::string> hostile{
      repeated("["),
      repeated("{"),
      repeated("- "),
      repeated("? "),
      repeated("a: "),
      repeated("&a "),
      repeated("!x "),
      repeated("&a [", "x: "),
      repeated("*a "),
      repeated("\""),
      repeated("'"),
      repeated("%"),
      repeated("|\n"),
      repeated("- - "),
      repeated("\n"),
      repeated("#"),
      repeated("-\n"),
      repeated("a\n"),
      repeated(" "),
      repeated("---\n"),
      repeated("- a\n"),
      repeated("\\", "\""),
      repeated("[a,", ""),
      repeated(":\n"),
      repeated("a: b\n"),
      repeated("!<", ""),
      repeated("&a [*a, ", "x: "),
      repeated("blocked: [A1:L8]\n", "stage:\n"),
      repeated("\"A1:L8\",", "footlight: 1\ntitle: t\nstage: {grid: {columns: 4, rows: 3}, blocked: [")};
  for (const std::string& text : hostile) {
    folder_.write("show.yaml", text);
    const auto result = load_show(folder_.path("show.yaml"));
    EXPECT_FALSE(result) << text.substr(0, 20);
  }
}

}  // namespace
}  // namespace footlight::config
