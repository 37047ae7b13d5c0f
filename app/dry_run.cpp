// SPDX-License-Identifier: Apache-2.0
#include "app/dry_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "app/marker_watch.hpp"
#include "app/show_on_wires.hpp"
#include "app/simulated_buses.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {
namespace {

using controller::BusLoop;
using controller::BusTarget;
using controller::CuePlay;

constexpr Duration kPostRoll = milliseconds(2500);     // time for the last lamps to be right
constexpr Duration kRefresh = milliseconds(2000);      // every marker is looked at this often
constexpr Duration kCompareAhead = microseconds(200);  // before the first latch of the next switch is handed over
constexpr Duration kPaceStep = milliseconds(50);
constexpr std::size_t kShownWrong = 10;
constexpr int kMostAtOnce = 10'000;

/// One dry run under way.
class DryRun {
 public:
  DryRun(const Show& show, const Plan& plan, Rig rig, const DryRunOptions& options)
      : show_(show),
        plan_(plan),
        rig_(std::move(rig)),
        options_(options),
        simulated_(rig_, options.faults, options.seed, clock_, options.trace) {}

  Result<DryRunReport> run();

 private:
  Status<> connect();
  void tick();
  Instant next_instant() const;
  void press_go();
  void sample();
  void compare_when_due();
  void compare(std::size_t k);
  void play_to_the_end();
  [[nodiscard]] bool told_to_stop() const;
  [[nodiscard]] bool recovered() const;
  void recover();
  void say_moment(const BusTarget& target);
  void keep_pace(Instant next) const;
  [[nodiscard]] bool exempt(NodeIndex node) const;
  [[nodiscard]] LookIndex should(std::size_t k, NodeIndex node, std::size_t channel) const {
    return wires_->schedule->looks_of(k, node)[channel];
  }
  DryRunReport report();

  const Show& show_;
  const Plan& plan_;
  Rig rig_;
  const DryRunOptions& options_;
  Instant show_starts_;
  ManualClock clock_;
  sim::SimulatedRig simulated_;
  std::optional<DirectWireLog> wire_log_;
  std::optional<LoggedPorts> logged_;
  std::unique_ptr<ShowOnWires> wires_;
  std::optional<MarkerWatch> watch_;
  std::vector<Instant> wishes_;
  std::vector<sim::BusUse> use_before_;

  GoWhenWaiting go_;
  Instant sample_at_ = kNever;
  Instant compare_at_ = kNever;
  Instant ends_at_ = kNever;
  std::optional<std::size_t> compared_;
  std::optional<std::size_t> told_;
  Duration recovery_{};
  DryRunReport report_;
};

Status<> DryRun::connect() {
  if (options_.wire_log != nullptr) logged_.emplace(wire_log_.emplace(*options_.wire_log, rig_, clock_));
  auto drivers = drivers_on(simulated_, rig_, plan_, logged_ ? &*logged_ : nullptr);
  if (!drivers) return std::move(drivers).error();
  auto wires = put_on_wires(show_, plan_, rig_, std::move(drivers).value());
  if (!wires) return std::move(wires).error();
  wires_ = std::move(wires).value();
  show_starts_ = kStart + wires_->opening;
  simulated_.set_show(show_starts_, run_length(wires_->plays));
  wishes_.assign(wires_->loops.size(), kStart);
  recovery_ = 2 * kRefresh;
  for (const auto& loop : wires_->loops) recovery_ = std::max(recovery_, 2 * loop->suspect_time());
  watch_.emplace(rig_, *wires_->schedule, simulated_, wires_->latch_ahead + kCompareAhead);
  return Done{};
}

Result<DryRunReport> DryRun::run() {
  if (Status<> connected = connect(); !connected) return connected.error();
  go_ = GoWhenWaiting(show_starts_);
  play_to_the_end();
  if (told_to_stop()) return Error{ErrorKind::interrupted, "interrupted"};
  compare(wires_->schedule->switches().size() - 1);
  DryRunReport report = this->report();
  recover();
  if (told_to_stop()) return Error{ErrorKind::interrupted, "interrupted"};
  report.wrong_after_recovery = report_.wrong_after_recovery;
  return report;
}

void DryRun::play_to_the_end() {
  int at_once = 0;
  while (clock_.now() < ends_at_ && !told_to_stop()) {
    tick();
    Instant next = next_instant();
    // A driver that has more to read asks to be called again at once; time must go on all the same.
    at_once = next <= clock_.now() ? at_once + 1 : 0;
    if (at_once > kMostAtOnce) next = clock_.now() + microseconds(1);
    next = std::min(std::max(next, clock_.now()), ends_at_);
    keep_pace(next);
    simulated_.advance_to(next);
  }
}

bool DryRun::told_to_stop() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }

