// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace footlight::app {

/// A folder that comes into being whole or not at all: it is filled under a hidden name beside its own and renamed.
/// What is not renamed goes away with the object.
class NewFolder {
 public:
  /// Errors: there is something of that name already; it cannot be made.
  [[nodiscard]] static Result<NewFolder> make(const std::filesystem::path& folder);
  NewFolder(NewFolder&& other) noexcept;
  NewFolder& operator=(NewFolder&&) = delete;
  NewFolder(const NewFolder&) = delete;
  ~NewFolder();

  /// Where it is being filled.
  [[nodiscard]] const std::filesystem::path& path() const { return hidden_; }
  /// Files by name and content; a name may begin with a folder.
  [[nodiscard]] Status<> fill(const std::vector<std::pair<std::string, std::string>>& files) const;
  /// Gives it its name. Errors: as of `make`.
  [[nodiscard]] Status<> keep();

 private:
  explicit NewFolder(std::filesystem::path folder, std::filesystem::path hidden)
      : folder_(std::move(folder)), hidden_(std::move(hidden)) {}
  std::filesystem::path folder_;
  std::filesystem::path hidden_;  ///< empty: nothing to take away
};

}  // namespace footlight::app
