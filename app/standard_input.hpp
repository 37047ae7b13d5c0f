// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <unistd.h>

#include "core/time.hpp"

namespace footlight::app {

/// What somebody types, or what another program writes to stdin. Nothing here waits for more than it is told to, and
/// each look takes a few hundred bytes at most: a flood leaves its reader time for everything else.
class StandardInput {
 public:
  /// @param file negative: nobody is listened to
  explicit StandardInput(int file = STDIN_FILENO) : file_(file) {}

  /// The bytes that are there now, 512 at most.
  [[nodiscard]] std::string take();
  /// Of these the lines that have become whole, without their ends. What a line has beyond 4,096 bytes is left out.
  [[nodiscard]] std::vector<std::string> lines();
  /// Until there is something, at most so long.
  void wait(Duration most) const;
  /// -1: nothing comes any more.
  [[nodiscard]] int file() const { return file_; }
  /// Nothing comes any more.
  [[nodiscard]] bool closed() const { return file_ < 0; }

 private:
  int file_;
  std::string begun_;  ///< a line that is not whole
};

}  // namespace footlight::app
