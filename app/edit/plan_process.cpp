// SPDX-License-Identifier: Apache-2.0
#include "app/edit/plan_process.hpp"

#include <array>
#include <csignal>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

constexpr rlim_t kMost_bytes = rlim_t{6} << 30;  // of addresses; plans of 100,000 people need less
constexpr std::size_t kMostWords = 64 * 1024;
constexpr int kLook_ms = 50;

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ",") + word;
  return out;
}

std::vector<std::string> words_of(const PlanOrder& order) {
  std::vector<std::string> out{"footlight", "plan", "--quiet", "-o", order.output};
  for (const auto& [option, people] : {std::pair{"--absent", &order.absent}, std::pair{"--cover", &order.covers}}) {
    if (!people->empty()) out.insert(out.end(), {option, joined(*people)});
  }
  out.insert(out.end(), {"--", order.show});
  return out;
}

/// Between fork and exec: nothing but system calls.
[[noreturn]] void become_the_planner(char* const* arguments, int output, int nothing) {
  take_the_lowest_priority();
  const rlimit most{kMost_bytes, kMost_bytes};
  (void)::setrlimit(RLIMIT_AS, &most);
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  (void)::setpgid(0, 0);  // the terminal's interrupt is the show's affair
  const int score = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (score >= 0) (void)!::write(score, "1000", 4);
  (void)::dup2(nothing, STDIN_FILENO);
  (void)::dup2(nothing, STDOUT_FILENO);
  (void)::dup2(output, STDERR_FILENO);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) (void)std::signal(signal, SIG_DFL);
  ::execv("/proc/self/exe", arguments);
  ::_exit(127);
}

ErrorKind kind_of(int status) {
  if (!WIFEXITED(status)) return ErrorKind::internal;
  switch (WEXITSTATUS(status)) {
    case 2:
      return ErrorKind::input;
    case 3:
      return ErrorKind::refused;
    default:
      return ErrorKind::internal;
  }
}

}  // namespace

void take_the_lowest_priority() noexcept {
  const sched_param none{};
  (void)::sched_setscheduler(0, SCHED_BATCH, &none);  // of this thread, as the next
  (void)::setpriority(PRIO_PROCESS, 0, 19);
}

Status<> plan_in_a_process(const PlanOrder& order, const std::atomic<bool>& stop) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return Error{ErrorKind::internal, "no pipe for the planner"};
  const FileDescriptor ours(ends[0]);
  FileDescriptor its(ends[1]);
  const FileDescriptor nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  std::vector<std::string> words = words_of(order);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t process = ::fork();
  if (process == 0) become_the_planner(arguments.data(), its.get(), nothing.get());
  if (process < 0) return Error{ErrorKind::internal, "the planner cannot be started"};
  its = FileDescriptor();
  std::string said;
  bool killed = false;
  for (;;) {
    pollfd file{ours.get(), POLLIN, 0};
    const int ready = ::poll(&file, 1, kLook_ms);
    if (stop.load() && !std::exchange(killed, true)) ::kill(process, SIGKILL);
    if (ready <= 0) continue;
    std::array<char, 4096> bytes{};
    const ssize_t size = ::read(ours.get(), bytes.data(), bytes.size());
    if (size <= 0) break;
    if (said.size() < kMostWords) said.append(bytes.data(), static_cast<std::size_t>(size));
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (killed) return Error{ErrorKind::interrupted, "planning was given up"};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
  while (said.ends_with('\n')) said.pop_back();
  if (said.starts_with("error: ")) said.erase(0, 7);
  if (said.empty()) said = "the planner has ended without a word (too little memory?)";
  return Error{kind_of(status), said};
}

}  // namespace footlight::app
