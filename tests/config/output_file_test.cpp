// SPDX-License-Identifier: Apache-2.0
#include "config/output_file.hpp"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::config {
namespace {

using test::TemporaryFolder;
using Names = std::vector<std::string>;

TEST(OutputFile, ReplacesTheOldContentAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  folder.write("a", "old and longer");
  ASSERT_TRUE(write_file(folder / "a", "new"));
  EXPECT_EQ(folder.read("a"), "new");
  EXPECT_EQ(folder.names(), Names{"a"});
}

TEST(OutputFile, NamesTheFolderThatIsMissing) {
  const TemporaryFolder folder;
  const auto result = write_file(folder / "no/a", "x");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), input_error("cannot write '" + folder / "no/a" + "': No such file or directory"));
}

TEST(OutputFile, FollowsALinkAndLeavesItALink) {
  const TemporaryFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink(folder / "target", folder / "link");
  ASSERT_TRUE(write_file(folder / "link", "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(folder.read("target"), "new");
}

TEST(OutputFile, WritesToADeviceAndLeavesItADevice) {
  const auto full = write_file("/dev/full", "x");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error(), input_error("cannot write '/dev/full': No space left on device"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_TRUE(write_file("/dev/null", "x"));
}

TEST(OutputFile, DoesNotReplaceAFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "a");
  const auto result = write_file(folder / "a", "x");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), input_error("cannot write '" + folder / "a" + "': Is a directory"));
  EXPECT_EQ(folder.names(), Names{"a"});
}

TEST(OutputFile, AFullDiskLeavesTheOldFileAndNothingBeside) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit little{1000, before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &little);
  const auto result = write_file(folder / "a", std::string(5000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), input_error("cannot write '" + folder / "a" + "': File too large"));
  EXPECT_EQ(folder.read("a"), "old");
  EXPECT_EQ(folder.names(), Names{"a"});
}

TEST(ReadFile, GivesEveryByte) {
  const TemporaryFolder folder;
  std::string content(200'000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 7);
  folder.write("a", content);
  const auto read = read_file(folder / "a", content.size());
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, content);
}

TEST(ReadFile, RefusesWhatIsTooLargeOrNoFile) {
  const TemporaryFolder folder;
  folder.write("a", "12345");
  EXPECT_EQ(read_file(folder / "a", 4).error(),
            input_error("cannot read '" + folder / "a" + "': it is larger than 4 bytes"));
  EXPECT_EQ(read_file(folder / "b", 4).error(),
            input_error("cannot read '" + folder / "b" + "': No such file or directory"));
  EXPECT_EQ(read_file(folder.path(), 4).error(),
            input_error("cannot read '" + folder.path().string() + "': it is not a file"));
  EXPECT_EQ(read_file("/dev/zero", 4).error(), input_error("cannot read '/dev/zero': it is not a file"));
}

}  // namespace
}  // namespace footlight::config
