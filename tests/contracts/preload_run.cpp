// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/preload_run.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include "controller/bus_loop.hpp"
#include "core/check.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "sim/can_bits.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::contracts {
namespace {

using controller::BusTarget;
using controller::CueSchedule;

constexpr std::size_t kLeastPreload = 40;  // bytes; every other request is shorter

Rig rig_of(BusKind kind, int bits_per_second, int nodes) {
  Rig rig;
  rig.buses.push_back({"b", kind, "sim://b", bits_per_second, std::nullopt, {}});
  for (int i = 1; i <= nodes; ++i) {
    rig.nodes.push_back({"n" + std::to_string(i), BusIndex(0), i, std::vector<Channel>(kChannelsPerNode), {}});
  }
  return rig;
}

/// Two switches, the second by GO.
CueSchedule schedule_of(int nodes) {
  std::vector<Look> looks(3, Look{{9, 9, 9}, Effect::steady, 255});
  std::vector<controller::Switch> switches{{kStart, "first", false, std::nullopt},
                                           {kStart + seconds(1'000), "second", false, std::nullopt}};
  std::vector<LookIndex> table;
  for (const LookIndex look : {LookIndex{1}, LookIndex{2}}) {
    table.insert(table.end(), static_cast<std::size_t>(nodes) * kChannelsPerNode, look);
  }
  return CueSchedule(std::move(looks), std::move(switches), static_cast<std::size_t>(nodes), std::move(table), 0, {});
}

/// One frame of the trace.
struct Heard {
  char direction = ' ';
  Instant end;
  std::size_t bytes = 0;
};

std::vector<Heard> frames_in(const std::string& trace) {
  std::vector<Heard> frames;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    double now_us = 0;
    std::string bus;
    std::string hex;
    Heard frame;
    words >> now_us >> bus >> frame.direction >> hex;
    frame.end = kStart + seconds(now_us * 1e-6);
    frame.bytes = hex.size() / 2;
    if (frame.direction == '>' || frame.direction == '<') frames.push_back(frame);
  }
  return frames;
}

PreloadRun measure(const std::vector<Heard>& frames, const Bus& bus) {
  const auto time_of = [&](std::size_t characters) {
    const auto bits = static_cast<Duration::rep>(characters) * bus.bits_per_character();
    return Duration(bits * 1'000'000'000 / bus.bits_per_second);
  };
  const bool rtu = bus.kind == BusKind::modbus_rtu;
  const Duration silence = rtu ? drivers::rtu_silence(bus.bits_per_second, bus.bits_per_character()) : Duration{};
  PreloadRun run;
  Instant begin = kNever;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const Heard& preload = frames[i];
    const Heard& receipt = frames[i + 1];
    if (preload.direction != '>' || preload.bytes < kLeastPreload || receipt.direction != '<') continue;
    const Duration asking = time_of(preload.bytes);
    // From the last bit of the preload to that of the receipt: the node's pause, of which the silence is a part.
    const Duration answering = receipt.end - preload.end;
    begin = std::min(begin, preload.end - asking);
    run.elapsed = receipt.end - begin;
    run.on_wire += asking + time_of(receipt.bytes);
    run.allowed += (run.receipts == 0 ? Duration{} : silence) + asking + answering;
    ++run.receipts;
  }
  return run;
}

/// The frame of a line of the trace, as "207#0102".
drivers::CanFrame can_frame(const std::string& text) {
  drivers::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(std::stoul(text.substr(0, 3), nullptr, 16));
  for (std::size_t at = 4; at + 1 < text.size(); at += 2) {
    frame.data.at(frame.length++) = static_cast<std::uint8_t>(std::stoul(text.substr(at, 2), nullptr, 16));
  }
  return frame;
}

/// CAN has no receipts and no pauses: what the line allows is its frames, nodes' heartbeats among them.
PreloadRun measure_can(const std::string& trace, const Bus& bus, int nodes) {
  constexpr int kFramesPerNode = 4;
  PreloadRun run;
  std::istringstream lines(trace);
  Instant begin = kNever;
  int preloads = 0;
  for (std::string line; preloads < kFramesPerNode * nodes && std::getline(lines, line);) {
    std::istringstream words(line);
    double now_us = 0;
    std::string name;
    std::string direction;
    std::string text;
    words >> now_us >> name >> direction >> text;
    if (direction != ">" && direction != "<") continue;
    const drivers::CanFrame frame = can_frame(text);
    const int function = frame.id >> 7U;
    const bool is_preload = direction == ">" && function >= 4 && function <= 10 && function % 2 == 0;
    const int bits = sim::can_frame_bits(frame) + sim::kCanInterframeBits;
    const Duration taken(std::int64_t{bits} * 1'000'000'000 / bus.bits_per_second);
    if (is_preload && preloads == 0) begin = kStart + seconds(now_us * 1e-6) - taken;
    if (begin == kNever) continue;
    run.allowed += taken;
    if (!is_preload) continue;
    ++preloads;
    run.on_wire += taken;
    run.elapsed = kStart + seconds(now_us * 1e-6) - begin;
  }
  run.receipts = preloads / kFramesPerNode;
  return run;
}

}  // namespace

PreloadRun preload_all(BusKind kind, int bits_per_second, int nodes) {
  const Rig rig = rig_of(kind, bits_per_second, nodes);
  ManualClock clock;
  std::ostringstream trace;
  sim::SimulatedRig simulated(rig, {}, 1, clock, &trace);
  simulated.set_show(kStart, seconds(1'000));
  drivers::PortReference port;
  if (kind == BusKind::serial) {
    port = &simulated.serial(BusIndex(0));
  } else if (kind == BusKind::can) {
    port = &simulated.can(BusIndex(0));
  } else {
    port = &simulated.modbus(BusIndex(0));
  }
  const auto addresses = drivers::node_addresses(rig, BusIndex(0));
  auto driver = drivers::make_driver(rig.buses[0], addresses, 0xA3, port).value();
  const CueSchedule schedule = schedule_of(nodes);
  controller::BusLoop loop(schedule, addresses, *driver);
  BusTarget target;
  const auto step = [&] {
    const Instant wish = loop.step(clock.now(), target);
    simulated.advance_to(std::max(clock.now(), std::min(wish, simulated.next_event())));
  };
  while (!loop.settled()) {
    step();
    FL_CHECK(clock.now() < kStart + seconds(500));
  }
  trace.str("");
  target.next = 1;  // at a GO that does not come
  // A SYNC takes whatever is there, so CANopen preloads when the moment is near, not sooner.
  if (kind == BusKind::can) target.next_at = clock.now() + seconds(10);
  for (const Instant end = clock.now() + seconds(kind == BusKind::can ? 10 : 20); clock.now() < end;) step();
  if (kind == BusKind::can) return measure_can(trace.str(), rig.buses[0], nodes);
  return measure(frames_in(trace.str()), rig.buses[0]);
}

}  // namespace footlight::contracts
