// SPDX-License-Identifier: Apache-2.0
#include "app/stage_times.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <sys/resource.h>

namespace footlight::app {

void StageTimes::enter(std::string_view stage) {
  static_cast<void>(finish());
  const auto known = std::find_if(stages_.begin(), stages_.end(), [&](const auto& one) { return one.first == stage; });
  now_ = static_cast<std::size_t>(known - stages_.begin());
  if (known == stages_.end()) stages_.emplace_back(stage, 0.0);
}

const std::vector<std::pair<std::string, double>>& StageTimes::finish() {
  const Instant now = clock_.now();
  if (now_ < stages_.size()) stages_[now_].second += to_seconds(now - since_);
  since_ = now;
  return stages_;
}

std::string to_text(const std::vector<std::pair<std::string, double>>& stages, double peak_mb) {
  std::string out;
  double all_s = 0;
  for (const auto& [stage, time_s] : stages) {
    out += fmt::format("{} {:.2f} s, ", stage, time_s);
    all_s += time_s;
  }
  return out + fmt::format("all {:.2f} s, {:.0f} MB at most", all_s, peak_mb);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace footlight::app
