// SPDX-License-Identifier: Apache-2.0
#include "controller/wearable_contents.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace footlight::controller {
namespace {

constexpr double kTurn = 256;

/// 0 downstage, 64 stage right, 128 upstage, 192 stage left: clockwise from above.
std::uint8_t direction_of(double dx, double dy) {
  const double turn = std::atan2(-dx, -dy) / (2 * std::numbers::pi);
  return static_cast<std::uint8_t>(static_cast<unsigned>(std::lround(turn * kTurn) + 256) & 0xFFU);
}

std::uint16_t within_16_bits(double value) {
  return static_cast<std::uint16_t>(std::clamp(std::lround(value), 0L, 65'535L));
}

}  // namespace

std::vector<WearableContents::Worn> worn_in(const Rig& rig) {
  std::vector<WearableContents::Worn> worn;
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
      const Channel& channel = rig.nodes[n].channels[c];
      if (channel.kind != Channel::Kind::wearable) continue;
      worn.push_back({NodeIndex::of(n), static_cast<int>(c), channel.performer});
    }
  }
  return worn;
}

drivers::WearableContent content_of(const Doing& doing, const std::vector<Mark>& track, const Grid& grid,
                                    const TempoMap& tempo) {
  drivers::WearableContent content;
  if (!doing.next && !doing.goal) return content;
  const CellIndex to = doing.next ? *doing.next : *doing.goal;
  const Instant arrives = doing.next ? doing.next_arrives : doing.arrives;
  const auto mark = std::lower_bound(track.begin(), track.end(), arrives,
                                     [](const Mark& m, Instant instant) { return m.time < instant; });
  if (mark == track.begin() || mark == track.end()) return content;
  const Mark& from = *(mark - 1);
  const auto a = grid.centre(from.cell);
  const auto b = grid.centre(to);
  content.walks = true;
  content.direction = direction_of(b.x - a.x, b.y - a.y);
  content.distance_cm = within_16_bits(100 * std::hypot(b.x - a.x, b.y - a.y));
  content.starts_ms = static_cast<std::uint32_t>(from.time.time_since_epoch() / milliseconds(1));
  const Instant next_count = tempo.at(tempo.count_at(from.time) + 1);
  content.count_ms = within_16_bits(to_seconds(next_count - from.time) * 1000);
  return content;
}

}  // namespace footlight::controller
