// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "app/standard_input.hpp"

namespace footlight::app {

/// Lines of stdin, one after another.
class TypedLines {
 public:
  explicit TypedLines(StandardInput input = StandardInput()) : input_(std::move(input)) {}

  /// The next whole line without its end. @param meanwhile called again and again while nobody has typed one; false
  /// ends the waiting. Has to take some time, or give some to others.
  /// @return nothing when stdin is closed, or when the waiting was ended
  std::optional<std::string> next(const std::function<bool()>& meanwhile);
  [[nodiscard]] bool closed() const { return input_.closed(); }

 private:
  StandardInput input_;
  std::deque<std::string> lines_;
};

}  // namespace footlight::app
