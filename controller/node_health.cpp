// SPDX-License-Identifier: Apache-2.0
#include "controller/node_health.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr double kWell = 0.98;  // of all questions answered

enum class Reach { well, badly, silent };

Reach reach_of(const NodeHealth& node) {
  if (node.answered == 0) return Reach::silent;
  return node.answered_share() >= kWell ? Reach::well : Reach::badly;
}

std::string listed(const std::vector<std::string>& names, const std::vector<std::size_t>& which) {
  constexpr std::size_t kMost = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(which.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + names[which[i]];
  if (which.size() > kMost) text += " and " + std::to_string(which.size() - kMost) + " more";
  return text;
}

}  // namespace

void LatencyHistogram::add(Duration latency) {
  std::size_t at = 0;
  while (at < kUpToMs.size() && latency > milliseconds(kUpToMs[at])) ++at;
  ++counts_[at];
  ++total_;
  sum_ += latency;
  longest_ = std::max(longest_, latency);
}

Duration LatencyHistogram::mean() const { return total_ == 0 ? Duration{} : sum_ / static_cast<Duration::rep>(total_); }

std::string cable_verdict(const std::vector<NodeHealth>& health, const std::vector<std::string>& names) {
  FL_CHECK(health.size() == names.size());
  if (health.empty()) return "no node was asked";
  std::vector<std::size_t> silent;
  std::vector<std::size_t> badly;
  for (std::size_t i = 0; i < health.size(); ++i) {
    const Reach reach = reach_of(health[i]);
    if (reach == Reach::silent) silent.push_back(i);
    if (reach == Reach::badly) badly.push_back(i);
  }
  if (silent.size() == health.size()) {
    return "nobody answers: look at the adapter, its direction, the two wires (exchanged?) and the supply";
  }
  if (silent.empty() && badly.empty()) return "every node answers, to the end of the cable";
  if (!silent.empty() && silent.back() + 1 == health.size() && silent.back() - silent.front() + 1 == silent.size() &&
      silent.size() > 1) {
    const std::size_t first = silent.front();
    return "the cable carries as far as " + names[first - 1] + "; from " + names[first] +
           " on nobody answers: look at the cable, the connector and the supply between these two";
  }
  if (!silent.empty()) {
    return "silent with neighbours that answer: " + listed(names, silent) +
           ": look at these nodes, their stubs, addresses and supplies; the cable goes on behind them";
  }
  const bool to_the_end = badly.back() + 1 == health.size() && badly.back() - badly.front() + 1 == badly.size();
  if (to_the_end && badly.size() > 1) {
    return "answers get lost from " + names[badly.front()] +
           " to the end of the cable: look at the terminating resistors and the bias, then at the cable from there on";
  }
  return "answers get lost of " + listed(names, badly) + ": look at these nodes and their stubs";
}

}  // namespace footlight::controller
