// SPDX-License-Identifier: Apache-2.0
#include "config/decoder_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace footlight::config {
namespace {

constexpr int kPollMs = 100;

/// Where the program is looked for, most wanted first.
std::vector<std::string> places() {
  if (const char* given = std::getenv("FOOTLIGHT_DECODER"); given != nullptr && *given != '\0') return {given};
  std::vector<std::string> out;
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) out.push_back((self.parent_path() / "footlight-decode").string());
#ifdef FOOTLIGHT_DECODER_IN_BUILD
  out.emplace_back(FOOTLIGHT_DECODER_IN_BUILD);
#endif
  return out;
}

Result<std::string> find_program() {
  std::string looked;
  for (const std::string& place : places()) {
    if (access(place.c_str(), X_OK) == 0) return place;
    looked += (looked.empty() ? "" : ", ") + place;
  }
  return internal_error("cannot find the program footlight-decode, which reads videos and images (looked for " +
                        looked + "; FOOTLIGHT_DECODER may name it)");
}

std::vector<std::string> bare_environment(int max_image_pixels) {
  std::vector<std::string> out{"LC_ALL=C", "OPENCV_LOG_LEVEL=SILENT",
                               "OPENCV_IO_MAX_IMAGE_PIXELS=" + std::to_string(max_image_pixels)};
  // Where libraries are, and people's fonts.
  for (const char* name : {"LD_LIBRARY_PATH", "HOME", "XDG_DATA_HOME", "FONTCONFIG_FILE", "FONTCONFIG_PATH"}) {
    if (const char* value = std::getenv(name)) out.push_back(std::string(name) + "=" + value);
  }
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  out.reserve(texts.size() + 1);
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

int spawn(const std::string& program, std::vector<std::string> arguments, std::vector<std::string> environment,
          int output, pid_t* pid) {
  arguments.insert(arguments.begin(), program);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error = posix_spawn(pid, program.c_str(), &actions, &attributes, pointers(arguments).data(),
                                pointers(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

Result<DecoderProcess> DecoderProcess::start(const std::vector<std::string>& arguments, int max_image_pixels) {
  auto program = find_program();
  if (!program) return std::move(program).error();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return internal_error(std::string("cannot make a pipe: ") + std::strerror(errno));
  pid_t pid = -1;
  const int error = spawn(*program, arguments, bare_environment(max_image_pixels), ends[1], &pid);
  close(ends[1]);
  if (error != 0) {
    close(ends[0]);
    return internal_error("cannot start " + *program + ": " + std::strerror(error));
  }
  return DecoderProcess(pid, ends[0]);
}

DecoderProcess::DecoderProcess(DecoderProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), fd_(std::exchange(other.fd_, -1)) {}

DecoderProcess::~DecoderProcess() { finish(true); }

DecoderProcess::Read DecoderProcess::read(void* data, std::size_t size, const Clock& clock, Instant deadline,
                                          const std::atomic<bool>* stop) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return Read::stopped;
    if (clock.now() > deadline) return Read::late;
    pollfd waiting{fd_, POLLIN, 0};
    if (poll(&waiting, 1, kPollMs) <= 0) continue;
    const ssize_t n = ::read(fd_, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return Read::end;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return Read::all;
}

int DecoderProcess::finish(bool kill_it) {
  if (fd_ >= 0) close(std::exchange(fd_, -1));
  if (pid_ < 0) return 0;
  if (kill_it) kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

}  // namespace footlight::config
