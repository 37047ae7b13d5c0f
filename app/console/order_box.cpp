// SPDX-License-Identifier: Apache-2.0
#include "app/console/order_box.hpp"

#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

namespace footlight::app {

OrderBox::OrderBox() : wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

void OrderBox::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);
}

bool OrderBox::put(SaidOrder order, bool hold) {
  {
    const std::lock_guard lock(mutex_);
    std::deque<SaidOrder>& queue = hold ? holds_ : orders_;
    if (queue.size() >= (hold ? kMostHolds : kMostOrders)) return false;
    queue.push_back(std::move(order));
  }
  wake();
  return true;
}

std::vector<SaidOrder> OrderBox::take(std::size_t most) {
  std::vector<SaidOrder> out;
  const std::lock_guard lock(mutex_);
  std::uint64_t count = 0;
  (void)!::read(wake_.get(), &count, sizeof count);
  for (std::deque<SaidOrder>* queue : {&holds_, &orders_}) {
    while (out.size() < most && !queue->empty()) {
      out.push_back(std::move(queue->front()));
      queue->pop_front();
    }
  }
  return out;
}

}  // namespace footlight::app
