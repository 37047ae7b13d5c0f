// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/journal/journal.hpp"
#include "app/live/live_run.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surviving/watchdog.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// What the command line says about dying and living on.
struct SurvivingOptions {
  bool resume = false;
  bool supervised = false;
  AfterDeath after = AfterDeath::go_on;

  void add_options(CLI::App& command);
};

/// How a run ends of its own will, in its journal.
inline constexpr const char* kOver = "over";
inline constexpr const char* kQuit = "quit";

/// What a run is taken up from.
struct CutOff {
  Place place{};
  bool same_start = true;  ///< of the machine: times compare
};

/// The last run of a journal, where it was cut off. Nothing: there was none, or it ended of its own will; `told` says
/// which. Errors: it led another plan.
/// @param plan config::digest_of
[[nodiscard]] Result<std::optional<CutOff>> find_cut_off(const std::filesystem::path& journal, const std::string& plan,
                                                         std::string& told);

/// A run's side of surviving: writes the journal, feeds the watchdog, takes a show up.
class Surviving {
 public:
  /// @param show path of its file  @param plan config::digest_of  Borrows rig and board.
  Surviving(const std::filesystem::path& journal, const std::string& show, const std::string& plan, const Rig& rig,
            const NodeBoard* board);

  void join(RunDesk& desk);
  /// The options borrow the desk.
  void take_up(const CutOff& cut, AfterDeath policy, RunDesk& desk, LiveOptions& live);
  [[nodiscard]] Journal& journal() { return journal_; }

 private:
  Journal journal_;
  Watchdog watchdog_;
};

/// Keeps the program's memory from being swapped out, where that is allowed. @return why it is not; empty: it is
[[nodiscard]] std::string lock_memory();

}  // namespace footlight::app
