// SPDX-License-Identifier: Apache-2.0
#include "app/natural_order.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace footlight::app {
namespace {

TEST(NaturalOrder, NumbersCountAsNumbers) {
  std::vector<std::string> names{"D10", "D2", "D1", "E1", "D", "10", "9", "007", "7", "D2b", "D2a", "D02"};
  std::ranges::sort(names, natural_less);
  EXPECT_EQ(names,
            (std::vector<std::string>{"7", "007", "9", "10", "D", "D1", "D2", "D02", "D2a", "D2b", "D10", "E1"}));
}

TEST(NaturalOrder, IsAStrictWeakOrderThatOnlyEqualNamesEscape) {
  EXPECT_TRUE(rc::check([] {
    const auto name = rc::gen::container<std::string>(rc::gen::elementOf(std::string("01a9b")));
    const std::string a = *name;
    const std::string b = *name;
    const std::string c = *name;
    RC_ASSERT(!natural_less(a, a));
    RC_ASSERT((a == b) == (!natural_less(a, b) && !natural_less(b, a)));
    if (natural_less(a, b) && natural_less(b, c)) RC_ASSERT(natural_less(a, c));
  }));
}

}  // namespace
}  // namespace footlight::app
