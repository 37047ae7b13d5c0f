// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_run.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/live/bare_timer.hpp"
#include "app/live/bus_thread.hpp"
#include "app/live/cue_thread.hpp"
#include "app/live/mutings.hpp"
#include "app/live/plays_in_turn.hpp"
#include "app/live/reset_moves.hpp"
#include "app/live/shared_target.hpp"
#include "app/show_on_wires.hpp"
#include "app/wire_log/logged_ports.hpp"
#include "controller/bus_budget.hpp"
#include "controller/lateness.hpp"
#include "controller/plan_check.hpp"
#include "controller/rehearsal.hpp"
#include "controller/stands.hpp"
#include "controller/tempo_limit.hpp"
#include "core/clock.hpp"
#include "drivers/leading.hpp"

namespace footlight::app {
namespace {

using controller::BusTarget;
using controller::Lateness;

constexpr Duration kDeadLead = milliseconds(4000);  // longer than any lease
constexpr Duration kLookOn = milliseconds(20);
constexpr Duration kLoadEvery = milliseconds(1000);
constexpr Duration kPostRoll = milliseconds(2500);  // time for the last lamps to be right

LatenessReport report_of(const Lateness& lateness) {
  const auto ms = [](Duration duration) { return to_seconds(duration) * 1e3; };
  return {lateness.count(), ms(lateness.quantile(0.5)), ms(lateness.quantile(0.99)), ms(lateness.quantile(0.999)),
          ms(lateness.worst())};
}

/// One run: the threads, and what the calling thread sees of them.
class LiveRun {
 public:
  LiveRun(const Show& show, const Plan& plan, const Rig& rig, ShowOnWires& wires,
          const std::vector<drivers::Port>& ports, const LiveOptions& options, const drivers::Leadership& leadership,
          const LoggedPorts* logged)
      : show_(show),
        plan_(plan),
        rig_(rig),
        wires_(wires),
        options_(options),
        leadership_(leadership),
        logged_(logged),
        plans_(wires, show.tempo, controller::Stands(plan), options.rehearsal),
        cue_(plans_.rehearsal(), show.time, target_, clock_) {
    resets_.emplace(show, rig, *wires.schedule, options.plan_way);
    mutings_.emplace(show, plan, rig, *wires.schedule);
    for (std::size_t b = 0; b < rig.buses.size(); ++b) {
      ports_.push_back(drivers::reference(ports[b]));
      threads_.push_back(std::make_unique<BusThread>(*wires.loops[b], ports_.back(), target_, clock_,
                                                     wires.schedule->switches().size()));
      const auto nodes = static_cast<std::size_t>(std::ranges::count(rig.nodes, BusIndex::of(b), &Node::bus));
      buses_.push_back({rig.buses[b].name, nodes, nodes});
      carried_.emplace_back();
      if (options.nodes != nullptr) threads_.back()->tell(*options.nodes);
    }
  }

  Result<LiveReport> play();

