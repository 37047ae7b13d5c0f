// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/preload_run.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include "core/check.hpp"
#include "core/clock.hpp"
#include "drivers/registry.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::contracts {
namespace {

class ReceiptCount final : public drivers::EventSink {
 public:
  void on_event(const drivers::DeviceEvent& event) override {
    receipts += event.kind == drivers::DeviceEvent::Kind::preloaded ? 1 : 0;
  }
  int receipts = 0;
};

/// What the trace says of the wire: characters and pauses between a request and its receipt, and silences.
void read_trace(const std::string& trace, const Bus& bus, PreloadRun& run) {
  const auto time_of = [&](std::size_t characters) {
    const auto bits = static_cast<Duration::rep>(characters) * bus.bits_per_character();
    return Duration(bits * 1'000'000'000 / bus.bits_per_second);
  };
  const bool rtu = bus.kind == BusKind::modbus_rtu;
  const Duration silence = rtu ? drivers::rtu_silence(bus.bits_per_second, bus.bits_per_character()) : Duration{};
  std::istringstream lines(trace);
  std::string line;
  Duration request_end{};
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    double microseconds_now = 0;
    std::string name;
    std::string direction;
    std::string hex;
    words >> microseconds_now >> name >> direction >> hex;
    if (direction != ">" && direction != "<") continue;
    const Duration characters = time_of(hex.size() / 2);
    const Duration end = seconds(microseconds_now * 1e-6);
    run.on_wire += characters;
    run.allowed += characters + silence;
    if (direction == ">") request_end = end;
    // The node's pause from the last bit of the request; the silence after that is a part of it.
    if (direction == "<") run.allowed += end - characters - request_end - silence;
  }
  run.allowed -= silence;  // nobody waits for the last one
}

}  // namespace

PreloadRun preload_all(BusKind kind, int bits_per_second, int nodes, int channels) {
  Rig rig;
  rig.buses.push_back({"b", kind, "sim://b", bits_per_second, std::nullopt, {}});
  for (int i = 1; i <= nodes; ++i) {
    rig.nodes.push_back(
        {"n" + std::to_string(i), BusIndex(0), i, std::vector<Channel>(static_cast<std::size_t>(channels)), {}});
  }
  ManualClock clock;
  std::ostringstream trace;
  sim::SimulatedRig simulated(rig, {}, 1, clock, &trace);
  simulated.set_show(kStart, seconds(1'000));
  drivers::PortReference port;
  if (kind == BusKind::serial) {
    port = &simulated.serial(BusIndex(0));
  } else {
    port = &simulated.modbus(BusIndex(0));
  }
  const auto addresses = drivers::node_addresses(rig, BusIndex(0));
  auto driver = drivers::make_driver(rig.buses[0], addresses, 0xA3, port).value();
  ReceiptCount count;
  for (const drivers::NodeAddress& address : addresses) {
    const std::vector<LookIndex> looks(address.channels, LookIndex{7});
    FL_CHECK(driver->preload(address, 1, looks, clock.now()) == drivers::SendStatus::accepted);
    while (true) {
      const Instant wish = driver->step(clock.now(), count);
      if (driver->ready()) break;
      simulated.advance_to(std::min(wish, simulated.next_event()));
    }
  }
  PreloadRun run;
  run.receipts = count.receipts;
  run.elapsed = clock.now() - kStart;
  read_trace(trace.str(), rig.buses[0], run);
  return run;
}

}  // namespace footlight::contracts
