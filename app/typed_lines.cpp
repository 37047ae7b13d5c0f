// SPDX-License-Identifier: Apache-2.0
#include "app/typed_lines.hpp"

namespace footlight::app {

std::optional<std::string> TypedLines::next(const std::function<bool()>& meanwhile) {
  while (true) {
    // More is taken only when all is used up: whoever types faster than is read waits.
    if (lines_.empty()) {
      for (std::string& line : input_.lines()) lines_.push_back(std::move(line));
    }
    if (!lines_.empty()) {
      std::string line = std::move(lines_.front());
      lines_.pop_front();
      return line;
    }
    if (closed() || !meanwhile()) return std::nullopt;
  }
}

}  // namespace footlight::app
