// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace footlight::app {

/// Whose walks have changed and who has not been told of it yet. Written at once: it survives the run.
class ToldList {
 public:
  /// Takes what a run of this show has left. @param folder of the run's state
  ToldList(const std::filesystem::path& folder, const std::string& show);

  /// @return whether it could be written; a list that could not is kept all the same
  Status<> add(const std::vector<std::string>& people);
  Status<> tick(const std::string& person);
  Status<> tick_all();
  [[nodiscard]] bool contains(const std::string& person) const { return people_.contains(person); }
  [[nodiscard]] std::size_t size() const { return people_.size(); }
  /// In natural order; another list when it has changed.
  [[nodiscard]] const std::shared_ptr<const std::vector<std::string>>& people() const { return list_; }

 private:
  void sort();
  [[nodiscard]] Status<> write();

  std::filesystem::path file_;
  std::string show_;
  std::set<std::string> people_;
  std::shared_ptr<const std::vector<std::string>> list_;
};

}  // namespace footlight::app
