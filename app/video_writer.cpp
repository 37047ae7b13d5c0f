// SPDX-License-Identifier: Apache-2.0
#include "app/video_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace footlight::app {
namespace {

constexpr std::size_t kMostSaid = 65536;

Error cannot_write(const std::filesystem::path& file, const std::string& why) {
  return input_error(fmt::format("cannot write '{}': {}", file.string(), why));
}

std::vector<std::string> arguments_of(const VideoWriter::Shape& shape, const std::filesystem::path& temporary) {
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-nostats",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_range",
          "tv",
          "-video_size",
          fmt::format("{}x{}", shape.width, shape.height),
          "-framerate",
          fmt::format("{:g}", shape.rate),
          "-i",
          "pipe:0",
          "-an",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "20",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-fflags",
          "+bitexact",
          "-flags:v",
          "+bitexact",
          "-metadata",
          "title=" + shape.title,
          "-metadata",
          "comment=" + shape.comment,
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          temporary.string()};
}

}  // namespace

VideoWriter::VideoWriter(std::filesystem::path file, std::filesystem::path temporary)
    : file_(std::move(file)), temporary_(std::move(temporary)) {}

VideoWriter::VideoWriter(VideoWriter&& other) noexcept
    : file_(std::move(other.file_)),
      temporary_(std::move(other.temporary_)),
      child_(std::exchange(other.child_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      said_(std::exchange(other.said_, -1)) {
  other.temporary_.clear();
}

VideoWriter::~VideoWriter() { abandon(); }

Result<VideoWriter> VideoWriter::open(const std::filesystem::path& file, const Shape& shape) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const std::string hidden = fmt::format(".{}.{}.", file.filename().string(), getpid());
  VideoWriter out(file, folder / (hidden + "tmp"));
  // A program that no video will come of must not be begun, and nobody else writes to the pipe.
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return cannot_write(file, std::strerror(errno));
  out.pipe_ = ends[1];
  out.said_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  if (out.said_ < 0) {
    const int error = errno;
    ::close(ends[0]);
    return cannot_write(file, std::strerror(error));
  }
  std::vector<std::string> arguments = arguments_of(shape, out.temporary_);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.said_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.said_, STDERR_FILENO);
  // A group of its own: Ctrl-C is for us, and we end it.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error = posix_spawnp(&out.child_, "ffmpeg", &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (error == 0) return out;
  out.child_ = -1;
  if (error == ENOENT) return cannot_write(file, "the program ffmpeg is not installed (apt-get install ffmpeg)");
  return cannot_write(file, std::string("ffmpeg cannot be run: ") + std::strerror(error));
}

Status<> VideoWriter::write(std::span<const unsigned char> planar) {
  while (!planar.empty()) {
    const ssize_t n = ::write(pipe_, planar.data(), planar.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      if (auto done = wait(); !done) return done;
      return cannot_write(file_, "ffmpeg has ended too early");
    }
    planar = planar.subspan(static_cast<std::size_t>(n));
  }
  return Done{};
}

/// The last line that ffmpeg said.
std::string VideoWriter::last_said() const {
  std::string text(kMostSaid, '\0');
  const off_t end = lseek(said_, 0, SEEK_END);
  const ssize_t n = pread(said_, text.data(), text.size(), std::max<off_t>(0, end - static_cast<off_t>(kMostSaid)));
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

Status<> VideoWriter::wait() {
  ::close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  // It ends with status 0 even where the end of the film could not be written: it must have said nothing, too.
  const std::string said = last_said();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && said.empty()) return Done{};
  return cannot_write(file_, said.empty() ? "ffmpeg has failed" : "ffmpeg: " + said);
}

Status<> VideoWriter::finish() {
  if (auto done = wait(); !done) return done;
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error) return cannot_write(file_, error.message());
  return Done{};
}

void VideoWriter::abandon() noexcept {
  if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
  if (said_ >= 0) ::close(std::exchange(said_, -1));
  if (child_ > 0) {
    kill(child_, SIGKILL);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
  }
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

}  // namespace footlight::app
