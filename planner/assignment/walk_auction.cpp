// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/walk_auction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/assignment/arc_rows.hpp"

namespace footlight::planner::assignment {
namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kCeiling = 8;
/// Margins by which all that a source has on its list may be beyond its horizon before it asks again. Prices around it
/// rise together, so that there is still little else to be had; what is missed, the exact method finds.
constexpr float kSlack = 1;
}  // namespace

WalkAuction::WalkAuction(const Walks& walks, PriceTree& tree, float margin)
    : walks_(walks),
      tree_(tree),
      margin_(margin),
      look_(kernels().look),
      lists_(std::make_unique_for_overwrite<List[]>(walks.size())),
      listed_(walks.size(), 0),
      horizon_(walks.size(), -kInfinity),
      finds_(tree) {}

bool WalkAuction::hold(float step, std::uint64_t most_bids) {
  target_of_.assign(walks_.size(), kNobody);
  source_of_.assign(walks_.size(), kNobody);
  std::uint64_t bids = 0;
  bool sold_out = true;
  const float slack = kSlack * margin_;
  // Prices that rise far above all walks tell of more sources than targets within reach; that is no auction's business.
  const float ceiling = kCeiling * tree_.magnitude();
  for (std::uint32_t first = 0; first < walks_.size(); ++first) {
    for (std::uint32_t source = first; source != kNobody;) {
      if (++bids > most_bids) return false;
      Offer offer = look(source);
      if (offer.best > horizon_[source] + slack) {
        refill(source, offer.best);
        offer = look(source);
        if (!(offer.best < ceiling)) {
          sold_out = false;
          break;
        }
      }
      // Whoever can go nowhere else would pay any price.
      const float second = std::min({offer.second, horizon_[source], ceiling});
      tree_.raise(offer.target, tree_.price(offer.target) + (std::max(second - offer.best, 0.0F) + step));
      const std::uint32_t displaced = source_of_[offer.target];
      source_of_[offer.target] = source;
      last_target_ = offer.target;
      target_of_[source] = offer.target;
      if (displaced != kNobody) target_of_[displaced] = kNobody;
      source = displaced;
    }
  }
  return sold_out;
}

void WalkAuction::refill(std::uint32_t source, float best) {
  const float x = walks_.sources().search_x[source];
  const float y = walks_.sources().search_y[source];
  // Somebody's target is a first guess, the better the nearer; who stood before in the order is a neighbour.
  if (last_target_ != kNobody && !walks_.limited()) best = std::min(best, tree_.value(x, y, last_target_));
  horizon_[source] = tree_.collect({x, y, best + margin_ + tree_.rounding(), margin_, walks_.reach(), kListed}, finds_);
  List& list = lists_[source];
  std::uint32_t listed = 0;
  for (const Hit hit : finds_.hits()) {
    list.target[listed] = hit.target;
    list.walk[listed++] = hit.value - tree_.price(hit.target);
  }
  for (; listed % kFan != 0; ++listed) {
    list.target[listed] = 0;
    list.walk[listed] = kInfinity;
  }
  listed_[source] = listed;
}

}  // namespace footlight::planner::assignment
