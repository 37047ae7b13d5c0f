// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::test {

/// What `footlight new` makes, in a folder of the test's own, to be harmed by it.
class StarterShow : public ::testing::Test {
 protected:
  using Names = std::vector<std::string>;

  StarterShow() {
    const Ran made = footlight({"new", folder_ / "s", "--title", "Twelve"});
    EXPECT_EQ(made.status, 0) << made.err;
    as_made_ = files();
  }
  /// Every `from` must be there: a test of a text that has changed would show nothing.
  void replace(const std::string& from, const std::string& to) {
    std::string text = folder_.read("s/show.yaml");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    folder_.write("s/show.yaml", text.replace(at, from.size(), to));
  }
  /// The ring must be reached one count after the line.
  void make_unwalkable() { replace("start: count 25", "start: count 10"); }
  [[nodiscard]] Names files() const {
    Names out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "s")) {
      out.push_back(entry.path().filename().string());
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  TemporaryFolder folder_;
  std::string show_ = folder_ / "s/show.yaml";
  std::string plan_ = folder_ / "s/show.plan";
  Names as_made_;
};

/// The same, planned already.
class PlannedStarterShow : public StarterShow {
 protected:
  PlannedStarterShow() { plan(); }
  void plan() {
    EXPECT_EQ(footlight({"plan", show_, "-q"}).status, 0);
    made_ = files();
  }
  /// Nothing else than before is beside the show.
  void expect_no_half_file() const { EXPECT_EQ(files(), made_); }

 private:
  Names made_;
};

}  // namespace footlight::test
