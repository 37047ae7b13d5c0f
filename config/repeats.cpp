// SPDX-License-Identifier: Apache-2.0
#include "config/repeats.hpp"

#include <algorithm>
#include <bit>

namespace footlight::config {
namespace {

/// The endings that each measure belongs to, bit n for the nth time; 0: none.
std::vector<std::uint64_t> endings_of(const std::vector<MeasureTurn>& measures) {
  std::vector<std::uint64_t> out;
  std::uint64_t ending = 0;
  for (const MeasureTurn& turn : measures) {
    if (turn.ending_start != 0) ending = turn.ending_start;
    out.push_back(ending);
    if (turn.ending_stop || turn.backward) ending = 0;
  }
  return out;
}

/// How often the music is played that ends in this ending, or without one, and the endings behind it.
int times_with(const std::vector<std::uint64_t>& endings, std::size_t i) {
  std::uint64_t all = endings[i];
  for (std::size_t k = i + 1; all != 0 && k < endings.size() && endings[k] != 0; ++k) all |= endings[k];
  return all == 0 ? 2 : std::max(2, 63 - std::countl_zero(all));
}

}  // namespace

Result<std::vector<std::size_t>> played_order(const std::vector<MeasureTurn>& measures) {
  const std::vector<std::uint64_t> endings = endings_of(measures);
  std::vector<std::size_t> out;
  std::size_t start = 0;  // of what is repeated
  int time = 1;           // which time it is being played
  bool came_back = false;
  for (std::size_t i = 0; i < measures.size();) {
    const MeasureTurn& turn = measures[i];
    if (turn.forward && !came_back) {
      start = i;
      time = 1;
    }
    came_back = false;
    if (endings[i] != 0 && (endings[i] >> static_cast<unsigned>(time) & 1U) == 0) {  // another time's
      ++i;
      continue;
    }
    if (out.size() == kMostPlayedMeasures) return input_error("repeats make more than 100000 measures");
    out.push_back(i);
    if (turn.backward && time < (turn.times > 0 ? turn.times : times_with(endings, i))) {
      ++time;
      came_back = true;
      i = start;
      continue;
    }
    const bool leaves_ending = endings[i] != 0 && (i + 1 == measures.size() || endings[i + 1] != endings[i]);
    ++i;
    if (turn.backward || leaves_ending) {
      start = i;
      time = 1;
    }
  }
  return out;
}

}  // namespace footlight::config
