// SPDX-License-Identifier: Apache-2.0
#include "app/session.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/speaking.hpp"
#include "app/surfaces/raw_terminal.hpp"

namespace footlight::app {
namespace {

std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void on_signal(int signal) {
  restore_terminal();
  stop_flag.store(true, std::memory_order_relaxed);
  std::signal(signal, SIG_DFL);
}

void write(std::FILE* file, std::string_view text) { (void)Speaking::say(file, text); }

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A reader that goes away and a disk that takes no more are seen as errors of the write.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  return stop_flag;
}

int exit_status(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::internal:
      return 1;
    case ErrorKind::input:
      return 2;
    case ErrorKind::refused:
      return 3;
    case ErrorKind::device:
      return 4;
    case ErrorKind::interrupted:
      return 130;
  }
  return 1;
}

void Session::add_options(CLI::App& command, bool with_json) {
  if (with_json) command.add_flag("--json", json, "print the result as JSON");
  command.add_flag("-q,--quiet", quiet, "print nothing but the result and errors");
  command.add_flag("--progress", plain_progress, "tell the progress in lines, also when stderr is no terminal");
}

void Session::print(std::string_view text) const {
  const bool ended = !text.empty() && text.back() == '\n';
  write(stdout, std::string(text) + (ended ? "" : "\n"));
}

void Session::print_now(std::string_view text) const {
  print(text);
  std::fflush(stdout);
}

void Session::note(std::string_view text) {
  if (quiet) return;
  clear_line();
  write(stderr, fmt::format("note: {}\n", text));
}

void Session::warn(const std::vector<Diagnostic>& warnings) {
  if (quiet) return;
  clear_line();
  for (const Diagnostic& warning : warnings) write(stderr, to_text(warning) + "\n");
}

int Session::fail(const Error& error) {
  clear_line();
  // Messages with a place say themselves what they are.
  const bool placed = error.message.find(": error: ") != std::string::npos;
  write(stderr, (placed ? "" : "error: ") + error.message + (error.message.ends_with('\n') ? "" : "\n"));
  return exit_status(error.kind);
}

void Session::end_now(const Error& error) {
  const int status = fail(error);
  Speaking::end_now();
  std::fflush(nullptr);
  restore_terminal();
  _exit(status);
}

planner::Progress Session::progress() {
  planner::Progress out;
  out.report = [this](std::string_view stage, double share) { tell(stage, share); };
  out.stop = &stop_;
  return out;
}

void Session::enter(std::string_view stage) {
  if (times_) times_->enter(stage);
}

void Session::tell(std::string_view stage, double share) {
  enter(stage);
  if (quiet) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (!terminal && !plain_progress) return;
  const int percent = static_cast<int>(std::clamp(share, 0.0, 1.0) * 100);
  std::string text = fmt::format("{} {}%", stage, plain_progress ? percent / 10 * 10 : percent);
  if (text == last_told_) return;
  const std::string line = plain_progress ? text + "\n" : "\r\x1B[K" + text;
  if (!Speaking::say(stderr, line, WriterThread::Worth::status)) return;
  last_told_ = std::move(text);
  std::fflush(stderr);
  line_open_ = !plain_progress;
}

void Session::show_line(std::string_view text) {
  winsize size{};
  if (quiet || ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0) return;
  const std::size_t width = size.ws_col == 0 ? text.size() : size.ws_col - 1U;  // 0: it does not say
  if (text == last_told_ && line_open_) return;
  if (!Speaking::say(stderr, "\r\x1B[K" + std::string(text.substr(0, width)), WriterThread::Worth::status)) return;
  last_told_ = text;
  std::fflush(stderr);
  line_open_ = true;
}

void Session::clear_line() {
  if (line_open_) write(stderr, "\r\x1B[K");
  line_open_ = false;
}

}  // namespace footlight::app
