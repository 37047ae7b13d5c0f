// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include "core/result.hpp"

namespace footlight::app {

/// A file that may have gigabytes: it is written as it comes, to a temporary name beside the file, and takes the file's
/// name when it is whole; else nothing is left of it.
class GrowingFile {
 public:
  /// @param what it is, for messages: "trace"
  GrowingFile(std::string what, std::string file);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  [[nodiscard]] Status<> open();
  [[nodiscard]] std::ostream& stream() { return stream_; }
  [[nodiscard]] Status<> keep();

 private:
  [[nodiscard]] Error failure() const;

  std::string what_;
  std::string file_;
  std::string temporary_;
  std::ofstream stream_;
  bool kept_ = false;
};

}  // namespace footlight::app
