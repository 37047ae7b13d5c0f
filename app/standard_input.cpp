// SPDX-License-Identifier: Apache-2.0
#include "app/standard_input.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <utility>

#include <poll.h>

namespace footlight::app {
namespace {

constexpr std::size_t kLongestLine = 4096;

}  // namespace

std::string StandardInput::take() {
  std::array<char, 512> buffer{};
  pollfd file{file_, POLLIN, 0};
  if (::poll(&file, 1, 0) <= 0) return {};
  const ssize_t count = ::read(file_, buffer.data(), buffer.size());
  if (count > 0) return {buffer.data(), static_cast<std::size_t>(count)};
  if (count == 0 || errno != EINTR) file_ = -1;
  return {};
}

std::vector<std::string> StandardInput::lines() {
  std::vector<std::string> whole;
  for (const char c : take()) {
    if (c == '\n') {
      whole.push_back(std::exchange(begun_, {}));
    } else if (begun_.size() < kLongestLine) {
      begun_ += c;
    }
  }
  return whole;
}

void StandardInput::wait(Duration most) const {
  pollfd file{file_, POLLIN, 0};
  (void)::poll(&file, 1, static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(most).count()));
}

}  // namespace footlight::app
