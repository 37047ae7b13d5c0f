// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace footlight::app {

/// A file to which lines are added, each on the disk before anybody goes on: whatever kills the program, no line is
/// lost but one that was not finished.
class WalkFile {
 public:
  WalkFile() = default;
  ~WalkFile();
  WalkFile(const WalkFile&) = delete;
  WalkFile& operator=(const WalkFile&) = delete;

  /// Opens or begins it; a last line without its end is cut off. One program at a time.
  /// Errors (ErrorKind::input): it cannot be written, it is larger than a walk can be, another program has it.
  [[nodiscard]] Status<> open(const std::filesystem::path& file);
  /// The whole lines that were in it when it was opened.
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] Status<> add(std::string_view line);

 private:
  std::filesystem::path file_;
  std::string text_;
  int fd_ = -1;
};

}  // namespace footlight::app
