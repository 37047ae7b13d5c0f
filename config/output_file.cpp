// SPDX-License-Identifier: Apache-2.0
#include "config/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace footlight::config {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16U;

/// An open descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  [[nodiscard]] int get() const { return fd_; }
  bool close() { return fd_ < 0 || ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

Error cannot_write(const std::filesystem::path& file, int error) {
  return input_error(fmt::format("cannot write '{}': {}", file.string(), std::strerror(error)));
}

Error cannot_read(const std::filesystem::path& file, std::string_view why) {
  return input_error(fmt::format("cannot read '{}': {}", file.string(), why));
}

/// The new content under the old name, or the old content.
Status<> replace_file(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const std::string temporary = (folder / fmt::format(".{}.{}.tmp", file.filename().string(), getpid())).string();
  Descriptor out(open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (out.get() < 0) return cannot_write(file, errno);
  if (!write_all(out.get(), content) || fsync(out.get()) != 0 || !out.close() ||
      std::rename(temporary.c_str(), file.c_str()) != 0) {
    const int error = errno;
    unlink(temporary.c_str());
    return cannot_write(file, error);
  }
  // The new name itself reaches the disk with its folder; some file systems refuse this, and then nothing is lost.
  const Descriptor place(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (place.get() >= 0) fsync(place.get());
  return Done{};
}

}  // namespace

Status<> write_file(const std::filesystem::path& name, std::string_view content) {
  std::error_code error;
  if (std::filesystem::is_directory(name, error)) return cannot_write(name, EISDIR);
  // A link keeps being a link; what it names is written.
  const bool is_link = std::filesystem::is_symlink(name, error);
  const std::filesystem::path file = is_link ? std::filesystem::weakly_canonical(name, error) : name;
  // Devices and pipes are written to and stay what they are.
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
    Descriptor out(open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.get() < 0 || !write_all(out.get(), content) || !out.close()) return cannot_write(name, errno);
    return Done{};
  }
  return replace_file(file, content);
}

Status<> read_blocks(const std::filesystem::path& file, const std::function<void(std::string_view)>& take) {
  // Without waiting for a writer, should it be a pipe.
  const Descriptor in(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (in.get() < 0) return cannot_read(file, std::strerror(errno));
  struct stat about {};
  if (fstat(in.get(), &about) != 0) return cannot_read(file, std::strerror(errno));
  if (!S_ISREG(about.st_mode)) return cannot_read(file, "it is not a file");
  std::string block(kBlockBytes, '\0');
  while (true) {
    const ssize_t n = ::read(in.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot_read(file, std::strerror(errno));
    if (n == 0) return Done{};
    take(std::string_view(block).substr(0, static_cast<std::size_t>(n)));
  }
}

Result<std::string> read_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  std::string out;
  if (!unknown && size > max_bytes) return cannot_read(file, fmt::format("it is larger than {} bytes", max_bytes));
  // A file that grows meanwhile is cut, which whatever reads it will notice.
  auto done = read_blocks(file, [&](std::string_view block) { out.append(block.substr(0, max_bytes - out.size())); });
  if (!done) return std::move(done).error();
  return out;
}

}  // namespace footlight::config
