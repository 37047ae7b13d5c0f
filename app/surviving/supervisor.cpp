// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/supervisor.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "core/clock.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

constexpr Duration kFirstRest = milliseconds(50);
constexpr Duration kLongestRest = milliseconds(2000);
constexpr int kExitInternal = 1;
constexpr int kExitDevice = 4;

/// What the child says to us (sd_notify): a socket without a name in the file system.
class Ear {
 public:
  Ear() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_un us{};
    us.sun_family = AF_UNIX;
    // The kernel makes up a name.
    if (socket_.get() < 0 || ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&us), sizeof us.sun_family) != 0) {
      return;
    }
    socklen_t length = sizeof us;
    if (::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&us), &length) != 0) return;
    const std::size_t name = length - offsetof(sockaddr_un, sun_path);
    address_ = "@" + std::string(us.sun_path + 1, name - 1);
  }
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] int handle() const { return socket_.get(); }
  /// @return what was said, empty: nothing more
  [[nodiscard]] std::string hear() const {
    std::array<char, 256> buffer{};
    const ssize_t size = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    return size > 0 ? std::string(buffer.data(), static_cast<std::size_t>(size)) : "";
  }

 private:
  FileDescriptor socket_;
  std::string address_;
};

class Supervisor {
 public:
  Supervisor(const std::string& program, std::vector<std::string> arguments, Duration silence,
             const std::function<void(const std::string&)>& note)
      : program_(program), arguments_(std::move(arguments)), silence_(silence), note_(note) {
    terminal_ = ::tcgetattr(STDIN_FILENO, &as_it_was_) == 0;
    ::sigemptyset(&watched_);
    for (const int one : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&watched_, one);
    ::sigprocmask(SIG_BLOCK, &watched_, &mask_before_);
    signals_ = FileDescriptor(::signalfd(-1, &watched_, SFD_CLOEXEC | SFD_NONBLOCK));
  }
  ~Supervisor() { ::sigprocmask(SIG_SETMASK, &mask_before_, nullptr); }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int run() {
    int young = 0;
    while (true) {
      const Instant began = clock_.now();
      if (!start()) return kExitInternal;
      const ChildEnd end = watch();
      // Whatever it has done to the terminal: the next one begins as this one did.
      if (terminal_) (void)::tcsetattr(STDIN_FILENO, TCSADRAIN, &as_it_was_);
      if (ending_ || !begins_again(end, ready_, again_)) return end.by_signal ? 128 + end.number : end.number;
      young = clock_.now() - began < kYoung ? young + 1 : 0;
      note_(fmt::format("the run has died ({}): it is begun again",
                        end.by_signal ? ::strsignal(end.number)  // NOLINT(concurrency-mt-unsafe)
                                      : fmt::format("exit status {}", end.number)));
      if (!again_) arguments_.emplace_back("--resume");
      again_ = true;
      rest(rest_before(young));
      if (ending_) return 128 + SIGTERM;
    }
  }

 private:
  bool start() {
    ready_ = false;
    ends_ = false;
    heard_at_.reset();
    std::vector<char*> arguments;
    for (std::string& argument : arguments_) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    std::vector<std::string> variables{"NOTIFY_SOCKET=" + ear_.address(),
                                       fmt::format("WATCHDOG_USEC={}", silence_ / microseconds(1))};
    for (char** variable = environ; *variable != nullptr; ++variable) {
      const std::string_view text(*variable);
      if (!text.starts_with("NOTIFY_SOCKET=") && !text.starts_with("WATCHDOG_")) variables.emplace_back(text);
    }
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    ::posix_spawnattr_setsigmask(&attributes, &mask_before_);
    const int failed =
        ::posix_spawn(&child_, program_.c_str(), nullptr, &attributes, arguments.data(), environment.data());
    ::posix_spawnattr_destroy(&attributes);
    if (failed != 0) note_("the run cannot be begun: " + std::generic_category().message(failed));
    return failed == 0;
  }

  /// Until the child has ended.
  ChildEnd watch() {
    while (true) {
      if (const auto end = reap()) return *end;
      wait(milliseconds(100));
      if (heard_at_ && !ends_ && clock_.now() - *heard_at_ > silence_) {
        note_(fmt::format("the cue thread has been silent for {:.1f} s: the run is killed", to_seconds(silence_)));
        heard_at_.reset();
        (void)::kill(child_, SIGKILL);
      }
    }
  }

  std::optional<ChildEnd> reap() {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) != child_) return std::nullopt;
    child_ = 0;
    if (WIFSIGNALED(status)) return ChildEnd{true, WTERMSIG(status)};
    return ChildEnd{false, WEXITSTATUS(status)};
  }

  void rest(Duration time) {
    const Instant until = clock_.now() + time;
    while (!ending_ && clock_.now() < until) wait(std::min(until - clock_.now(), milliseconds(100)));
  }

  void wait(Duration most) {
    std::array<pollfd, 2> files{pollfd{signals_.get(), POLLIN, 0}, pollfd{ear_.handle(), POLLIN, 0}};
    (void)::poll(files.data(), files.size(), static_cast<int>(std::max<Duration::rep>(1, most / milliseconds(1))));
    signalfd_siginfo told{};
    while (::read(signals_.get(), &told, sizeof told) == static_cast<ssize_t>(sizeof told)) {
      if (told.ssi_signo == SIGCHLD) continue;
      ending_ = true;
      // What a terminal sends, it sends to the child as well.
      if (child_ > 0 && told.ssi_code != SI_KERNEL) (void)::kill(child_, static_cast<int>(told.ssi_signo));
    }
    for (std::string said = ear_.hear(); !said.empty(); said = ear_.hear()) {
      ready_ = ready_ || said.find("READY=1") != std::string::npos;
      ends_ = ends_ || said.find("STOPPING=1") != std::string::npos;
      if (said.find("WATCHDOG=1") != std::string::npos) heard_at_ = clock_.now();
    }
  }

  const std::string& program_;
  std::vector<std::string> arguments_;
  Duration silence_;
  const std::function<void(const std::string&)>& note_;
  SteadyClock clock_;
  Ear ear_;
  sigset_t watched_{};
  sigset_t mask_before_{};
  FileDescriptor signals_;
  termios as_it_was_{};
  bool terminal_ = false;
  pid_t child_ = 0;
  bool again_ = false;
  bool ready_ = false;
  bool ending_ = false;
  bool ends_ = false;                ///< the child, of its own will
  std::optional<Instant> heard_at_;  ///< the watchdog's sign of life
};

}  // namespace

bool begins_again(const ChildEnd& end, bool ready, bool again) {
  if (end.by_signal || end.number == kExitInternal) return true;
  return end.number == kExitDevice && again && !ready;
}

Duration rest_before(int young) {
  if (young <= 1) return {};
  return std::min(kLongestRest, kFirstRest * (Duration::rep{1} << std::min(young - 2, 10)));
}

int supervise(const std::string& program, std::vector<std::string> arguments, Duration silence,
              const std::function<void(const std::string&)>& note) {
  return Supervisor(program, std::move(arguments), silence, note).run();
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) {
    if (argument != "--supervised") arguments.push_back(argument);
  }
  return arguments;
}

}  // namespace footlight::app
