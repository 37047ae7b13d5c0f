// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/phases.hpp"

#include <algorithm>
#include <functional>

#include "core/check.hpp"

namespace footlight::planner::assignment {

Phases::Phases(ArcRows& rows, Matching& matching, bool small_costs)
    : rows_(rows),
      matching_(matching),
      by_heap_(!small_costs),
      buckets_(small_costs ? kBuckets : 0),
      source_distance_(rows.size(), kFar),
      target_distance_(rows.size(), kFar),
      source_done_(rows.size(), kFar),
      next_arc_(rows.size(), 0),
      visited_(rows.size(), 0) {}

void Phases::tighten() {
  const std::uint32_t size = rows_.size();
  Matching& m = matching_;
  m.value.assign(size, 0);
  for (std::uint32_t i = 0; i < size; ++i) {
    Value least = kFar;
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
      least = std::min(least, rows_.cost[e] + m.price[rows_.target[e]]);
    }
    m.value[i] = least < kFar ? least : 0;
  }
  std::vector<Value> lowest(size, -kFar);
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
      Value& price = lowest[rows_.target[e]];
      price = std::max(price, m.value[i] - rows_.cost[e]);
    }
  }
  for (std::uint32_t s = 0; s < size; ++s) {
    if (lowest[s] > -kFar) m.price[s] = lowest[s];
  }
  m.source_of.assign(size, kNobody);
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t wish = m.target_of[i];
    m.target_of[i] = kNobody;
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1] && wish != kNobody; ++e) {
      if (rows_.target[e] == wish && reduced(i, e) == 0) {
        m.target_of[i] = wish;
        m.source_of[wish] = i;
        break;
      }
    }
  }
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1] && m.target_of[i] == kNobody; ++e) {
      if (m.source_of[rows_.target[e]] == kNobody && reduced(i, e) == 0) {
        m.target_of[i] = rows_.target[e];
        m.source_of[rows_.target[e]] = i;
      }
    }
  }
}

Phases::Outcome Phases::run(const Patience& patience) {
  while (true) {
    collect_free();
    if (free_.empty()) return Outcome::perfect;
    if (patience.over(looked_at_)) return Outcome::given_up;
    forget();
    const Search result = search(std::max<std::size_t>(1, free_.size() * 3 / 4));
    if (!result.found) return Outcome::stuck;
    change_prices(result.farthest);
    const std::size_t augmented = augment();
    FL_CHECK(augmented > 0);
  }
}

void Phases::add(std::span<const ArcRows::NewArc> arcs) {
  forget();
  rows_.merge(arcs);
  for (const ArcRows::NewArc& arc : arcs) {
    Value& value = matching_.value[arc.source];
    if (arc.cost + matching_.price[arc.target] >= value) continue;
    value = arc.cost + matching_.price[arc.target];
    const std::uint32_t target = matching_.target_of[arc.source];
    if (target == kNobody) continue;
    matching_.target_of[arc.source] = kNobody;
    matching_.source_of[target] = kNobody;
  }
}

void Phases::collect_free() {
  free_.clear();
  for (std::uint32_t i = 0; i < rows_.size(); ++i) {
    if (matching_.target_of[i] == kNobody) free_.push_back(i);
  }
}

void Phases::forget() {
  for (const std::uint32_t i : reached_sources_) source_distance_[i] = source_done_[i] = kFar;
  for (const std::uint32_t s : reached_targets_) target_distance_[s] = kFar;
  reached_sources_.clear();
  reached_targets_.clear();
  for (auto& bucket : buckets_) bucket.clear();
  heap_.clear();
  queued_ = 0;
}

Phases::Search Phases::search(std::size_t wanted) {
  if (!by_heap_) {
    const Search result = explore(wanted);
    if (result.found || dropped_ == kFar) return result;
    by_heap_ = true;  // the nearest free target lies beyond the window: from now on without one
    forget();
  }
  return explore(wanted);
}

