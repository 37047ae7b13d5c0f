// SPDX-License-Identifier: Apache-2.0
// footlight_wire_bench: what preloading nodes of 32 channels costs on simulated wires, and how far apart the lamps of a
// floor change at a GO, in virtual time, so it is the same on every machine but for the processor's time. One JSON row
// a line: {"job", "nodes", "seconds", "efficiency", "of_line_rate", "limit"}, then
// {"job", "markers", "opening_s", "notice_ms", "within_bus_ms", "across_buses_ms", "go_to_last_lamp_ms",
// "cpu_percent_of_a_bus"} (the last while the buses carry as much as they can; of one bus).
#include <cstdio>
#include <string>

#include "tests/contracts/go_run.hpp"
#include "tests/contracts/preload_run.hpp"

namespace footlight::bench {
namespace {

/// Least share of what the wire allows; on CAN all frames count, the nodes' heartbeats among them.
constexpr double kLimit = 0.9;
constexpr double kCanLimit = 0.95;

bool print_row(BusKind kind, int bits_per_second, int nodes) {
  const contracts::PreloadRun run = contracts::preload_all(kind, bits_per_second, nodes);
  std::printf(
      "{\"job\": \"preload %s %d\", \"nodes\": %d, \"seconds\": %.4f, \"efficiency\": %.4f, "
      "\"of_line_rate\": %.4f, \"limit\": %.2f}\n",
      std::string(to_text(kind)).c_str(), bits_per_second, nodes, static_cast<double>(run.elapsed.count()) * 1e-9,
      run.efficiency(), run.of_line_rate(), kind == BusKind::can ? kCanLimit : kLimit);
  return run.receipts == nodes && run.efficiency() >= (kind == BusKind::can ? kCanLimit : kLimit);
}

double ms(Duration duration) { return static_cast<double>(duration.count()) * 1e-6; }

bool print_floor(const char* name, const std::vector<contracts::FloorBus>& buses) {
  const contracts::GoRun run = contracts::go_on(buses);
  int nodes = 0;
  for (const contracts::FloorBus& bus : buses) nodes += bus.nodes;
  const double share = ms(run.cpu) / ms(run.preload) / static_cast<double>(buses.size());
  std::printf(
      "{\"job\": \"GO %s\", \"markers\": %d, \"opening_s\": %.3f, \"notice_ms\": %.3f, \"within_bus_ms\": %.3f, "
      "\"across_buses_ms\": %.3f, \"go_to_last_lamp_ms\": %.3f, \"cpu_percent_of_a_bus\": %.3f}\n",
      name, nodes * kChannelsPerNode, ms(run.preload) * 1e-3, ms(run.notice), ms(run.within_bus), ms(run.across_buses),
      ms(run.go_to_last_lamp), 100 * share);
  return run.lit == nodes;
}

}  // namespace
}  // namespace footlight::bench

int main() {
  using footlight::BusKind;
  bool good = true;
  for (const int speed : {19'200, 115'200, 1'000'000}) {
    for (const int nodes : {28, 127}) good = footlight::bench::print_row(BusKind::modbus_rtu, speed, nodes) && good;
  }
  for (const int speed : {115'200, 1'000'000}) {
    for (const int nodes : {28, 127}) good = footlight::bench::print_row(BusKind::serial, speed, nodes) && good;
  }
  // 127 is the controller's id. 96 nodes of 32 channels are 3,072 markers.
  for (const int speed : {125'000, 250'000, 500'000, 1'000'000}) {
    for (const int nodes : {28, 96, 126}) good = footlight::bench::print_row(BusKind::can, speed, nodes) && good;
  }
  using Floor = std::vector<footlight::contracts::FloorBus>;
  const Floor can(1, {BusKind::can, 500'000, 96});
  const Floor four_can(4, {BusKind::can, 500'000, 24});
  const Floor serial(4, {BusKind::serial, 1'000'000, 24});
  const Floor rtu(4, {BusKind::modbus_rtu, 115'200, 24});
  const Floor tcp(1, {BusKind::modbus_tcp, 100'000'000, 96});
  const Floor mixed{{BusKind::can, 500'000, 32}, {BusKind::serial, 1'000'000, 32}, {BusKind::modbus_rtu, 115'200, 32}};
  good = footlight::bench::print_floor("1 can 500000", can) && good;
  good = footlight::bench::print_floor("4 can 500000", four_can) && good;
  good = footlight::bench::print_floor("4 serial 1000000", serial) && good;
  good = footlight::bench::print_floor("4 modbus-rtu 115200", rtu) && good;
  good = footlight::bench::print_floor("1 modbus-tcp", tcp) && good;
  good = footlight::bench::print_floor("can, serial, modbus-rtu", mixed) && good;
  return good ? 0 : 1;
}
