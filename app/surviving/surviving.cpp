// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/surviving.hpp"

#include <array>
#include <cerrno>
#include <map>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/machine_time.hpp"

namespace footlight::app {

void SurvivingOptions::add_options(CLI::App& command) {
  command.add_flag("--resume", resume,
                   "take up the last run of this plan where it was cut off; from the top where it ended by itself");
  command.add_flag("--supervised", supervised, "begin the run again, with --resume, whenever it dies");
  command
      .add_option(
          "--after-death", after,
          "what a show does that ran when it was cut off: go-on in time while the markers still guide, or stand")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, AfterDeath>{{"go-on", AfterDeath::go_on}, {"stand", AfterDeath::stand}}))
      ->default_str("go-on");
}

Result<std::optional<CutOff>> find_cut_off(const std::filesystem::path& journal, const std::string& plan,
                                           std::string& told) {
  std::error_code error;
  if (!std::filesystem::exists(journal, error)) {
    told = "nothing to take up: there is no journal '" + journal.string() + "' yet";
    return std::optional<CutOff>();
  }
  auto last = read_journal(journal);
  if (!last) return std::move(last).error();
  for (std::size_t back = last->runs.size(); back > 0; --back) {
    const JournalRun& run = last->runs[back - 1];
    if (run.ended && (run.how == kOver || run.how == kQuit)) {
      told = "nothing to take up: the last run has ended (" + run.how + ")";
      return std::optional<CutOff>();
    }
    auto reading = read_journal(journal, run.id);
    if (!reading) return std::move(reading).error();
    if (!reading->last_place) continue;  // it died before its first lamp
    std::string led = run.plan;
    for (const JournalEntry& entry : reading->entries) {
      if (entry.kind == "plan") led = entry.text;
    }
    if (led != plan) {
      return input_error(fmt::format(
          "--resume: the run that was cut off led another plan ({}..., this one is {}...): its places mean nothing "
          "here (without --resume the show begins at the top)",
          led.substr(0, 12), plan.substr(0, 12)));
    }
    return std::optional(CutOff{*reading->last_place, run.machine_start == machine_start()});
  }
  told = "nothing to take up: the journal has no run that has lit a lamp";
  return std::optional<CutOff>();
}

Surviving::Surviving(const std::filesystem::path& journal, const std::string& show, const std::string& plan,
                     const Rig& rig, const NodeBoard* board)
    : journal_(journal, JournalRun{0, {}, FOOTLIGHT_VERSION, show, plan, {}, 0, {}, {}}, rig, board) {}

void Surviving::join(RunDesk& desk) {
  desk.add(journal_);
  desk.add(watchdog_);
}

void Surviving::take_up(const CutOff& cut, AfterDeath policy, RunDesk& desk, LiveOptions& live) {
  live.take_up = [cut, policy, &desk](Instant now) {
    const Duration machine = machine_time();
    const AfterDeath then = cut.same_start ? policy : AfterDeath::stand;
    const TakeUp up = app::take_up(cut.place, machine, then, desk.orders().plays());
    desk.tell({RunEvent::Kind::note, cut.same_start ? up.told : "the machine was started again since: " + up.told});
    return by_clock(up.where, now, machine);
  };
}

namespace {

/// Whether memory may be locked without end: below a limit the next thread might get none.
bool may_lock() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> capabilities{};
  return ::syscall(SYS_capget, &head, capabilities.data()) == 0 &&
         (capabilities[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

}  // namespace

std::string lock_memory() {
  if (!may_lock()) return "it is not allowed";
  // What has been used once stays: reserved address space costs nothing.
  if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return {};
  return std::generic_category().message(errno);
}

}  // namespace footlight::app
