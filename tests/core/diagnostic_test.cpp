// SPDX-License-Identifier: Apache-2.0
#include "core/diagnostic.hpp"

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(DiagnosticText, HasPlaceKeyTextAndHint) {
  EXPECT_EQ(
      to_text(Diagnostic{Severity::error, {"show.yaml", 3, 14}, "stage.grid.pitch", "a length is missing", "as 1 m"}),
      "show.yaml:3:14: error: stage.grid.pitch: a length is missing (as 1 m)");
}

TEST(DiagnosticText, LeavesOutWhatIsEmpty) {
  EXPECT_EQ(to_text(Diagnostic{Severity::error, {"show.yaml", 0, 0}, "", "is empty", ""}),
            "show.yaml: error: is empty");
  EXPECT_EQ(to_text(Diagnostic{Severity::warning, {}, "", "no rig", ""}), "warning: no rig");
  EXPECT_EQ(to_text(Diagnostic{Severity::note, {"a", 1, 1}, "", "first here", ""}), "a:1:1: note: first here");
}

TEST(Diagnostics, AreSortedByPlaceThenByArrival) {
  Diagnostics list;
  list.error({"show.yaml", 10, 1}, "c", "third");
  list.warning({"show.yaml", 2, 9}, "b", "second");
  list.error({"show.yaml", 2, 3}, "a", "first", "hint");
  list.error({"show.yaml", 10, 1}, "d", "fourth");
  list.error({"rig.yaml", 99, 1}, "", "before them all");
  EXPECT_EQ(list.to_text(),
            "rig.yaml:99:1: error: before them all\n"
            "show.yaml:2:3: error: a: first (hint)\n"
            "show.yaml:2:9: warning: b: second\n"
            "show.yaml:10:1: error: c: third\n"
            "show.yaml:10:1: error: d: fourth\n");
}

TEST(Diagnostics, WarningsAreNoErrors) {
  Diagnostics list;
  EXPECT_TRUE(list.empty());
  EXPECT_FALSE(list.has_errors());
  list.warning({}, "", "careful");
  EXPECT_FALSE(list.empty());
  EXPECT_FALSE(list.has_errors());
  list.error({}, "", "wrong");
  EXPECT_TRUE(list.has_errors());
}

}  // namespace
}  // namespace footlight