bool DryRun::recovered() const {
  return simulated_.faults_end() != kNever && clock_.now() >= simulated_.faults_end() + recovery_;
}

/// The show is over and its last lamps stay lit: without further faults all of them have to be right soon.
void DryRun::recover() {
  if (options_.faults == sim::Faults{}) return;
  simulated_.end_faults();
  sample_at_ = kNever;
  ends_at_ = std::max(clock_.now(), simulated_.faults_end() + recovery_);
  play_to_the_end();
  const std::size_t last = wires_->schedule->switches().size() - 1;
  watch_->for_markers([&](NodeIndex node, std::size_t channel) {
    if (!watch_->shows(node, channel, should(last, node, channel))) ++report_.wrong_after_recovery;
  });
}

void DryRun::tick() {
  const Instant now = clock_.now();
  wires_->engine->step(now);
  press_go();
  if (now >= sample_at_) sample();
  compare_when_due();
  const BusTarget target = wires_->engine->target();
  for (std::size_t b = 0; b < wires_->loops.size(); ++b) wishes_[b] = wires_->loops[b]->step(now, target);
  say_moment(target);
}

void DryRun::press_go() {
  const Instant now = clock_.now();
  if (wires_->engine->finished() && ends_at_ == kNever) ends_at_ = now + kPostRoll;
  const bool first = wires_->engine->standby() == std::size_t{0};
  if (!go_.step(*wires_->engine, now) || !first) return;
  sample_at_ = now + MarkerWatch::kSample / 2;
  for (std::size_t b = 0; b < rig_.buses.size(); ++b) use_before_.push_back(simulated_.use(BusIndex::of(b)));
}

Instant DryRun::next_instant() const {
  Instant next =
      std::min({simulated_.next_event(), wires_->engine->next_event(), go_.next(), sample_at_, compare_at_, ends_at_});
  for (const Instant wish : wishes_) next = std::min(next, wish);
  return next;
}

void DryRun::sample() {
  sample_at_ += MarkerWatch::kSample;
  watch_->sample(clock_.now(), wires_->engine->target());
  if (options_.progress) {
    const double all = std::max(1e-9, to_seconds(wires_->plays.back().to - wires_->plays.front().from));
    options_.progress(to_seconds(wires_->engine->position() - wires_->plays.front().from) / all);
  }
}

void DryRun::compare_when_due() {
  const BusTarget target = wires_->engine->target();
  compare_at_ = kNever;
  if (target.next_at == kNever || target.next == target.current || compared_ == target.current) return;
  const Instant due = target.next_at - wires_->latch_ahead - kCompareAhead;
  if (clock_.now() < due) {
    compare_at_ = due;
    return;
  }
  compare(target.current);
}

void DryRun::compare(std::size_t k) {
  compared_ = k;
  const auto& switches = wires_->schedule->switches();
  // The opening is nobody's cue: its lamps count like those of any switch.
  const bool ends_cue = k + 1 == switches.size() || (switches[k].cue && switches[k + 1].cue != switches[k].cue);
  CueReport cue;
  watch_->for_markers([&](NodeIndex node, std::size_t channel) {
    const LookIndex shown = simulated_.shown(node, static_cast<int>(channel));
    const LookIndex planned = should(k, node, channel);
    if (watch_->shows(node, channel, planned)) return;
    if (recovered()) ++report_.wrong_after_recovery;
    if (exempt(node)) {
      ++cue.exempt;
      return;
    }
    ++cue.wrong;
    if (cue.first.size() < kShownWrong) {
      cue.first.push_back({rig_.nodes[node.at()].name, static_cast<int>(channel), shown, planned});
    }
  });
  if (!ends_cue) {
    report_.late += cue.wrong;
    return;
  }
  if (switches[k].cue) {
    const CuePlay& play = wires_->plays[*switches[k].cue];
    cue.number = play.cue.number.to_text();
    cue.name = play.cue.name;
    cue.end_s = to_seconds(play.to);
  }
  report_.wrong_final += cue.wrong;
  report_.cues.push_back(std::move(cue));
}

