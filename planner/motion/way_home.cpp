// SPDX-License-Identifier: Apache-2.0
#include "planner/motion/way_home.hpp"

namespace footlight::planner {
namespace {

/// Lengths that are kept at the same time: 256 MiB.
constexpr std::size_t kMostKept = 64U << 20U;

}  // namespace

WayHome::WayHome(const Ways& ways, std::span<const CellIndex> to) : ways_(ways), to_(to), length_m_(to.size()) {}

double WayHome::length_m(std::uint32_t person, CellIndex from) {
  if (!steps_) steps_.emplace(ways_, ways_.around_cell_m());
  std::vector<float>& own = length_m_[person];
  if (own.empty()) {
    if (kept_ > kMostKept) {
      for (auto& other : length_m_) other = {};
      kept_ = 0;
    }
    own = steps_->lengths_to(to_[person]);
    kept_ += own.size();
  }
  return static_cast<double>(own[from.at()]);
}

}  // namespace footlight::planner
