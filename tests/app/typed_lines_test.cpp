// SPDX-License-Identifier: Apache-2.0
#include "app/typed_lines.hpp"

#include <array>
#include <string>
#include <utility>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Typed : public testing::Test {
 protected:
  Typed() { EXPECT_EQ(::pipe(ends_.data()), 0); }
  ~Typed() override {
    ::close(ends_[0]);
    if (ends_[1] >= 0) ::close(ends_[1]);
  }
  void type(const std::string& text) {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close() { ::close(std::exchange(ends_[1], -1)); }

  std::array<int, 2> ends_{};
};

TEST_F(Typed, LinesComeOneByOneAndOnlyWhole) {
  TypedLines typed{StandardInput(ends_[0])};
  type("one\n\nthr");
  const auto nobody = [] { return false; };
  EXPECT_EQ(typed.next(nobody), "one");
  EXPECT_EQ(typed.next(nobody), "");
  EXPECT_EQ(typed.next(nobody), std::nullopt) << "the waiting was ended";
  EXPECT_FALSE(typed.closed());
  EXPECT_EQ(typed.next([&] {
    type("ee\nrest");
    return true;
  }),
            "three");
  close();
  EXPECT_EQ(typed.next([] { return true; }), std::nullopt);
  EXPECT_TRUE(typed.closed());
}

TEST_F(Typed, AFloodWithoutAnEndLeavesTimeForOtherThingsAndIsNotKept) {
  const int zeros = ::open("/dev/zero", O_RDONLY | O_CLOEXEC);
  TypedLines typed{StandardInput(zeros)};
  int looks = 0;
  EXPECT_EQ(typed.next([&] { return ++looks < 100; }), std::nullopt);
  EXPECT_EQ(looks, 100);
  EXPECT_FALSE(typed.closed());
  ::close(zeros);
  StandardInput input(ends_[0]);
  type(std::string(10'000, 'x') + "\nshort\n");
  std::vector<std::string> lines;
  for (int look = 0; look < 20; ++look) {
    for (std::string& line : input.lines()) lines.push_back(std::move(line));
  }
  EXPECT_THAT(lines, ElementsAre(std::string(4096, 'x'), "short"));
}

TEST_F(Typed, WhoIsNotListenedToIsClosed) {
  StandardInput nobody(-1);
  EXPECT_TRUE(nobody.closed());
  EXPECT_THAT(nobody.take(), IsEmpty());
  nobody.wait(milliseconds(1));
}

}  // namespace
}  // namespace footlight::app
