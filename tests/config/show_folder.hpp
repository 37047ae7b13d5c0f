// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.hpp"

namespace footlight::config {

/// A folder of its own for one test, with files in folders of it.
class ShowFolder {
 public:
  void write(const std::string& name, std::string_view content) const {
    std::filesystem::create_directories(path(name).parent_path());
    folder_.write(name, std::string(content));
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  /// `text` with this folder's path left out, so that messages can be compared as a whole.
  [[nodiscard]] std::string without_folder(std::string text) const {
    const std::string prefix = folder_.path().string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace footlight::config
