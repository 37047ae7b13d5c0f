// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// How long answers take, from handing over the request until the answer is understood.
class LatencyHistogram {
 public:
  /// Upper ends of the classes, in ms; one more class holds what is longer.
  static constexpr std::array<int, 8> kUpToMs{1, 2, 5, 10, 20, 50, 100, 200};

  void add(Duration latency);
  [[nodiscard]] const std::array<std::uint64_t, kUpToMs.size() + 1>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t total() const { return total_; }
  [[nodiscard]] Duration longest() const { return longest_; }
  [[nodiscard]] Duration mean() const;

 private:
  std::array<std::uint64_t, kUpToMs.size() + 1> counts_{};
  std::uint64_t total_ = 0;
  Duration sum_{};
  Duration longest_{};
};

/// What is known of how a node is.
struct NodeHealth {
  std::uint16_t address = 0;
  std::uint64_t asked = 0;
  std::uint64_t answered = 0;
  std::uint64_t garbled = 0;
  std::uint64_t silent = 0;
  std::uint64_t refused = 0;
  std::optional<Instant> last_seen;
  LatencyHistogram latency;
  std::vector<drivers::HealthValue> values;  ///< as it told last; empty: not told

  [[nodiscard]] double answered_share() const {
    return asked == 0 ? 0 : static_cast<double>(answered) / static_cast<double>(asked);
  }
};

/// What the answers of nodes, in their order along the cable, say of the cable. One sentence, for people.
/// @param names of the nodes, as many as `health`
[[nodiscard]] std::string cable_verdict(const std::vector<NodeHealth>& health, const std::vector<std::string>& names);

}  // namespace footlight::controller
