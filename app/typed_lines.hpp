// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace footlight::app {

/// Lines that somebody types, or that another program writes to stdin.
class TypedLines {
 public:
  /// The next whole line without its end. @param meanwhile called again and again while nobody has typed one; false
  /// ends the waiting. Has to take some time, or give some to others.
  /// @return nothing when stdin is closed, or when the waiting was ended
  std::optional<std::string> next(const std::function<bool()>& meanwhile);
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  void fill();
  std::string typed_;
  bool closed_ = false;
};

}  // namespace footlight::app
