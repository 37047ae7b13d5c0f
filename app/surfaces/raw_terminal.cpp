// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/raw_terminal.hpp"

#include <array>
#include <atomic>
#include <csignal>

#include <termios.h>
#include <unistd.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

termios before;
std::atomic<bool> raw{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may look at it");

constexpr std::array kDeadly{SIGHUP, SIGQUIT, SIGILL, SIGABRT, SIGBUS, SIGFPE, SIGSEGV};

extern "C" void on_deadly_signal(int signal) {
  restore_terminal();
  ::raise(signal);  // by now it does what it always does
}

}  // namespace

bool RawTerminal::there() { return ::isatty(STDIN_FILENO) != 0; }

RawTerminal::RawTerminal() {
  FL_CHECK(!raw.load());
  if (!there() || ::tcgetattr(STDIN_FILENO, &before) != 0) return;
  raw.store(true);
  for (const int signal : kDeadly) {
    struct sigaction action {};
    action.sa_handler = on_deadly_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    (void)::sigaction(signal, &action, nullptr);
  }
  termios keys = before;
  keys.c_iflag &= ~static_cast<tcflag_t>(IXON);  // Ctrl-S would stop what the show says
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  keys.c_cc[VSUSP] = _POSIX_VDISABLE;
  (void)::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
}

RawTerminal::~RawTerminal() { restore_terminal(); }

void restore_terminal() noexcept {
  if (raw.exchange(false)) (void)::tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

}  // namespace footlight::app
