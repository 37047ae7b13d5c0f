// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/clock.hpp"
#include "core/rig.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::sim {

/// One bus of `nodes` nodes with addresses from 1 and as many channels each.
inline Rig small_rig(BusKind kind, int nodes, int channels, int bits_per_second) {
  Rig rig;
  rig.buses.push_back({"b", kind, "sim://" + std::string(to_text(kind)), bits_per_second, std::nullopt, {}});
  for (int i = 1; i <= nodes; ++i) {
    rig.nodes.push_back(
        {"n" + std::to_string(i), BusIndex(0), i, std::vector<Channel>(static_cast<std::size_t>(channels)), {}});
  }
  return rig;
}

/// A simulated rig with its clock and trace.
struct Bench {
  explicit Bench(const Rig& rig, const Faults& faults = {}, std::uint64_t seed = 1)
      : simulated(rig, faults, seed, clock, &trace) {
    simulated.set_show(kStart + std::chrono::seconds(1), std::chrono::seconds(10));
  }

  void run_until(Duration since_start) { simulated.advance_to(kStart + since_start); }
  void run_for(Duration duration) { simulated.advance_to(clock.now() + duration); }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream in(trace.str());
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  [[nodiscard]] std::vector<int> shown(std::uint32_t node, int channels) const {
    std::vector<int> looks;
    for (int i = 0; i < channels; ++i) looks.push_back(simulated.shown(NodeIndex(node), i));
    return looks;
  }

  ManualClock clock;
  std::ostringstream trace;
  SimulatedRig simulated;
};

}  // namespace footlight::sim
