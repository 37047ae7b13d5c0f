// SPDX-License-Identifier: Apache-2.0
#include "controller/look_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace footlight::controller {
namespace {

constexpr int kMostLooks = 253;  // besides dark

}  // namespace

Result<CueSchedule> numbered_after(CueSchedule schedule, const CueSchedule& before, int most) {
  std::vector<Look> table = before.looks();
  std::vector<bool> taken = before.numbers_shown();
  const std::vector<Look>& looks = schedule.looks();
  std::vector<LookIndex> now(looks.size(), kDark);
  std::vector<std::size_t> fresh;
  taken[kDark] = true;
  for (std::size_t i = 1; i < looks.size(); ++i) {
    const auto known = std::find(table.begin() + 1, table.end(), looks[i]);
    if (known == table.end()) {
      fresh.push_back(i);
      continue;
    }
    now[i] = static_cast<LookIndex>(known - table.begin());
    taken[now[i]] = true;
  }
  std::size_t free = 0;
  for (const std::size_t i : fresh) {
    while (free < taken.size() && taken[free]) ++free;
    if (free < taken.size()) {
      taken[free] = true;
    } else {
      free = table.size();
      table.emplace_back();
      taken.push_back(true);
    }
    table[free] = looks[i];
    now[i] = static_cast<LookIndex>(free);
  }
  most = std::min(most, kMostLooks);
  if (static_cast<int>(table.size()) - 1 > most) {
    return refusal(fmt::format(
        "the looks of the plan that runs and of the new one are {} together, and the markers know {} at a time (fewer "
        "new colours, or end the run and start it again)",
        table.size() - 1, most));
  }
  const auto byte = static_cast<std::uint8_t>(schedule.plan_byte() + (schedule.plan_byte() == before.plan_byte()));
  schedule.renumber(std::move(table), now, byte);
  return schedule;
}

}  // namespace footlight::controller
