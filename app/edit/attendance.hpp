// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "app/plan_step.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Who does not come, by the operator's word, and what is done about it. Ids.
struct Attendance {
  std::set<std::string> absent{};               ///< all of them
  std::map<std::string, std::string> covers{};  ///< who takes whose way
  std::set<std::string> repaired{};             ///< by the planner's choice
  friend bool operator==(const Attendance&, const Attendance&) = default;

  /// For a planning.
  void put_into(std::vector<std::string>& absent_ids, std::vector<std::string>& cover_pairs) const;
};

/// Keeps the plan that a run has taken, and who is absent in it, for a run that is cut off and taken up again.
/// @param plan_file of it
[[nodiscard]] Status<> keep_taken(const std::filesystem::path& folder, const std::string& show,
                                  const std::string& show_hash, const Attendance& attendance,
                                  const std::filesystem::path& plan_file);
/// What was kept, and `choice` set to plan the same; nobody, and `choice` as it was, where nothing was kept, or of
/// another show, or the show's files have changed since.
[[nodiscard]] Attendance take_up_taken(const std::filesystem::path& folder, PlanChoice& choice);
void forget_taken(const std::filesystem::path& folder);

}  // namespace footlight::app