 private:
  [[nodiscard]] bool stopped() const {
    return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::size_t unconfirmed() const {
    std::size_t sum = 0;
    for (const auto& bus : threads_) sum += bus->unconfirmed();
    return sum;
  }
  [[nodiscard]] bool settled() const {
    return std::ranges::all_of(threads_, [](const auto& bus) { return bus->settled(); });
  }
  void start_heart();
  void stop_heart();
  void wait() const;
  void look_on();
  void look_for_others();
  void listen_to_the_desk();
  void look_at_buses();
  void tell(const controller::Command& command);
  [[nodiscard]] bool over() const;
  void call_the_roll();
  [[nodiscard]] const controller::Switch& switch_of(std::size_t k) const;
  void say_moment(const BusTarget& target);
  LiveReport report(const BareTimer& bare, Duration run);
  LiveBusReport report_bus(std::size_t b, Duration run) const;
  void change_plan();
  /// @param times of a bus, one for each switch; null: it has not gone over to the plan
  void add_switches(std::size_t switches, const std::function<const std::vector<SwitchTimes>*(std::size_t bus)>& times,
                    LiveReport& report) const;
  [[nodiscard]] const std::vector<SwitchTimes>* times_of(std::size_t b) const {
    return threads_[b]->plan() == plans_.number() ? &threads_[b]->times() : nullptr;
  }
  void report_cues(LiveReport& report) const;
  void report_floor(LiveReport& report) const;

  const Show& show_;
  const Plan& plan_;
  const Rig& rig_;
  ShowOnWires& wires_;
  std::vector<drivers::PortReference> ports_;
  const LiveOptions& options_;
  const drivers::Leadership& leadership_;
  const LoggedPorts* logged_;  ///< null: nobody reckons what the wires carry
  SteadyClock clock_;
  SharedTarget target_;
  PlaysInTurn plans_;
  CueThread cue_;
  std::optional<ResetMoves> resets_;
  std::optional<Mutings> mutings_;
  std::optional<std::vector<bool>> muted_;  ///< that is wanted
  LiveReport over_;                         ///< figures of the switches of plans before
  std::vector<std::unique_ptr<BusThread>> threads_;
  Lateness wake_;
  std::atomic<bool> roll_called_{false};
  std::atomic<bool> beats_{false};
  std::thread heart_;
  std::size_t told_ = 0;
  ShowState state_;
  std::vector<BusView> buses_;
  std::vector<Duration> carried_;  ///< by each wire, when its load was reckoned last
  Instant load_at_{};
  std::shared_ptr<const Plan> way_;
  bool ended_ = false;        ///< by the desk
  bool stands_back_ = false;  ///< markers follow another controller
  std::uint64_t fenced_before_ = 0;
  std::uint32_t led_plan_ = 0;  ///< SharedTarget::Told::plan
  Instant led_since_ = kStart;  ///< of that plan
  bool nobody_ = true;          ///< is left at the desk
};

Result<LiveReport> LiveRun::play() {
  if (options_.clock) options_.clock(clock_);
  const Instant began = clock_.now();
  BareTimer bare(clock_);
  controller::Rehearsal& rehearsal = plans_.rehearsal();
  if (options_.take_up) {
    cue_.take_up(options_.take_up(clock_.now()), clock_.now());
  } else if (options_.position) {
    rehearsal.begin_at(*options_.position);
  }
  told_ = rehearsal.target().current;  // what was lit before was told before
  cue_.start([this] {
    for (const auto& bus : threads_) bus->wake();
  });
  for (const auto& bus : threads_) bus->start();
  start_heart();
  Instant ends_at = kNever;
  while (!stopped() && !ended_ && !stands_back_ && clock_.now() < ends_at) {
    wait();
    look_on();
    if (!over()) {
      ends_at = kNever;
      continue;
    }
    if (ends_at == kNever) ends_at = clock_.now() + kPostRoll;
    if (unconfirmed() == 0 && settled()) break;
  }
  stop_heart();
  const Duration run = clock_.now() - began;
  cue_.stop();
  for (const auto& bus : threads_) bus->stop();
  bare.stop();
  if (stands_back_) {
    return refusal(
        "another controller leads these markers under a newer epoch: this one has stood back, and sends nothing more");
  }
  if (stopped())
    return Error{ErrorKind::interrupted, "interrupted: the lamps keep what they show until their lease ends"};
  return report(bare, run);
}

void LiveRun::start_heart() {
  if (!options_.heartbeat) return;
  beats_.store(true);
  heart_ = std::thread([this] {
    while (beats_.load()) {
      options_.heartbeat(cue_.state(), roll_called_.load());
      std::this_thread::sleep_for(kLookOn);
    }
  });
}

void LiveRun::stop_heart() {
  beats_.store(false);
  if (heart_.joinable()) heart_.join();
}

void LiveRun::wait() const {
  if (options_.wait) return options_.wait(kLookOn);
  std::this_thread::sleep_for(kLookOn);
}

/// Nobody can want anything of the show any more.
bool LiveRun::over() const {
  return nobody_ && state_.phase == controller::Rehearsal::Phase::finished &&
         state_.reset.state == controller::Rehearsal::ResetState::none;
}

/// In the beginning the fence may be that of a controller that has just died, and ends with its lease; and nodes that
/// have not heard yet of another plan refuse its frames.
void LiveRun::look_for_others() {
  const std::uint64_t fenced = leadership_.refusals.load(std::memory_order_relaxed);
  if (const std::uint32_t plan = cue_.state().plan; plan != led_plan_) {
    led_plan_ = plan;
    led_since_ = clock_.now();
  }
  stands_back_ = fenced > fenced_before_ && clock_.now() > led_since_ + kDeadLead;
  fenced_before_ = fenced;
}

void LiveRun::look_on() {
  look_for_others();
  if (!roll_called_) call_the_roll();
  change_plan();
  const ShowState now = cue_.state();
  if (now.plan != plans_.number()) return;  // the cue thread has just gone over to another plan
  state_ = now;
  listen_to_the_desk();
  if (const auto news = resets_->look(state_.reset)) {
    way_ = news->way;
    tell(news->command);
    if (options_.reset) options_.reset(news->text);
  }
  while (const auto answer = cue_.answer()) {
    if (options_.answered) options_.answered(*answer);
  }
  say_moment(state_.target);
  if (!options_.progress) return;
  const auto& plays = plans_.show().plays;
  const Duration from = plays.front().from.time_since_epoch();
  const Duration to = plays.back().to.time_since_epoch();
  const Duration position = state_.position.time_since_epoch();
  options_.progress(to_seconds(position - from) / std::max(1e-9, to_seconds(to - from)), unconfirmed());
}

void LiveRun::change_plan() {
  if (options_.changes == nullptr) return;
  const auto over = [this](std::size_t switches, const auto& times) {
    add_switches(
        switches, [&](std::size_t b) { return &times(b); }, over_);
  };
  if (!plans_.look(*options_.changes, state_, cue_, threads_, over)) return;
  resets_.reset();  // they may be reading the show
  mutings_.reset();
  options_.changes->taken(plans_.show());
  resets_.emplace(show_, rig_, *plans_.show().schedule, options_.plan_way);
  mutings_.emplace(show_, plan_, rig_, *plans_.show().schedule);
  if (muted_) mutings_->want(*muted_);
  way_ = plans_.way();
  told_ = plans_.show().schedule->plain(cue_.state().target.current);
}

void LiveRun::listen_to_the_desk() {
  if (!options_.desk) return;
  look_at_buses();
  const DeskWishes wishes =
      options_.desk({state_, roll_called_.load(), buses_, &*plans_.show().schedule, way_, clock_.now()});
  cue_.set_bars(wishes.bars);
  for (const controller::Command& command : wishes.commands) tell(command);
  if (wishes.muted) {
    muted_ = wishes.muted;
    mutings_->want(*muted_);
  }
  if (const auto command = mutings_->look()) tell(*command);
  ended_ = wishes.ends;
  nobody_ = wishes.nobody;
}

void LiveRun::look_at_buses() {
  const Instant now = clock_.now();
  const bool reckon = logged_ != nullptr && now - load_at_ >= kLoadEvery;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    const BusThread::Word word = threads_[b]->word();
    buses_[b].unconfirmed = threads_[b]->unconfirmed();
    buses_[b].quarantined = threads_[b]->quarantined();
    buses_[b].counters = word.counters;
    buses_[b].trouble = word.trouble.data();
    if (word.confirmed_after > Duration{}) buses_[b].confirmed_after = word.confirmed_after;
    if (!reckon) continue;
    const Duration carried = logged_->carried(b);
    buses_[b].load = to_seconds(carried - std::exchange(carried_[b], carried)) / to_seconds(now - load_at_);
  }
  if (reckon) load_at_ = now;
}

void LiveRun::tell(const controller::Command& command) {
  if (!cue_.tell(command) && options_.answered) {
    options_.answered({command, controller::Outcome::lost, clock_.now()});
  }
}

void LiveRun::call_the_roll() {
  if (!settled() && clock_.now() < kStart + wires_.opening) return;
  roll_called_ = true;
  if (options_.ready) options_.ready(unconfirmed());
  if (options_.go) cue_.press_go_whenever_it_waits();
}

const controller::Switch& LiveRun::switch_of(std::size_t k) const {
  const auto& switches = plans_.show().schedule->switches();
  if (k < switches.size()) return switches[k];
  return plans_.show().schedule->reset_of(k).switches[(k - switches.size()) %
                                                      controller::CueSchedule::kMostResetSwitches];
}

void LiveRun::say_moment(const BusTarget& target) {
  const std::size_t lit = plans_.show().schedule->plain(target.current);
  if (lit == told_) return;
  const auto& switches = plans_.show().schedule->switches();
  // What was passed since the last look is told, too; a reset move and a jump are places of their own.
  const bool on = told_ < lit && lit < switches.size();
  std::size_t k = on ? told_ + 1 : lit;
  told_ = lit;
  for (; options_.moment && k <= lit; ++k) {
    const controller::Switch& now = switch_of(k);
    const bool reset = k >= switches.size();
    const std::string cue = now.cue && !reset ? "cue " + plans_.show().plays[*now.cue].cue.number.to_text() : "";
    const std::string measure = reset ? "" : show_.tempo.measure_beat(show_.tempo.count_at(now.time));
    options_.moment(
        fmt::format("{:10.3f} s  {:<10} {:>8}  {}", to_seconds(now.time), reset ? "reset" : cue, measure, now.cause));
  }
}

LiveReport LiveRun::report(const BareTimer& bare, Duration run) {
  LiveReport out;
  out.switches = plans_.show().schedule->switches().size();
  for (const Node& node : rig_.nodes) {
    out.markers += static_cast<std::uint64_t>(std::ranges::count_if(
        node.channels, [](const Channel& channel) { return channel.kind != Channel::Kind::unused; }));
  }
  out.duration_s = to_seconds(plans_.show().plays.back().to - plans_.show().plays.front().from);
  out.run_s = to_seconds(run);
  out.finished = state_.phase == controller::Rehearsal::Phase::finished;
  out.real_time = cue_.real_time();
  for (std::size_t b = 0; b < threads_.size(); ++b) {
    LiveBusReport bus = report_bus(b, run);
    out.deliveries += bus.deliveries + bus.unverified;
    out.retries += bus.retries;
    out.late_latches += bus.late_latches;
    out.unconfirmed += bus.unconfirmed;
    out.deaf += threads_[b]->deaf();
    out.real_time = out.real_time && threads_[b]->real_time();
    wake_.add(threads_[b]->wake_lateness());
    out.buses.push_back(std::move(bus));
  }
  out.wake = report_of(wake_);
  out.bare = report_of(bare.lateness());
  out.late = over_.late;
  out.worst_skew_ms = over_.worst_skew_ms;
  add_switches(
      out.switches, [this](std::size_t b) { return times_of(b); }, out);
  report_cues(out);
  report_floor(out);
  return out;
}

LiveBusReport LiveRun::report_bus(std::size_t b, Duration run) const {
  const BusThread& thread = *threads_[b];
  LiveBusReport bus;
  static_cast<BusFigures&>(bus) = figures_of(rig_, BusIndex::of(b), thread.loop().counters(), *wires_.drivers[b]);
  bus.url = rig_.buses[b].url;
  bus.trouble = drivers::trouble_of(ports_[b]);
  bus.latch = report_of(thread.loop().lateness());
  bus.wake = report_of(thread.wake_lateness());
  bus.cpu_share = to_seconds(thread.cpu()) / std::max(1e-9, to_seconds(run));
  bus.unconfirmed = thread.unconfirmed();
  for (const NodeIndex node : thread.loop().quarantined()) bus.silent.push_back(rig_.nodes[node.at()].name);
  return bus;
}

void LiveRun::add_switches(std::size_t switches,
                           const std::function<const std::vector<SwitchTimes>*(std::size_t bus)>& times,
                           LiveReport& report) const {
  for (std::size_t k = 0; k < switches; ++k) {
    Instant first = kNever;
    Instant last = kStart;
    for (std::size_t b = 0; b < threads_.size(); ++b) {
      const auto* noted = times(b);
      if (noted == nullptr) continue;
      const SwitchTimes& one = (*noted)[k];
      if (k + 1 < switches) report.late += one.unconfirmed;
      if (one.latched == kNever) continue;
      const Instant lit = one.latched + wires_.drivers[b]->latch_time();
      first = std::min(first, lit);
      last = std::max(last, lit);
    }
    if (first != kNever) report.worst_skew_ms = std::max(report.worst_skew_ms, to_seconds(last - first) * 1e3);
  }
}

void LiveRun::report_cues(LiveReport& report) const {
  const auto& switches = plans_.show().schedule->switches();
  for (std::size_t c = 0; c < plans_.show().plays.size(); ++c) {
    LiveCueReport cue;
    cue.number = plans_.show().plays[c].cue.number.to_text();
    cue.name = plans_.show().plays[c].cue.name;
    const auto of_cue = [c](const controller::Switch& one) { return one.cue == c; };
    const auto first = std::ranges::find_if(switches, of_cue);
    if (first != switches.end()) {
      const auto k = static_cast<std::size_t>(first - switches.begin());
      const auto end = k + static_cast<std::size_t>(std::ranges::count_if(switches, of_cue)) - 1;
      for (std::size_t b = 0; b < threads_.size(); ++b) {
        const auto* times = times_of(b);
        if (times == nullptr) continue;
        const Instant latched = (*times)[k].latched;
        if (cue_.go_at()[c] != kNever && latched != kNever) {
          const Duration lit = latched + wires_.drivers[b]->latch_time() - cue_.go_at()[c];
          cue.go_to_last_lamp_ms = std::max(cue.go_to_last_lamp_ms, to_seconds(lit) * 1e3);
        }
        cue.unconfirmed += end + 1 == switches.size() ? threads_[b]->unconfirmed() : (*times)[end].unconfirmed;
      }
    }
    report.cues.push_back(std::move(cue));
  }
}

void LiveRun::report_floor(LiveReport& report) const {
  const std::size_t lit = target_.read().target.current;
  for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
    const auto looks = plans_.show().schedule->looks_of(lit, NodeIndex::of(n));
    report.floor.emplace_back(looks.begin(),
                              looks.begin() + static_cast<std::ptrdiff_t>(rig_.nodes[n].channels.size()));
  }
}

}  // namespace

