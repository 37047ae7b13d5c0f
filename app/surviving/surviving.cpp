// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/surviving.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
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

#include "app/live/waiting.hpp"
#include "app/standard_input.hpp"
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
  command.add_option(
      "--understudy", understudy,
      "HOST:PORT: follow the run that leads there, take over when it falls silent, or at the line \"lead\"");
  command.add_option("--lead", lead, "[ADDRESS:]PORT: tell understudies where the show is (ADDRESS 127.0.0.1)");
  command.add_option("--lead-token", lead_token,
                     "file with a token that leads and understudies share (made where it is not there)");
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

namespace {

struct Door {
  std::string address;
  int port = 0;
};

/// "7000", "host:7000".
std::optional<Door> address_in(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  Door out{colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon), 0};
  const std::string_view port = std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), out.port);
  if (error != std::errc{} || end != port.data() + port.size() || out.port < 0 || out.port > 65'535 ||
      out.address.empty()) {
    return std::nullopt;
  }
  return out;
}

Result<std::string> token_of(const SurvivingOptions& options) {
  if (options.lead_token.empty()) return std::string();
  return token_in(options.lead_token);
}

}  // namespace

std::uint32_t next_epoch(const std::filesystem::path& journal) {
  std::error_code error;
  if (!std::filesystem::exists(journal, error)) return 1;
  const auto reading = read_journal(journal);
  std::uint32_t last = 0;
  if (reading) {
    for (const JournalRun& run : reading->runs) last = std::max(last, run.epoch);
  }
  return last + 1;
}

Result<CutOff> follow_lead(const SurvivingOptions& options, const std::string& plan, const Note& note,
                           const std::atomic<bool>* stop) {
  const auto place = address_in(options.understudy);
  if (!place || place->port == 0) {
    return input_error("--understudy " + options.understudy + ": HOST:PORT is wanted, as in 192.168.1.7:7400");
  }
  auto token = token_of(options);
  if (!token) return std::move(token).error();
  StandardInput input;
  FollowSettings settings{place->address, place->port, *token, plan, {}, note, stop};
  settings.wants_to_lead = [&] {
    if (input.closed()) return false;
    const auto lines = input.lines();
    return std::ranges::find(lines, "lead") != lines.end();
  };
  auto taken = follow(settings);
  if (!taken) return std::move(taken).error();
  note("taking over: " + taken->because);
  return CutOff{taken->place, true, taken->epoch};
}

Surviving::Surviving(const std::filesystem::path& journal, const std::string& show, const std::string& plan,
                     std::uint32_t epoch)
    : plan_(plan),
      epoch_(epoch),
      journal_(journal, JournalRun{0, {}, FOOTLIGHT_VERSION, show, plan, {}, epoch, {}, {}}) {}

Status<> Surviving::open_door(const SurvivingOptions& options, const Note& note) {
  if (options.lead.empty()) return Done{};
  const auto place = address_in(options.lead);
  if (!place) {
    return input_error("--lead " + options.lead + ": [ADDRESS:]PORT is wanted, as in 7400 or 192.168.1.7:7400");
  }
  auto token = token_of(options);
  if (!token) return std::move(token).error();
  auto door = LeadPort::open({place->address, place->port, *token, plan_, epoch_});
  if (!door) return std::move(door).error();
  door_ = std::move(door).value();
  note(fmt::format("understudies may follow: footlight run ... --understudy {}:{}", place->address, door_->port()));
  return Done{};
}

void Surviving::plan_is(const std::string& digest) {
  journal_.plan_is(digest);
  if (door_) door_->plan_is(digest);
}

void Surviving::close(const std::string& how) {
  // Who is interrupted may be a machine that is switched off: then somebody else has to lead.
  if (door_ && (how == kOver || how == kQuit) && !handed_over()) door_->close(how);
  watchdog_.end();
  journal_.close(how);
}

void Surviving::join(RunDesk& desk) {
  desk.add(journal_);
  if (door_) desk.add(*door_);
}

void Surviving::beat(const ShowState& state, bool roll_called) {
  watchdog_.beat(state, roll_called);
  if (door_) door_->beat(state);
}

void Surviving::take_up(const CutOff& cut, AfterDeath policy, RunDesk& desk, LiveOptions& live) {
  live.take_up = [cut, policy, &desk](Instant now) {
    const Duration machine = machine_time();
    const AfterDeath then = cut.same_start ? policy : AfterDeath::stand;
    const TakeUp up = app::take_up(cut.place, machine, then, desk.orders().plays());
    desk.tell({RunEvent::Kind::note, cut.same_start ? up.told : "the machine was started again since: " + up.told});
    return by_clock(up.show, now, machine);
  };
}

namespace {

bool has_capability(unsigned number) {
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> capabilities{};
  return ::syscall(SYS_capget, &head, capabilities.data()) == 0 && (capabilities[0].effective & (1U << number)) != 0;
}

bool limit_is_at_least(__rlimit_resource_t which, rlim_t least) {
  rlimit limit{};
  return ::getrlimit(which, &limit) == 0 && limit.rlim_cur >= least;
}

}  // namespace

std::vector<std::string> prepare_for_real_time() {
  std::vector<std::string> refused;
  // Below a limit the next thread might get no memory. What has been used once stays: reserved address space is free.
  if (!has_capability(CAP_IPC_LOCK) && !limit_is_at_least(RLIMIT_MEMLOCK, RLIM_INFINITY)) {
    refused.emplace_back(
        "memory may be swapped out: LimitMEMLOCK=infinity in a unit, `ulimit -l unlimited` in a shell");
  } else if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    refused.push_back("memory may be swapped out: " + std::generic_category().message(errno));
  }
  if (!has_capability(CAP_SYS_NICE) && !limit_is_at_least(RLIMIT_RTPRIO, kShowPriority)) {
    refused.push_back(
        fmt::format("threads of the show do not run before others: LimitRTPRIO={} in a unit, `ulimit -r` in a shell",
                    kShowPriority));
  }
  return refused;
}

}  // namespace footlight::app
