// SPDX-License-Identifier: Apache-2.0
#include "app/commission/floor_lights.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "app/simulated_buses.hpp"
#include "core/plan.hpp"

namespace footlight::app {
namespace {

constexpr std::uint8_t kPlanByte = 0;  // no show is on the bus
constexpr Duration kPublish = milliseconds(20);
constexpr Duration kLook = milliseconds(20);
constexpr Duration kLeastNotice = milliseconds(30);
constexpr int kMostAtOnce = 10'000;

}  // namespace

FloorLights::FloorLights(Rig rig, const std::atomic<bool>* stop) : rig_(std::move(rig)), stop_(stop) {}

FloorLights::~FloorLights() { stop_threads(); }

Result<std::unique_ptr<FloorLights>> FloorLights::open(const Rig& rig, const Choice& choice,
                                                       const std::atomic<bool>* stop) {
  std::unique_ptr<FloorLights> made(new FloorLights(rig, stop));
  if (auto connected = made->connect(choice); !connected) return std::move(connected).error();
  return made;
}

Status<> FloorLights::connect(const Choice& choice) {
  if (choice.simulated) {
    rig_ = with_simulated_buses(std::move(rig_));
    simulated_ = std::make_unique<sim::SimulatedRig>(rig_, choice.faults, choice.seed, virtual_time_, nullptr);
    auto drivers = drivers_on(*simulated_, rig_, Plan{});
    if (!drivers) return std::move(drivers).error();
    drivers_ = std::move(drivers).value();
    return Done{};
  }
  std::string refused;
  ErrorKind kind = ErrorKind::input;
  for (std::size_t b = 0; b < rig_.buses.size(); ++b) {
    const auto nodes = drivers::node_addresses(rig_, BusIndex::of(b));
    auto port = drivers::open_port(rig_.buses[b], nodes);
    if (!port) {
      refused += (refused.empty() ? "" : "\n") + port.error().message;
      if (port.error().kind == ErrorKind::device) kind = ErrorKind::device;
      continue;
    }
    auto driver = drivers::make_driver(rig_.buses[b], nodes, kPlanByte, drivers::reference(*port));
    if (!driver) return std::move(driver).error();
    ports_.push_back(std::move(port).value());
    drivers_.push_back(std::move(driver).value());
  }
  if (!refused.empty()) return Error{kind, refused};
  return Done{};
}

bool FloorLights::stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

Instant FloorLights::now() const { return simulated_ ? virtual_time_.now() : real_time_.now(); }

void FloorLights::stop_threads() {
  for (const auto& thread : threads_) thread->stop();
  threads_.clear();
}

void FloorLights::load(controller::CueSchedule schedule) {
  stop_threads();
  loops_.clear();
  schedule_.emplace(std::move(schedule));
  target_ = {};
  notice_ = kLeastNotice;
  for (std::size_t b = 0; b < rig_.buses.size(); ++b) {
    const auto nodes = drivers::node_addresses(rig_, BusIndex::of(b));
    Duration most = 4 * drivers_[b]->latch_time();
    for (const auto& node : nodes) most = std::max(most, 4 * drivers_[b]->preload_time(node.channels));
    notice_ = std::max(notice_, most + kLeastNotice);
    loops_.push_back(std::make_unique<controller::BusLoop>(*schedule_, nodes, *drivers_[b]));
  }
  if (simulated_) return;
  publish(now());
  for (std::size_t b = 0; b < loops_.size(); ++b) {
    threads_.push_back(std::make_unique<BusThread>(*loops_[b], drivers::reference(ports_[b]), shared_, real_time_,
                                                   schedule_->switches().size()));
    threads_.back()->start();
  }
}

void FloorLights::light(std::size_t k, Instant at) {
  target_.next = k;
  target_.next_at = std::max(at, now());
  if (k == target_.current) target_.next_at = kNever;
  if (!simulated_) {
    publish(now());
    for (const auto& thread : threads_) thread->wake();
  }
}

void FloorLights::publish(Instant now) {
  if (now >= target_.next_at) {
    target_.current = target_.next;
    target_.next_at = kNever;
  }
  if (!simulated_) shared_.publish(target_, now);
}

bool FloorLights::run_until(Instant until, const std::function<void(Instant)>& see) {
  if (!simulated_) return run_real(until);
  int at_once = 0;
  while (!stopped()) {
    const Instant now = virtual_time_.now();
    publish(now);
    Instant next = std::min(target_.next_at, until);
    for (const auto& loop : loops_) next = std::min(next, loop->step(now, target_));
    if (see) see(now);
    if (now >= until) return true;
    next = std::min(next, simulated_->next_event());
    // A driver that has more to read asks to be called again at once; time must go on all the same.
    at_once = next <= now ? at_once + 1 : 0;
    if (at_once > kMostAtOnce) next = now + microseconds(1);
    simulated_->advance_to(std::clamp(next, now, std::max(now, until)));
  }
  return false;
}

bool FloorLights::run_real(Instant until) {
  while (!stopped()) {
    const Instant now = real_time_.now();
    publish(now);
    if (now >= until) return true;
    std::this_thread::sleep_for(std::min({kPublish, until - now, std::max(Duration(1), target_.next_at - now)}));
  }
  return false;
}

bool FloorLights::settled() const {
  if (simulated_) return std::ranges::all_of(loops_, [](const auto& loop) { return loop->settled(); });
  return std::ranges::all_of(threads_, [](const auto& thread) { return thread->settled(); });
}

bool FloorLights::settle(Duration at_most) {
  const Instant until = now() + at_most;
  // At least once: a loop that has not seen the target yet is as settled as it was.
  do {
    if (!run_until(std::min(until, now() + kLook))) return false;
  } while (now() < until && !settled());
  return true;
}

std::size_t FloorLights::unconfirmed() const {
  std::size_t sum = 0;
  if (simulated_) {
    for (const auto& loop : loops_) sum += loop->unconfirmed();
  } else {
    for (const auto& thread : threads_) sum += thread->unconfirmed();
  }
  return sum;
}

std::vector<std::string> FloorLights::troubles() const {
  std::vector<std::string> out;
  for (std::size_t b = 0; b < ports_.size(); ++b) {
    const std::string trouble = drivers::trouble_of(drivers::reference(ports_[b]));
    if (!trouble.empty()) out.push_back("bus \"" + rig_.buses[b].name + "\": " + trouble);
  }
  return out;
}

}  // namespace footlight::app
