// SPDX-License-Identifier: Apache-2.0
#include "sim/simulated_rig.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.hpp"
#include "core/patch.hpp"
#include "core/rng.hpp"
#include "sim/can_bus.hpp"
#include "sim/dmx_bus.hpp"
#include "sim/rtu_bus.hpp"
#include "sim/serial_bus.hpp"
#include "sim/simulated_bus.hpp"
#include "sim/tcp_bus.hpp"
#include "sim/trace.hpp"
#include "sim/world.hpp"

namespace footlight::sim {
namespace {

constexpr Duration kOffTime = milliseconds(300);

// Streams of the rig's generator; each bus splits its own in two.
constexpr std::uint64_t kDeadStream = 1'000'000;
constexpr std::uint64_t kRebootStream = 1'000'001;
constexpr std::uint64_t kLineStream = 1'000'002;
constexpr std::uint64_t kFaultStream = 0;
constexpr std::uint64_t kTimingStream = 1;

constexpr std::uint64_t kEndOfFaults = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kLineFault = std::uint64_t{1} << 62U;  ///< and the number of the fault

std::unique_ptr<SimulatedBus> make_bus(const Bus& bus, const Surroundings& surroundings) {
  switch (bus.kind) {
    case BusKind::serial:
      return std::make_unique<SerialBus>(bus, surroundings);
    case BusKind::modbus_rtu:
      return std::make_unique<RtuBus>(bus, surroundings);
    case BusKind::modbus_tcp:
      return std::make_unique<TcpBus>(bus, surroundings);
    case BusKind::can:
      return std::make_unique<CanBus>(bus, surroundings);
    case BusKind::dmx:
      return std::make_unique<DmxBus>(bus, surroundings);
  }
  FL_CHECK(false);
}

NodeModel bare_model_of(const Node& node, const Bus& bus) {
  const auto channels = static_cast<int>(node.channels.size());
  if (bus.kind == BusKind::dmx || bus.outputs) return {channels, false, kDark};
  if (!bus.profile) return {channels, true};
  const bool ours = bus.profile->heartbeat_register || bus.profile->status_register;
  return {channels, bus.profile->heartbeat_register.has_value(), ours ? kNoGuidance : kDark};
}

/// As it comes from commissioning: with the patch of its rig.
NodeModel model_of(const Node& node, const Bus& bus) {
  NodeModel model = bare_model_of(node, bus);
  model.keep_patch(patch_check(node));
  return model;
}

std::vector<NodeIndex> draw_dead(std::size_t nodes, int wanted, Rng rng) {
  std::vector<NodeIndex> all;
  for (std::size_t i = 0; i < nodes; ++i) all.push_back(NodeIndex::of(i));
  const std::size_t count = std::min(nodes, static_cast<std::size_t>(wanted));
  for (std::size_t i = 0; i < count; ++i) std::swap(all[i], all[i + rng.below(nodes - i)]);
  all.resize(count);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Reboot> draw_reboots(std::size_t nodes, const std::vector<NodeIndex>& dead, int wanted, Instant from,
                                 Duration length, Rng rng) {
  std::vector<NodeIndex> alive;
  for (std::size_t i = 0; i < nodes; ++i) {
    if (!std::binary_search(dead.begin(), dead.end(), NodeIndex::of(i))) alive.push_back(NodeIndex::of(i));
  }
  std::vector<Reboot> reboots;
  if (alive.empty() || length <= Duration{}) return reboots;
  for (int i = 0; i < wanted; ++i) {
    const NodeIndex node = alive[rng.below(alive.size())];
    const auto after = static_cast<Duration::rep>(rng.below(static_cast<std::uint64_t>(length.count())));
    reboots.push_back({node, from + Duration(after)});
  }
  std::stable_sort(reboots.begin(), reboots.end(), [](const Reboot& a, const Reboot& b) { return a.at < b.at; });
  return reboots;
}

struct StruckLine {
  std::size_t bus;
  LineFault fault;
  Instant at;
};

/// Of the CAN buses: no other kind of wire goes down here.
std::vector<StruckLine> draw_line_faults(const Rig& rig, const Faults& faults, Instant from, Duration length, Rng rng) {
  std::vector<std::size_t> buses;
  for (std::size_t i = 0; i < rig.buses.size(); ++i) {
    if (rig.buses[i].kind == BusKind::can) buses.push_back(i);
  }
  std::vector<StruckLine> struck;
  if (buses.empty() || length <= Duration{}) return struck;
  const auto draw = [&](LineFault fault, int wanted) {
    for (int i = 0; i < wanted; ++i) {
      const std::size_t bus = buses[rng.below(buses.size())];
      const auto after = static_cast<Duration::rep>(rng.below(static_cast<std::uint64_t>(length.count())));
      struck.push_back({bus, fault, from + Duration(after)});
    }
  };
  draw(LineFault::bus_off, faults.bus_off);
  draw(LineFault::full, faults.full);
  draw(LineFault::unplug, faults.unplug);
  return struck;
}

}  // namespace

/// Also the hand on the switches: its events take the power from nodes and give it back.
struct SimulatedRig::State final : Actor {
  struct Place {
    SimulatedBus* bus;
    std::size_t slot;
  };

