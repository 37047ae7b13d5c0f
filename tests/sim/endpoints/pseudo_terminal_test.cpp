// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/pseudo_terminal.hpp"

#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

FileDescriptor open_as_a_program(const std::filesystem::path& link) {
  return FileDescriptor(::open(link.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
}

Bytes read_from(PseudoTerminal& terminal) {
  Bytes buffer(300);
  buffer.resize(terminal.read(buffer));
  return buffer;
}

TEST(PseudoTerminal, PassesEveryByteBothWays) {
  const test::TemporaryFolder folder;
  auto terminal = PseudoTerminal::open(folder.path() / "left");
  ASSERT_TRUE(terminal) << terminal.error().message;
  const FileDescriptor program = open_as_a_program(folder.path() / "left");
  ASSERT_GE(program.get(), 0);
  Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  ASSERT_EQ(::write(program.get(), all.data(), all.size()), 256);
  EXPECT_EQ(read_from(*terminal), all);
  terminal->write(all);
  Bytes got(300);
  EXPECT_EQ(::read(program.get(), got.data(), got.size()), 256);
  got.resize(256);
  EXPECT_EQ(got, all);
}

TEST(PseudoTerminal, TheNextProgramFindsTheSameNameAndNothingOfTheOneBefore) {
  const test::TemporaryFolder folder;
  auto terminal = PseudoTerminal::open(folder.path() / "left");
  ASSERT_TRUE(terminal);
  const auto before = std::filesystem::read_symlink(folder.path() / "left");
  {
    const FileDescriptor first = open_as_a_program(folder.path() / "left");
    ASSERT_EQ(::ioctl(first.get(), TIOCEXCL), 0);
    terminal->write(Bytes{1, 2, 3});  // nobody reads it
  }
  EXPECT_EQ(read_from(*terminal), Bytes{});
  const FileDescriptor second = open_as_a_program(folder.path() / "left");
  ASSERT_GE(second.get(), 0) << "the exclusive claim of the first is gone";
  Bytes got(8);
  EXPECT_EQ(::read(second.get(), got.data(), got.size()), -1) << "and so is what it has not read";
  ASSERT_EQ(::write(second.get(), "x", 1), 1);
  EXPECT_EQ(read_from(*terminal), Bytes{'x'});
}

TEST(PseudoTerminal, WhatAProgramSaysBeforeItGoesIsHeard) {
  const test::TemporaryFolder folder;
  auto terminal = PseudoTerminal::open(folder.path() / "left");
  ASSERT_TRUE(terminal);
  ASSERT_EQ(::write(open_as_a_program(folder.path() / "left").get(), "bye", 3), 3);
  EXPECT_EQ(read_from(*terminal), (Bytes{'b', 'y', 'e'}));
}

TEST(PseudoTerminal, TakesItsLinkAwayAndReplacesOneThatWasLeft) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/pts/left-by-a-crash", folder.path() / "left");
  {
    auto terminal = PseudoTerminal::open(folder.path() / "left");
    ASSERT_TRUE(terminal);
    EXPECT_GE(open_as_a_program(folder.path() / "left").get(), 0);
  }
  EXPECT_FALSE(std::filesystem::is_symlink(folder.path() / "left"));
}

TEST(PseudoTerminal, NeverReplacesAFile) {
  const test::TemporaryFolder folder;
  folder.write("left", "mine");
  const auto terminal = PseudoTerminal::open(folder.path() / "left");
  ASSERT_FALSE(terminal);
  EXPECT_EQ(terminal.error().message,
            "serial port \"" + (folder.path() / "left").string() +
                "\": something else has this name: File exists (--dir names a folder of your own for these links)");
  EXPECT_EQ(folder.read("left"), "mine");
}

}  // namespace
}  // namespace footlight::sim
