// SPDX-License-Identifier: Apache-2.0
#include "app/console/audit_log.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

TEST(AuditLog, ALineIsJsonInUtcAndPureAscii) {
  const AuditLine line{"Åsa\x7f", "::1", "admin", "order go\n", "said \xff", "1", "ab"};
  EXPECT_EQ(audit_text(line, Duration(1'777'663'802'125'000'000)),
            "{\"time\":\"2026-05-01T19:30:02.125Z\",\"who\":\"\\u00c5sa\\u007f\",\"from\":\"::1\",\"role\":\"admin\","
            "\"what\":\"order go\\n\",\"result\":\"said \\ufffd\",\"cue\":\"1\",\"plan\":\"ab\"}\n");
}

TEST(AuditLog, IsOnlyEverAppendedToAndNobodyElseMayReadIt) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "console.log";
  for (const char* who : {"first", "second"}) {
    auto log = AuditLog::open(file);
    ASSERT_TRUE(log) << log.error().message;
    log.value()->add({who, "", "", "", "", "", ""});
  }
  const std::string text = folder.read("console.log");
  EXPECT_LT(text.find("first"), text.find("second"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 2);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
}

TEST(AuditLog, ALinkIsNotFollowed) {
  const test::TemporaryFolder folder;
  folder.write("precious", "precious");
  std::filesystem::create_symlink(folder / "precious", folder / "console.log");
  const auto log = AuditLog::open(folder / "console.log");
  ASSERT_FALSE(log);
  EXPECT_EQ(log.error().message, "console log " + (folder / "console.log") + ": Too many levels of symbolic links");
  EXPECT_EQ(folder.read("precious"), "precious");
}

TEST(AuditLog, ADiskThatTakesNothingCostsLinesThatAreCounted) {
  AuditLog log(FileDescriptor(::open("/dev/full", O_WRONLY | O_CLOEXEC)));
  for (int i = 0; i < 10; ++i) log.add({"Ana", "", "", "order go", "", "", ""});
  while (log.lost() < 10) std::this_thread::yield();
  EXPECT_EQ(log.lost(), 10U);
}

TEST(AuditLog, TakesLinesOfManyThreadsWhole) {
  const test::TemporaryFolder folder;
  {
    auto log = AuditLog::open(folder / "console.log");
    ASSERT_TRUE(log);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 500; ++i) log.value()->add({"Ana", "::1", "admin", "order go", "said", "1", "ab"});
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(log.value()->lost(), 0U);
  }
  const std::string text = folder.read("console.log");
  const std::string line = text.substr(0, text.find('\n') + 1);
  EXPECT_EQ(text.size(), 2000 * line.size());
}

}  // namespace
}  // namespace footlight::app