bool DryRun::exempt(NodeIndex node) const {
  const BusLoop& loop = *wires_->loops[rig_.nodes[node.at()].bus.at()];
  return std::ranges::any_of(simulated_.reboots(), [&](const sim::Reboot& reboot) {
    return reboot.node == node && reboot.at <= clock_.now() &&
           clock_.now() <= reboot.at + loop.suspect_time() + drivers::kHeartbeatPeriod;
  });
}

void DryRun::say_moment(const BusTarget& target) {
  if (!options_.moment || told_ == target.current) return;
  told_ = target.current;
  const controller::Switch& now = wires_->schedule->switches()[target.current];
  const double count = show_.tempo.count_at(now.time);
  const std::string cue = now.cue ? wires_->plays[*now.cue].cue.number.to_text() : "-";
  options_.moment(fmt::format("{:10.3f} s  cue {:<6} {:>8}  {}", to_seconds(now.time), cue,
                              show_.tempo.measure_beat(count), now.cause));
}

void DryRun::keep_pace(Instant next) const {
  if (options_.pace == nullptr) return;
  while (options_.pace->now() < next) {
    if (told_to_stop()) return;
    std::this_thread::sleep_for(std::min(kPaceStep, next - options_.pace->now()));
  }
}

DryRunReport DryRun::report() {
  report_.switches = wires_->schedule->switches().size();
  report_.looks = wires_->schedule->looks().size();
  report_.markers = watch_->markers();
  report_.right_share = watch_->right_share();
  report_.wrong = watch_->wrong();
  report_.wrong_s = watch_->wrong_s();
  report_.recovery_s = to_seconds(recovery_);
  report_.duration_s = to_seconds(wires_->plays.back().to - wires_->plays.front().from);
  report_.run_s = to_seconds(clock_.now() - show_starts_);
  report_.confusion_before = wires_->schedule->confusion().before;
  report_.confusion_after = wires_->schedule->confusion().after;
  report_.reboots = simulated_.reboots().size();
  report_.supplies = supply_figures(*wires_->schedule, rig_, wires_->plays);
  for (const NodeIndex node : simulated_.dead()) report_.dead.push_back(rig_.nodes[node.at()].name);
  for (std::size_t b = 0; b < rig_.buses.size(); ++b) {
    const sim::BusUse use = simulated_.use(BusIndex::of(b));
    const controller::BusCounters& counters = wires_->loops[b]->counters();
    BusReport bus;
    static_cast<BusFigures&>(bus) = figures_of(rig_, BusIndex::of(b), counters, *wires_->drivers[b]);
    bus.utilisation = to_seconds(use.busy - use_before_.at(b).busy) / std::max(1e-9, report_.run_s);
    bus.frames = use.frames;
    report_.deliveries += counters.deliveries;
    report_.retries += counters.retries;
    report_.buses.push_back(std::move(bus));
  }
  return report_;
}

}  // namespace

Result<DryRunReport> dry_run(const Show& show, const Plan& plan, Rig rig, const DryRunOptions& options) {
  if (options.faults.dead > 0 && static_cast<std::size_t>(options.faults.dead) >= rig.nodes.size()) {
    return input_error(fmt::format("faults: \"dead={}\" leaves none of the rig's {} nodes (at most dead={})",
                                   options.faults.dead, rig.nodes.size(),
                                   std::max<std::size_t>(1, rig.nodes.size()) - 1));
  }
  return DryRun(show, plan, with_simulated_buses(std::move(rig)), options).run();
}

}  // namespace footlight::app
