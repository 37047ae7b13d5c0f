// SPDX-License-Identifier: Apache-2.0
#include "app/typed_lines.hpp"

#include <array>
#include <cerrno>

#include <poll.h>
#include <unistd.h>

namespace footlight::app {

void TypedLines::fill() {
  std::array<char, 512> buffer{};
  pollfd file{STDIN_FILENO, POLLIN, 0};
  while (!closed_ && ::poll(&file, 1, 0) > 0) {
    const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) closed_ = true;
    if (count > 0) typed_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::optional<std::string> TypedLines::next(const std::function<bool()>& meanwhile) {
  while (true) {
    fill();
    if (const auto end = typed_.find('\n'); end != std::string::npos) {
      std::string line = typed_.substr(0, end);
      typed_.erase(0, end + 1);
      return line;
    }
    if (closed_ || !meanwhile()) return std::nullopt;
  }
}

}  // namespace footlight::app
