// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp is POSIX

namespace footlight::config {

/// A folder of its own for one test, gone afterwards.
class ShowFolder {
 public:
  ShowFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "footlight-show-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~ShowFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ShowFolder(const ShowFolder&) = delete;
  ShowFolder& operator=(const ShowFolder&) = delete;

  void write(const std::string& name, std::string_view content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return path_ / name; }
  /// `text` with this folder's path left out, so that messages can be compared as a whole.
  [[nodiscard]] std::string without_folder(std::string text) const {
    const std::string prefix = path_.string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace footlight::config
