// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/desk.hpp"
#include "app/session.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Which papers are wanted.
struct Wanted {
  std::set<std::string> only;  ///< sheets, calls, charts, patch, floor; empty: all
  std::vector<FormationIndex> charts;
  [[nodiscard]] bool has(const std::string& what) const { return only.empty() || only.contains(what); }
};

/// Writes what a desk makes, each file whole or not at all, and remembers which. Tells how far it is and of characters
/// that no font has. Errors of all: a file that cannot be written; interrupted.
class PaperFiles {
 public:
  PaperFiles(Session& session, const Desk& desk) : session_(session), desk_(desk) {}

  /// All that is wanted, everybody's sheets in a folder of their own.
  [[nodiscard]] Status<> folder(const std::filesystem::path& folder, const Wanted& wanted);
  /// The first kind of paper that is wanted (of charts the last), else everybody's sheets.
  [[nodiscard]] Status<> one(const std::filesystem::path& file, const Wanted& wanted);
  /// Everybody's page; and a list of them where nobody is missing.
  [[nodiscard]] Status<> pages(const std::filesystem::path& folder);
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

 private:
  [[nodiscard]] Status<> write(const std::filesystem::path& file, const std::string& content);
  [[nodiscard]] Result<std::string> all_sheets();
  [[nodiscard]] Status<> each(const std::filesystem::path& folder, const std::string& ending,
                              const std::function<std::pair<std::string, int>(PerformerIndex)>& made);
  void warn_of_missing(int characters);

  Session& session_;
  const Desk& desk_;
  std::vector<std::string> files_;
};

}  // namespace footlight::app
