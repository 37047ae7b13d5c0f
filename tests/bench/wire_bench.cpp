// SPDX-License-Identifier: Apache-2.0
// footlight_wire_bench: what preloading nodes of 32 channels costs on simulated wires, in virtual time, so it is the
// same on every machine. One JSON row a line: {"job", "nodes", "seconds", "efficiency", "of_line_rate", "limit"}.
#include <cstdio>
#include <string>

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
  return good ? 0 : 1;
}
