// SPDX-License-Identifier: Apache-2.0
#include "planner/stages.hpp"

#include <algorithm>

namespace footlight::planner {

StageKey StageHash::key() {
  const auto digest = sum_.digest();
  StageKey out{};
  std::copy_n(digest.begin(), out.size(), out.begin());
  return out;
}

std::optional<std::string_view> Stages::find(const StageKey& key) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return std::nullopt;
  found->second.used = true;
  return found->second.value;
}

void Stages::keep(const StageKey& key, std::string value) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(key, Entry{std::move(value), true});
}

void Stages::load(const StageKey& key, std::string_view value) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(key, Entry{std::string(value), false});
}

void Stages::forget_unused() {
  const std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    entry = entry->second.used ? std::next(entry) : entries_.erase(entry);
  }
  for (auto& [key, entry] : entries_) entry.used = false;
}

std::vector<std::pair<StageKey, std::string_view>> Stages::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<StageKey, std::string_view>> out;
  for (const auto& [key, entry] : entries_) out.emplace_back(key, entry.value);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace footlight::planner
