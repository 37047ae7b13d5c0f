// SPDX-License-Identifier: Apache-2.0
#include "app/console/access.hpp"

#include <filesystem>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

class ConsoleToken : public ::testing::Test {
 protected:
  [[nodiscard]] std::string message() const {
    const auto token = token_in(folder_ / "console.token");
    return token ? "taken" : token.error().message;
  }
  [[nodiscard]] std::string refusal(const std::string& why) const {
    return "console token " + (folder_ / "console.token") + ": " + why;
  }
  /// @param mode of the file
  void write(const std::string& text, std::filesystem::perms mode = std::filesystem::perms(0600)) const {
    std::filesystem::permissions(folder_.write("console.token", text), mode);
  }

  test::TemporaryFolder folder_;
};

TEST_F(ConsoleToken, IsMadeOnceOf256RandomBitsThatNobodyElseMayRead) {
  const auto token = token_in(folder_ / "console.token");
  ASSERT_TRUE(token) << token.error().message;
  EXPECT_EQ(token->size(), 64U);
  EXPECT_EQ(token->find_first_not_of("0123456789abcdef"), std::string::npos);
  struct stat status {};
  ASSERT_EQ(::stat((folder_ / "console.token").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  const auto again = token_in(folder_ / "console.token");
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, *token);
  const auto other = token_in(folder_ / "other.token");
  ASSERT_TRUE(other);
  EXPECT_NE(*other, *token);
}

TEST_F(ConsoleToken, ThatOthersMayReadIsRefused) {
  write(std::string(64, 'a') + "\n", std::filesystem::perms(0640));
  EXPECT_EQ(message(), refusal("others may read it (mode 640); chmod 600 it, or remove it for a new one"));
}

TEST_F(ConsoleToken, ThatIsTooShortOrNoTextIsRefused) {
  const std::string why = "holds no token: 32 to 256 characters from ! to ~; remove it for a new one";
  for (const std::string& text : {std::string(), std::string("secret\n"), std::string(31, 'a'), std::string(257, 'a'),
                                  std::string(40, 'a') + " b", std::string(40, '\x01')}) {
    write(text);
    EXPECT_EQ(message(), refusal(why)) << text;
  }
  write(std::string(32, 'a') + "\n");
  EXPECT_EQ(message(), "taken");
}

TEST_F(ConsoleToken, IsNoLinkAndNoFolder) {
  folder_.write("elsewhere", std::string(64, 'a'));
  std::filesystem::create_symlink(folder_ / "elsewhere", folder_ / "console.token");
  EXPECT_EQ(message(), refusal("Too many levels of symbolic links"));
  std::filesystem::remove(folder_ / "console.token");
  std::filesystem::create_directory(folder_ / "console.token");
  EXPECT_EQ(message(), refusal("is no file"));
}

TEST(ConsolePairing, GivesATokenOfTheCodesRoleOnce) {
  Pairing pairing;
  const std::string code = pairing.make(Role::operate, kStart);
  EXPECT_EQ(code.size(), 8U);
  EXPECT_EQ(code.find_first_not_of("0123456789"), std::string::npos);
  const auto paired = pairing.redeem(code, instant_at(1));
  ASSERT_TRUE(paired);
  EXPECT_EQ(paired->role, Role::operate);
  EXPECT_EQ(paired->token.size(), 64U);
  EXPECT_EQ(pairing.role_of(paired->token), Role::operate);
  EXPECT_FALSE(pairing.redeem(code, instant_at(1))) << "it is used up";
  EXPECT_FALSE(pairing.role_of(""));
  EXPECT_FALSE(pairing.role_of(std::string(64, '0')));
}

TEST(ConsolePairing, CodesEndAfterTwoMinutesAndAfterFiveWrongTries) {
  Pairing pairing;
  std::string code = pairing.make(Role::view, kStart);
  EXPECT_FALSE(pairing.redeem(code, instant_at(120)));
  code = pairing.make(Role::view, instant_at(200));
  const std::string wrong = code == "00000000" ? "00000001" : "00000000";
  for (int i = 0; i < Pairing::kWrongTries - 1; ++i) EXPECT_FALSE(pairing.redeem(wrong, instant_at(201)));
  EXPECT_TRUE(pairing.redeem(code, instant_at(202))) << "four wrong tries do no harm";
  code = pairing.make(Role::view, instant_at(203));
  for (int i = 0; i < Pairing::kWrongTries; ++i) EXPECT_FALSE(pairing.redeem(wrong + "x", instant_at(204)));
  EXPECT_FALSE(pairing.redeem(code, instant_at(205))) << "after five it is not good any more";
}

TEST(ConsolePairing, CodesDifferAndTheOldestGoes) {
  Pairing pairing;
  const std::string first = pairing.make(Role::view, kStart);
  std::set<std::string> codes;
  for (std::size_t i = 0; i < Pairing::kMostCodes; ++i) codes.insert(pairing.make(Role::view, kStart));
  EXPECT_GT(codes.size(), Pairing::kMostCodes - 2);
  EXPECT_FALSE(pairing.redeem(first, instant_at(1)));
  EXPECT_TRUE(pairing.redeem(*codes.begin(), instant_at(1)));
}

}  // namespace
}  // namespace footlight::app