Phases::Search Phases::explore(std::size_t wanted) {
  dropped_ = kFar;
  now_ = 0;
  for (const std::uint32_t i : free_) {
    source_distance_[i] = 0;
    reached_sources_.push_back(i);
    push(i, 0);
  }
  Search result;
  std::size_t found = 0;
  while (found < wanted) {
    const std::uint32_t node = pop();
    if (node == kNobody) break;
    if (node < rows_.size()) {
      if (source_distance_[node] != now_ || source_done_[node] == now_) continue;
      source_done_[node] = now_;
      relax(node, now_);
    } else if (target_distance_[node - rows_.size()] == now_) {
      ++found;
      result = {true, now_};
    }
  }
  return result;
}

void Phases::push(std::uint32_t node, Value distance) {
  if (by_heap_) {
    heap_.emplace_back(distance, node);
    std::ranges::push_heap(heap_, std::greater<>());
  } else if (distance - now_ < static_cast<Value>(kBuckets)) {
    buckets_[static_cast<std::size_t>(distance) % kBuckets].push_back(node);
    ++queued_;
  } else {
    dropped_ = std::min(dropped_, distance);
  }
}

/// The next node; its distance, if it still is that, becomes now_.
std::uint32_t Phases::pop() {
  if (by_heap_) {
    if (heap_.empty()) return kNobody;
    std::ranges::pop_heap(heap_, std::greater<>());
    const auto [distance, node] = heap_.back();
    heap_.pop_back();
    now_ = distance;
    return node;
  }
  if (queued_ == 0) return kNobody;
  while (buckets_[static_cast<std::size_t>(now_) % kBuckets].empty()) ++now_;
  if (now_ >= dropped_) return kNobody;
  auto& bucket = buckets_[static_cast<std::size_t>(now_) % kBuckets];
  const std::uint32_t node = bucket.back();
  bucket.pop_back();
  --queued_;
  return node;
}

void Phases::relax(std::uint32_t source, Value base) {
  base -= matching_.value[source];
  looked_at_ += rows_.first[source + 1] - rows_.first[source];
  for (std::uint32_t e = rows_.first[source]; e < rows_.first[source + 1]; ++e) {
    const std::uint32_t target = rows_.target[e];
    const Value distance = base + rows_.cost[e] + matching_.price[target];
    if (distance >= target_distance_[target]) continue;
    if (target_distance_[target] == kFar) reached_targets_.push_back(target);
    target_distance_[target] = distance;
    const std::uint32_t holder = matching_.source_of[target];
    if (holder == kNobody) {
      push(rows_.size() + target, distance);
      continue;
    }
    if (source_distance_[holder] == kFar) reached_sources_.push_back(holder);
    source_distance_[holder] = distance;
    push(holder, distance);
  }
}

void Phases::change_prices(Value farthest) {
  for (const std::uint32_t i : reached_sources_) {
    if (source_distance_[i] < farthest) matching_.value[i] += farthest - source_distance_[i];
  }
  for (const std::uint32_t s : reached_targets_) {
    if (target_distance_[s] < farthest) matching_.price[s] += farthest - target_distance_[s];
  }
}

std::size_t Phases::augment() {
  for (const std::uint32_t i : reached_sources_) next_arc_[i] = rows_.first[i];
  for (const std::uint32_t s : reached_targets_) visited_[s] = 0;
  std::size_t augmented = 0;
  for (const std::uint32_t i : free_) augmented += augment_from(i) ? 1 : 0;
  return augmented;
}

bool Phases::augment_from(std::uint32_t start) {
  path_.assign(1, start);
  while (!path_.empty()) {
    const std::uint32_t source = path_.back();
    std::uint32_t& e = next_arc_[source];
    bool deeper = false;
    for (; e < rows_.first[source + 1] && !deeper; ++e) {
      std::uint32_t target = rows_.target[e];
      if (target_distance_[target] == kFar || visited_[target] != 0 || reduced(source, e) != 0) continue;
      visited_[target] = 1;
      if (matching_.source_of[target] == kNobody) {
        for (std::size_t k = path_.size(); k-- > 0;) {
          matching_.source_of[target] = path_[k];
          std::swap(matching_.target_of[path_[k]], target);
        }
        return true;
      }
      path_.push_back(matching_.source_of[target]);
      deeper = true;
    }
    if (!deeper) path_.pop_back();
  }
  return false;
}

}  // namespace footlight::planner::assignment
