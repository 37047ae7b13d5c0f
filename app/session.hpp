// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/stage_times.hpp"
#include "core/diagnostic.hpp"
#include "core/result.hpp"
#include "planner/progress.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// How one run of the program talks: results to stdout, everything else to stderr, and whether it shall stop.
class Session {
 public:
  explicit Session(const std::atomic<bool>& stop) : stop_(stop) {}

  bool json = false;   ///< the result as one JSON document
  bool quiet = false;  ///< errors only
  bool plain_progress = false;

  /// Adds --json (where `with_json`), --quiet and --progress to a command.
  void add_options(CLI::App& command, bool with_json);

  [[nodiscard]] const std::atomic<bool>* stop() const { return &stop_; }
  [[nodiscard]] bool stopped() const { return stop_.load(std::memory_order_relaxed); }

  /// A result. Ends with a newline of its own.
  void print(std::string_view text) const;
  /// A line that somebody waits for: it does not stay in a buffer, also when stdout is a pipe.
  void print_now(std::string_view text) const;
  /// Something that deserves a word; not with --quiet.
  void note(std::string_view text);
  void warn(const std::vector<Diagnostic>& warnings);
  /// Says what went wrong. @return the exit status (docs/errors.md)
  int fail(const Error& error);
  /// The same, and ends the program at once, whatever its threads are doing: nothing may be half written.
  [[noreturn]] void end_now(const Error& error);

  /// How far long work is: one line that is overwritten when stderr is a terminal, a line for each tenth with
  /// --progress, else nothing.
  [[nodiscard]] planner::Progress progress();
  void tell(std::string_view stage, double share);
  /// From here on it is measured how long each stage takes that is told of or entered.
  void time_stages(const Clock& clock) { times_.emplace(clock); }
  void enter(std::string_view stage);
  [[nodiscard]] std::optional<StageTimes>& times() { return times_; }
  /// A line that is overwritten by the next one; as wide as the terminal of stderr, nothing elsewhere.
  void show_line(std::string_view text);
  /// Takes the progress line away.
  void clear_line();

 private:
  const std::atomic<bool>& stop_;
  bool line_open_ = false;
  std::string last_told_;
  std::optional<StageTimes> times_;
};

[[nodiscard]] int exit_status(ErrorKind kind);

/// SIGINT and SIGTERM set this flag; long work looks at it and ends without leaving half a file. A second signal ends
/// the program at once.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

}  // namespace footlight::app
