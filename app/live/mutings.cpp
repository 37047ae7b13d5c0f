// SPDX-License-Identifier: Apache-2.0
#include "app/live/mutings.hpp"

#include <algorithm>
#include <chrono>

namespace footlight::app {

Mutings::~Mutings() {
  if (making_.valid()) making_.wait();
}

void Mutings::want(std::vector<bool> muted) {
  if (muted.size() == show_.groups.size() + 1) wanted_ = std::move(muted);
}

std::optional<controller::Command> Mutings::look() {
  if (making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    Made made = making_.get();
    known_[std::move(made.first)] = schedule_.add(std::move(made.second));
  }
  if (!wanted_) return std::nullopt;
  controller::Command command;
  command.kind = controller::Command::Kind::mute;
  const bool nobody = std::ranges::none_of(*wanted_, [](bool muted) { return muted; });
  if (!nobody && schedule_.numbers().quiet != kDark) {
    const auto found = known_.find(*wanted_);
    if (found == known_.end()) {
      if (!making_.valid()) {
        making_ = std::async(std::launch::async, [this, muted = *wanted_]() -> Made {
          return {muted, controller::build_muted(show_, plan_, rig_, schedule_, muted)};
        });
      }
      return std::nullopt;
    }
    command.first = found->second.value_or(0);
  }
  wanted_.reset();
  return command;
}

}  // namespace footlight::app
