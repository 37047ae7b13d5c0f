// SPDX-License-Identifier: Apache-2.0
#include "core/result.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace footlight {
namespace {

TEST(Result, HoldsAValue) {
  Result<std::string> result(std::string("ok"));
  ASSERT_TRUE(result);
  EXPECT_EQ(*result, "ok");
  EXPECT_EQ(result->size(), 2U);
  *result += "!";
  EXPECT_EQ(result.value(), "ok!");
}

TEST(Result, HoldsAnError) {
  const Result<int> result = input_error("no such file");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error(), (Error{ErrorKind::input, "no such file"}));
}

TEST(Result, MovesWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
  const std::unique_ptr<int> value = *std::move(result);
  EXPECT_EQ(*value, 7);
}

TEST(Result, ErrorMakersNameWhoseFaultItIs) {
  EXPECT_EQ(input_error("x").kind, ErrorKind::input);
  EXPECT_EQ(refusal("x").kind, ErrorKind::refused);
  EXPECT_EQ(device_error("x").kind, ErrorKind::device);
  EXPECT_EQ(internal_error("x").kind, ErrorKind::internal);
}

TEST(Result, SuccessMayHaveNoValue) {
  const Status<> ok = Done{};
  EXPECT_TRUE(ok.has_value());
  const Status<> bad = device_error("no answer");
  EXPECT_FALSE(bad.has_value());
}

TEST(ResultDeathTest, TheWrongSideIsAProgrammerError) {
  const Result<int> good(1);
  const Result<int> bad = input_error("x");
  EXPECT_DEATH(static_cast<void>(good.error()), "!has_value");
  EXPECT_DEATH(static_cast<void>(bad.value()), "has_value");
}

}  // namespace
}  // namespace footlight
