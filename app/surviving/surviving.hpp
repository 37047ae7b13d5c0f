// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/journal/journal.hpp"
#include "app/live/live_run.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surviving/lead_port.hpp"
#include "app/surviving/understudy.hpp"
#include "app/surviving/watchdog.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

/// A line for people.
using Note = std::function<void(const std::string&)>;

/// What the command line says about dying and living on.
struct SurvivingOptions {
  bool resume = false;
  bool supervised = false;
  AfterDeath after = AfterDeath::go_on;
  std::string understudy;  ///< HOST:PORT of the run to follow
  std::string lead;        ///< [ADDRESS:]PORT for understudies
  std::string lead_token;  ///< file

  void add_options(CLI::App& command);
};

/// How a run ends of its own will, in its journal.
inline constexpr const char* kOver = "over";
inline constexpr const char* kQuit = "quit";

/// What a run is taken up from.
struct CutOff {
  Place place{};
  bool same_start = true;   ///< of the machine: times compare
  std::uint32_t epoch = 0;  ///< to lead under, of an understudy; 0: the journal's next one
};

/// The last run of a journal, where it was cut off. Nothing: there was none, or it ended of its own will; `told` says
/// which. Errors: it led another plan.
/// @param plan config::digest_of
[[nodiscard]] Result<std::optional<CutOff>> find_cut_off(const std::filesystem::path& journal, const std::string& plan,
                                                         std::string& told);

/// The epoch after the last one of a journal: 1 where there is none, or it cannot be read.
[[nodiscard]] std::uint32_t next_epoch(const std::filesystem::path& journal);

/// Follows the run that leads until this one is to lead: by itself, or when somebody says "lead" on stdin. Errors: as
/// `follow`, and HOST:PORT or a token that are none.
/// @param plan config::digest_of
[[nodiscard]] Result<CutOff> follow_lead(const SurvivingOptions& options, const std::string& plan, const Note& note,
                                         const std::atomic<bool>* stop);

/// A run's side of surviving: writes the journal, feeds the watchdog, tells understudies, takes a show up.
class Surviving {
 public:
  /// @param show path of its file  @param plan config::digest_of
  Surviving(const std::filesystem::path& journal, const std::string& show, const std::string& plan,
            std::uint32_t epoch);

  /// The door for understudies, where one is wanted. Errors: as LeadPort::open.
  Status<> open_door(const SurvivingOptions& options, const Note& note);
  /// An understudy leads now: this run has to end.
  [[nodiscard]] bool handed_over() const { return door_ && door_->taken_over() != 0; }
  /// @param how it ended, as in the journal
  void close(const std::string& how);

  void join(RunDesk& desk);
  /// As LiveOptions::heartbeat.
  void beat(const ShowState& state, bool roll_called);
  /// The options borrow the desk.
  void take_up(const CutOff& cut, AfterDeath policy, RunDesk& desk, LiveOptions& live);
  /// Another plan is led from now on. @param digest config::digest_of
  void plan_is(const std::string& digest);
  [[nodiscard]] Journal& journal() { return journal_; }

 private:
  std::string plan_;
  std::uint32_t epoch_;
  Journal journal_;
  Watchdog watchdog_;
  std::unique_ptr<LeadPort> door_;
};

/// Keeps the program's memory from being swapped out, where that is allowed, and looks whether its threads may run
/// before others. @return what is not allowed, a line each
[[nodiscard]] std::vector<std::string> prepare_for_real_time();

}  // namespace footlight::app
