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
}  // namespace

WalkAuction::WalkAuction(const Walks& walks, PriceTree& tree, float margin)
    : walks_(walks),
      tree_(tree),
      margin_(margin),
      listed_target_(static_cast<std::size_t>(walks.size()) * kListed),
      listed_walk_(static_cast<std::size_t>(walks.size()) * kListed),
      listed_(walks.size(), 0),
      horizon_(walks.size(), -kInfinity) {}

bool WalkAuction::hold(float step, std::uint64_t most_bids) {
  target_of_.assign(walks_.size(), kNobody);
  source_of_.assign(walks_.size(), kNobody);
  std::uint64_t bids = 0;
  bool sold_out = true;
  // Prices that rise far above all walks tell of more sources than targets within reach; that is no auction's business.
  const float ceiling = kCeiling * tree_.magnitude();
  for (std::uint32_t first = 0; first < walks_.size(); ++first) {
    for (std::uint32_t source = first; source != kNobody;) {
      if (++bids > most_bids) return false;
      Offer offer = look(source);
      if (offer.best > horizon_[source]) {
        refill(source, offer.best);
        offer = look(source);
        if (!(offer.best < ceiling)) {
          sold_out = false;
          break;
        }
      }
      const float second = std::min(offer.second, horizon_[source]);
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

WalkAuction::Offer WalkAuction::look(std::uint32_t source) const {
  const std::size_t begin = static_cast<std::size_t>(source) * kListed;
  Offer offer{kInfinity, kInfinity, 0};
  for (std::size_t e = begin; e < begin + listed_[source]; ++e) {
    const float value = listed_walk_[e] + tree_.price(listed_target_[e]);
    offer.second = std::min(offer.second, std::max(offer.best, value));
    offer.target = value < offer.best ? listed_target_[e] : offer.target;
    offer.best = std::min(offer.best, value);
  }
  return offer;
}

void WalkAuction::refill(std::uint32_t source, float best) {
  const float x = walks_.sources().search_x[source];
  const float y = walks_.sources().search_y[source];
  // Somebody's target is a first guess, the better the nearer; who stood before in the order is a neighbour.
  if (last_target_ != kNobody && !walks_.limited()) best = std::min(best, tree_.value(x, y, last_target_));
  horizon_[source] = tree_.collect({x, y, best + margin_ + tree_.rounding(), margin_, walks_.reach()}, hits_);
  if (hits_.size() > kListed) {
    const auto last = hits_.begin() + kListed;
    std::ranges::nth_element(hits_, last, [](const auto& a, const auto& b) {
      return a.value < b.value || (a.value == b.value && a.target < b.target);
    });
    horizon_[source] = last->value;
    hits_.resize(kListed);
  }
  const std::size_t begin = static_cast<std::size_t>(source) * kListed;
  listed_[source] = static_cast<std::uint32_t>(hits_.size());
  for (std::size_t k = 0; k < hits_.size(); ++k) {
    listed_target_[begin + k] = hits_[k].target;
    listed_walk_[begin + k] = hits_[k].value - tree_.price(hits_[k].target);
  }
}

}  // namespace footlight::planner::assignment
