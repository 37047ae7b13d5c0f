// SPDX-License-Identifier: Apache-2.0
#include "app/walk_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "config/output_file.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

Error cannot(const std::filesystem::path& file) {
  return input_error(fmt::format("cannot write '{}': {}", file.string(), std::strerror(errno)));
}

}  // namespace

WalkFile::~WalkFile() {
  if (fd_ >= 0) ::close(fd_);
}

Status<> WalkFile::open(const std::filesystem::path& file) {
  file_ = file;
  fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_APPEND, 0644);
  if (fd_ < 0) return cannot(file);
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    return input_error(fmt::format("'{}' belongs to a walk that is under way in another window", file.string()));
  }
  auto text = config::read_file(file, kMostBytes);
  if (!text) return text.error();
  text_ = std::move(text).value();
  const std::size_t whole = text_.rfind('\n') == std::string::npos ? 0 : text_.rfind('\n') + 1;
  if (whole != text_.size()) {
    text_.resize(whole);
    if (::ftruncate(fd_, static_cast<off_t>(whole)) != 0) return cannot(file);
  }
  return Done{};
}

Status<> WalkFile::add(std::string_view line) {
  const std::string whole = std::string(line) + "\n";
  std::size_t written = 0;
  while (written < whole.size()) {
    const ssize_t count = ::write(fd_, whole.data() + written, whole.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return cannot(file_);
    written += static_cast<std::size_t>(count);
  }
  if (::fdatasync(fd_) != 0) return cannot(file_);
  return Done{};
}

}  // namespace footlight::app
