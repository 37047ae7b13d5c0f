// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <functional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/check.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::test {

/// What a program said and how it ended.
struct Ran {
  int status = 0;  ///< exit status; -signal when one ended it
  std::string out;
  std::string err;
};

/// Runs a program to its end. @param output  where stdout goes; empty: into `out`
/// @param meanwhile  called with the process id while it runs
inline Ran run_program(std::vector<std::string> arguments, const std::string& output = {},
                       const std::function<void(pid_t)>& meanwhile = {}) {
  const TemporaryFolder folder;
  const std::string out = output.empty() ? folder / "out" : output;
  const std::string err = folder / "err";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t pid = -1;
  FL_CHECK(posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ) == 0);
  posix_spawn_file_actions_destroy(&actions);
  if (meanwhile) meanwhile(pid);
  int status = 0;
  FL_CHECK(waitpid(pid, &status, 0) == pid);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), output.empty() ? folder.read("out") : "",
          folder.read("err")};
}

#ifdef FOOTLIGHT_PROGRAM
inline Ran footlight(std::vector<std::string> arguments, const std::string& output = {},
                     const std::function<void(pid_t)>& meanwhile = {}) {
  arguments.insert(arguments.begin(), FOOTLIGHT_PROGRAM);
  return run_program(std::move(arguments), output, meanwhile);
}
#endif

}  // namespace footlight::test
