// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
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
  /// In natural order.
  [[nodiscard]] std::vector<std::string> people() const;

 private:
  [[nodiscard]] Status<> write() const;

  std::filesystem::path file_;
  std::string show_;
  std::set<std::string> people_;
};

}  // namespace footlight::app
