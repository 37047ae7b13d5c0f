// SPDX-License-Identifier: Apache-2.0
#include "controller/patterns.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "controller/lamp.hpp"
#include "core/check.hpp"

namespace footlight::controller {
namespace {

constexpr std::size_t kFoldAt = 4'000'000;
constexpr int kSweeps = 8;

struct Neighbour {
  std::uint32_t performer = 0;
  std::uint32_t weight = 0;
};

}  // namespace

void NearGoals::add(PerformerIndex a, PerformerIndex b) {
  const auto low = std::min(a, b);
  const auto high = std::max(a, b);
  raw_.push_back((std::uint64_t{low.value()} << 32U) | high.value());
  if (raw_.size() >= kFoldAt) fold();
}

void NearGoals::fold() {
  std::sort(raw_.begin(), raw_.end());
  std::vector<Pair> folded;
  folded.reserve(pairs_.size());
  auto old = pairs_.begin();
  for (const std::uint64_t key : raw_) {
    while (old != pairs_.end() && old->key <= key) folded.push_back(*old++);
    if (!folded.empty() && folded.back().key == key) {
      ++folded.back().weight;
    } else {
      folded.push_back({key, 1});
    }
  }
  folded.insert(folded.end(), old, pairs_.end());
  pairs_ = std::move(folded);
  raw_.clear();
}

std::vector<std::uint8_t> NearGoals::patterns(int patterns) {
  FL_CHECK(patterns >= 1 && patterns <= kPatterns);
  fold();
  std::vector<std::size_t> first(performers_ + 1, 0);
  std::vector<std::uint64_t> load(performers_, 0);
  const auto ends = [](const Pair& pair) {
    return std::array{static_cast<std::uint32_t>(pair.key >> 32U), static_cast<std::uint32_t>(pair.key)};
  };
  for (const Pair& pair : pairs_) {
    for (const std::uint32_t p : ends(pair)) {
      ++first[p + 1];
      load[p] += pair.weight;
    }
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Neighbour> neighbours(first.back());
  std::vector<std::size_t> fill(first.begin(), first.end() - 1);
  for (const Pair& pair : pairs_) {
    const auto [a, b] = ends(pair);
    neighbours[fill[a]++] = {b, pair.weight};
    neighbours[fill[b]++] = {a, pair.weight};
  }

  std::vector<std::uint32_t> order(performers_);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return load[a] > load[b]; });
  constexpr std::uint8_t kNone = 255;
  std::vector<std::uint8_t> chosen(performers_, kNone);
  const auto choose = [&](std::uint32_t p) {
    std::array<std::uint64_t, kPatterns> cost{};
    for (std::size_t n = first[p]; n < first[p + 1]; ++n) {
      const std::uint8_t other = chosen[neighbours[n].performer];
      if (other != kNone) cost[other] += neighbours[n].weight;
    }
    const auto best = std::min_element(cost.begin(), cost.begin() + patterns);
    if (chosen[p] != kNone && cost[chosen[p]] <= *best) return false;
    chosen[p] = static_cast<std::uint8_t>(best - cost.begin());
    return true;
  };
  for (const std::uint32_t p : order) choose(p);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool better = false;
    for (const std::uint32_t p : order) better = choose(p) || better;
    if (!better) break;
  }
  return chosen;
}

}  // namespace footlight::controller
