// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/kd_order.hpp"

#include <algorithm>
#include <cstddef>

namespace footlight::planner::assignment {
namespace {

constexpr std::size_t kFan = 16;
constexpr std::size_t kFour = 4;

struct Item {
  Point at;
  std::uint32_t id;
};

void split(std::span<Item> items) {
  if (items.size() <= kFour) return;
  std::size_t unit = kFour;
  if (items.size() > kFan) {
    for (unit = kFan; unit * kFan < items.size();) unit *= kFan;
  }
  const std::size_t units = (items.size() + unit - 1) / unit;
  const std::size_t half = units / 2 * unit;
  Point low = items[0].at;
  Point high = low;
  for (const Item& item : items) {
    low = {std::min(low.x, item.at.x), std::min(low.y, item.at.y)};
    high = {std::max(high.x, item.at.x), std::max(high.y, item.at.y)};
  }
  const auto middle = items.begin() + static_cast<std::ptrdiff_t>(half);
  if (high.x - low.x > high.y - low.y) {
    std::nth_element(items.begin(), middle, items.end(), [](const Item& a, const Item& b) {
      return a.at.x < b.at.x || (a.at.x == b.at.x && a.at.y < b.at.y);
    });
  } else {
    std::nth_element(items.begin(), middle, items.end(), [](const Item& a, const Item& b) {
      return a.at.y < b.at.y || (a.at.y == b.at.y && a.at.x < b.at.x);
    });
  }
  split(items.first(half));
  split(items.subspan(half));
}

}  // namespace

std::vector<std::uint32_t> kd_order(std::span<const Point> points) {
  std::vector<Item> items(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) items[i] = {points[i], static_cast<std::uint32_t>(i)};
  split(items);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].id;
  return order;
}

}  // namespace footlight::planner::assignment
