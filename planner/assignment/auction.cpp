// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/auction.hpp"

#include <algorithm>

namespace footlight::planner::assignment {

void hold_auction(const ArcRows& rows, Value step, std::uint64_t most_bids, Matching& matching) {
  const std::uint32_t size = rows.size();
  // A source with a single arc left would bid without limit.
  const Value most_raised = 64 * step;
  matching.target_of.assign(size, kNobody);
  matching.source_of.assign(size, kNobody);
  std::uint64_t bids = 0;
  for (std::uint32_t first = 0; first < size; ++first) {
    std::uint32_t source = first;
    while (source != kNobody) {
      if (++bids > most_bids) return;
      Value best = kFar;
      Value second = kFar;
      std::uint32_t wanted = kNobody;
      for (std::uint32_t e = rows.first[source]; e < rows.first[source + 1]; ++e) {
        const Value offer = rows.cost[e] + matching.price[rows.target[e]];
        second = std::min(second, std::max(best, offer));
        wanted = offer < best ? rows.target[e] : wanted;
        best = std::min(best, offer);
      }
      if (wanted == kNobody) break;
      matching.price[wanted] += std::min(second - best + step, most_raised);
      const std::uint32_t displaced = matching.source_of[wanted];
      matching.source_of[wanted] = source;
      matching.target_of[source] = wanted;
      if (displaced != kNobody) matching.target_of[displaced] = kNobody;
      source = displaced;
    }
  }
}

}  // namespace footlight::planner::assignment
