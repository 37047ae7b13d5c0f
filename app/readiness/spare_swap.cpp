// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/spare_swap.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace footlight::app {

SpareSwap::SpareSwap(std::string node, int address, std::string bus)
    : node_(std::move(node)), address_(address), bus_(std::move(bus)) {}

bool SpareSwap::look(bool silent, bool right) {
  const Step before = step_;
  if (step_ == Step::unplug && silent) step_ = Step::plug_in;
  if (step_ == Step::plug_in && right && !silent) step_ = Step::done;
  return step_ != before;
}

std::string_view SpareSwap::step_name() const {
  constexpr std::array<std::string_view, 4> kNames{"unplug", "plug-in", "done", "given-up"};
  return kNames.at(static_cast<std::size_t>(step_));
}

std::string SpareSwap::text() const {
  switch (step_) {
    case Step::unplug:
      return fmt::format("swap {}, 1 of 2: unplug it from bus {}. The others go on.", node_, bus_);
    case Step::plug_in:
      return fmt::format(
          "swap {}, 2 of 2: give the spare address {} (`footlight devices set-address`, on a port that is "
          "not of this show), then plug it into bus {} in its place.",
          node_, address_, bus_);
    case Step::done:
      return fmt::format("swap {}: the spare answers at address {} and shows what it should.", node_, address_);
    case Step::given_up:
      return fmt::format("swap {}: given up.", node_);
  }
  return {};
}

}  // namespace footlight::app
