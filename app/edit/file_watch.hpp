// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/file_descriptor.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Tells when files have become others. Editors write in place, in pieces, or write another file and rename it: a
/// change counts when nobody has touched any of the files for kQuiet, and by what `stat` says then. Where the kernel
/// tells nothing (a network's file system) the files are looked at every kLook. One thread.
class FileWatch {
 public:
  static constexpr Duration kQuiet = milliseconds(300);
  static constexpr Duration kLook = milliseconds(2000);

  /// The folders of these files are watched; what they are now is no change.
  void watch(const std::vector<std::string>& files);
  /// Does not wait. @return true once for each change
  bool changed(Instant now);
  /// Becomes readable when something may have changed; -1: the kernel does not tell.
  [[nodiscard]] int file() const { return events_.get(); }

 private:
  /// Which file it is: nothing where there is none.
  using Stamp = std::vector<long long>;
  [[nodiscard]] static Stamp stamp_of(const std::string& file);
  /// @return true when one of them was about a file that is watched
  bool take_events();

  FileDescriptor events_;
  std::map<int, std::set<std::string>> names_;  ///< by watched folder
  std::map<std::string, Stamp> stamps_;
  Instant touched_ = Instant::max();  ///< not looked at since; max: it was
  Instant look_at_{};
};

}  // namespace footlight::app