  State(const Rig& rig_of_show, ManualClock& clock, std::ostream* out)
      : rig(rig_of_show), world(clock), trace(out), supply(rig_of_show.nodes.size()) {}

  void act(std::uint64_t token) override {
    if (token == kEndOfFaults) {
      end_faults();
      return;
    }
    if ((token & kLineFault) != 0) {
      const StruckLine& line = struck.at(token ^ kLineFault);
      buses.at(line.bus)->strike(line.fault);
      return;
    }
    const auto [bus, slot] = places.at(token / 2);
    Instant& back_at = supply[token / 2];
    if (token % 2 == 0) {
      bus->power_off(slot);
      back_at = world.now() + kOffTime;
      world.schedule(back_at, *this, token + 1);
    } else if (world.now() == back_at) {  // not switched off once more meanwhile
      bus->power_on(slot);
    }
  }

  void end_faults() {
    if (faults_end != kNever) return;
    faults_end = world.now();
    for (auto& bus : buses) bus->end_faults();
  }

  SimulatedBus& bus(BusIndex index, std::initializer_list<BusKind> kinds) {
    SimulatedBus& found = *buses.at(index.at());
    FL_CHECK(std::find(kinds.begin(), kinds.end(), found.bus().kind) != kinds.end());
    return found;
  }