Result<LiveReport> live_run(const Show& show, const Plan& plan, const Rig& rig, const std::vector<drivers::Port>& ports,
                            const LiveOptions& options) {
  drivers::Leadership leadership;
  leadership.epoch = options.epoch;
  std::vector<std::unique_ptr<drivers::Driver>> drivers;
  std::optional<LoggedPorts> logged;
  if (options.wire_log != nullptr) logged.emplace(*options.wire_log);
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    drivers::PortReference port = drivers::reference(ports[b]);
    if (logged) port = logged->before(b, rig.buses[b].kind, port);
    auto driver = drivers::make_leading_driver(rig.buses[b], drivers::node_addresses(rig, BusIndex::of(b)),
                                               controller::plan_byte_of(plan), port, leadership);
    if (!driver) return std::move(driver).error();
    drivers.push_back(std::move(driver).value());
  }
  auto wires = put_on_wires(show, plan, rig, std::move(drivers), true);
  if (!wires) return std::move(wires).error();
  const auto limits = limit_tempo(show, plan, rig, **wires, **wires);
  if (options.limits) options.limits(limits);
  if (options.changes != nullptr) options.changes->begin(**wires);
  auto report = LiveRun(show, plan, rig, **wires, ports, options, leadership, logged ? &*logged : nullptr).play();
  if (options.changes != nullptr) options.changes->end();
  return report;
}

}  // namespace footlight::app
