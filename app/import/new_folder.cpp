// SPDX-License-Identifier: Apache-2.0
#include "app/import/new_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "config/output_file.hpp"

namespace footlight::app {
namespace {

Error cannot_make(const std::filesystem::path& folder, const std::string& why) {
  return input_error(fmt::format("cannot make the folder '{}': {}", folder.string(), why));
}

}  // namespace

Result<NewFolder> NewFolder::make(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // "my-show/"
  if (std::filesystem::exists(std::filesystem::symlink_status(whole, error))) {
    return input_error(fmt::format("'{}' is there already (an imported show wants a new folder)", folder.string()));
  }
  std::filesystem::create_directories(whole.parent_path(), error);
  if (error) return cannot_make(folder, error.message());
  std::string hidden = (whole.parent_path() / ("." + whole.filename().string() + "-XXXXXX")).string();
  if (mkdtemp(hidden.data()) == nullptr) return cannot_make(folder, std::generic_category().message(errno));
  std::filesystem::permissions(hidden, std::filesystem::perms(0755), error);
  return NewFolder(whole, hidden);
}

NewFolder::NewFolder(NewFolder&& other) noexcept
    : folder_(std::move(other.folder_)), hidden_(std::exchange(other.hidden_, {})) {}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!hidden_.empty()) std::filesystem::remove_all(hidden_, ignored);
}

Status<> NewFolder::fill(const std::vector<std::pair<std::string, std::string>>& files) const {
  for (const auto& [name, content] : files) {
    const std::filesystem::path file = hidden_ / name;
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (error) return cannot_make(folder_, error.message());
    if (auto done = config::write_file(file, content); !done) return done.error();
  }
  return Done{};
}

Status<> NewFolder::keep() {
  std::error_code error;
  // A rename takes the place of an empty folder: nobody else's, please.
  if (std::filesystem::exists(std::filesystem::symlink_status(folder_, error))) {
    return input_error(fmt::format("'{}' is there already (an imported show wants a new folder)", folder_.string()));
  }
  std::filesystem::rename(hidden_, folder_, error);
  if (error) return cannot_make(folder_, error.message());
  hidden_.clear();
  return Done{};
}

}  // namespace footlight::app