  Rig rig;
  World world;
  Trace trace;
  std::vector<Instant> supply;  ///< by node: when the power comes back
  std::vector<std::unique_ptr<SimulatedBus>> buses;
  std::vector<Place> places;  ///< by node
  std::vector<Reboot> reboots;
  std::vector<StruckLine> struck;
  std::vector<NodeIndex> dead;
  Instant faults_end = kNever;
};

SimulatedRig::SimulatedRig(const Rig& rig, const Faults& faults, std::uint64_t seed, ManualClock& clock,
                           std::ostream* trace)
    : state_(std::make_unique<State>(rig, clock, trace)), faults_(faults), seed_(seed) {
  State& state = *state_;
  const Rng rng(seed);
  for (std::size_t i = 0; i < state.rig.buses.size(); ++i) {
    const Rng own = rng.split(i);
    state.buses.push_back(make_bus(
        state.rig.buses[i],
        {state.world, state.trace, Chance(faults, own.split(kFaultStream)), Chance(faults, own.split(kTimingStream))}));
  }
  state.dead = draw_dead(state.rig.nodes.size(), faults.dead, rng.split(kDeadStream));
  for (std::size_t i = 0; i < state.rig.nodes.size(); ++i) {
    const Node& node = state.rig.nodes[i];
    SimulatedBus& bus = *state.buses.at(node.bus.at());
    const bool is_dead = std::binary_search(state.dead.begin(), state.dead.end(), NodeIndex::of(i));
    const std::size_t slot = bus.add(std::make_unique<SimulatedNode>(node, bus.bus().name, model_of(node, bus.bus()),
                                                                     is_dead, state.world, state.trace));
    state.places.push_back({&bus, slot});
  }
  for (auto& bus : state.buses) bus->begin();
}

void SimulatedRig::set_show(Instant start, Duration length) {
  State& state = *state_;
  FL_CHECK(state.reboots.empty() && start >= state.world.now());
  const Duration faulty(static_cast<Duration::rep>(std::round(static_cast<double>(length.count()) * faults_.until)));
  if (faults_.until < 1) state.world.schedule(start + faulty, state, kEndOfFaults);
  state.reboots =
      draw_reboots(state.rig.nodes.size(), state.dead, faults_.reboot, start, faulty, Rng(seed_).split(kRebootStream));
  for (const Reboot& reboot : state.reboots) {
    state.world.schedule(reboot.at, state, 2 * std::uint64_t{reboot.node.value()});
  }
  state.struck = draw_line_faults(state.rig, faults_, start, faulty, Rng(seed_).split(kLineStream));
  for (std::size_t i = 0; i < state.struck.size(); ++i) {
    state.world.schedule(state.struck[i].at, state, kLineFault | i);
  }
}

SimulatedRig::~SimulatedRig() = default;

drivers::ByteStream& SimulatedRig::serial(BusIndex bus) {
  return dynamic_cast<drivers::ByteStream&>(state_->bus(bus, {BusKind::serial, BusKind::dmx}));
}

drivers::CanPort& SimulatedRig::can(BusIndex bus) {
  return dynamic_cast<drivers::CanPort&>(state_->bus(bus, {BusKind::can}));
}

drivers::ModbusPort& SimulatedRig::modbus(BusIndex bus) {
  return dynamic_cast<drivers::ModbusPort&>(state_->bus(bus, {BusKind::modbus_rtu, BusKind::modbus_tcp}));
}

ModbusLine& SimulatedRig::modbus_line(BusIndex bus) {
  return dynamic_cast<ModbusLine&>(state_->bus(bus, {BusKind::modbus_rtu, BusKind::modbus_tcp}));
}

Instant SimulatedRig::next_event() const { return state_->world.next(); }

void SimulatedRig::advance_to(Instant instant) { state_->world.advance_to(instant); }

LookIndex SimulatedRig::shown(NodeIndex node, int channel) const {
  const auto [bus, slot] = state_->places.at(node.at());
  FL_CHECK(channel >= 0 && channel < static_cast<int>(state_->rig.nodes[node.at()].channels.size()));
  return bus->node(slot).shown(channel);
}

Look SimulatedRig::lamp(NodeIndex node, int channel) const {
  const auto [bus, slot] = state_->places.at(node.at());
  if (!bus->node(slot).powered()) return Look{{}, Effect::steady, 0};
  if (const auto* dmx = dynamic_cast<const DmxBus*>(bus)) {
    const Colour colour = dmx->colour(slot, channel);
    return Look{colour, Effect::steady, static_cast<std::uint8_t>(colour == Colour{} ? 0 : 255)};
  }
  const NodeModel& model = bus->node(slot).model();
  if (bus->bus().outputs) {
    const bool lit = model.shown(channel) != 0;
    return Look{lit ? Colour{255, 255, 255} : Colour{}, Effect::steady, static_cast<std::uint8_t>(lit ? 255 : 0)};
  }
  if (model.identifying(state_->world.now())) return Look{{255, 255, 255}, Effect::blink, 255};
  return model.look(model.shown(channel));
}

const NodeContent& SimulatedRig::content(NodeIndex node, int channel) const {
  const auto [bus, slot] = state_->places.at(node.at());
  return bus->node(slot).model().content(channel);
}

std::optional<int> SimulatedRig::counts_left(NodeIndex node, int channel) const {
  const auto [bus, slot] = state_->places.at(node.at());
  return bus->node(slot).model().counts_left(channel, state_->world.now());
}

std::vector<std::uint8_t> SimulatedRig::levels(NodeIndex node, int channel) const {
  const auto [bus, slot] = state_->places.at(node.at());
  const auto* dmx = dynamic_cast<const DmxBus*>(bus);
  FL_CHECK(dmx != nullptr);
  return dmx->levels(slot, channel);
}

void SimulatedRig::end_faults() { state_->end_faults(); }

Instant SimulatedRig::faults_end() const { return state_->faults_end; }

bool SimulatedRig::strike(BusIndex bus, LineFault fault) { return state_->buses.at(bus.at())->strike(fault); }

bool SimulatedRig::powered(NodeIndex node) const {
  const auto [bus, slot] = state_->places.at(node.at());
  return bus->node(slot).powered();
}

bool SimulatedRig::holds(NodeIndex node) const {
  const auto [bus, slot] = state_->places.at(node.at());
  return bus->node(slot).model().state() == NodeState::hold;
}

BusUse SimulatedRig::use(BusIndex bus) const { return state_->buses.at(bus.at())->use(); }

const std::vector<Reboot>& SimulatedRig::reboots() const { return state_->reboots; }

const std::vector<NodeIndex>& SimulatedRig::dead() const { return state_->dead; }

}  // namespace footlight::sim
