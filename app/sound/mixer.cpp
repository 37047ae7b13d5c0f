// SPDX-License-Identifier: Apache-2.0
#include "app/sound/mixer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace footlight::app {

void Mixer::plan(std::vector<Sounding> sounds) {
  const std::scoped_lock lock(mutex_);
  planned_ = std::move(sounds);
  std::erase_if(planned_, [&](const Sounding& one) { return one.at <= begun_; });
}

void Mixer::render(Instant from, std::span<float> block) {
  std::ranges::fill(block, 0.0F);
  const std::scoped_lock lock(mutex_);
  const auto add = [&](Playing& playing, std::size_t offset) {
    const std::size_t count = std::min(block.size() - offset, playing.sound->size() - playing.next);
    for (std::size_t i = 0; i < count; ++i) block[offset + i] += (*playing.sound)[playing.next + i];
    playing.next += count;
  };
  for (Playing& playing : playing_) add(playing, 0);
  for (const Sounding& one : planned_) {
    const auto offset = std::llround(to_seconds(one.at - from) * kSampleRate);
    if (offset >= static_cast<long long>(block.size())) continue;
    begun_ = std::max(begun_, one.at);
    if (from - one.at > kLate) continue;
    playing_.push_back({one.sound, 0});
    add(playing_.back(), static_cast<std::size_t>(std::max(0LL, offset)));
  }
  std::erase_if(planned_, [&](const Sounding& one) { return one.at <= begun_; });
  std::erase_if(playing_, [](const Playing& playing) { return playing.next == playing.sound->size(); });
  for (float& sample : block) sample = std::clamp(sample, -1.0F, 1.0F);
}

}  // namespace footlight::app
