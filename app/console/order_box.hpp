// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "core/file_descriptor.hpp"

namespace footlight::app {

/// An order on its way from the console's thread to the desk.
struct SaidOrder {
  std::string line;
  std::string who;
  std::uint64_t tag = 0;  ///< Speaker::tag
};

/// Orders that wait for the desk. What does not fit is lost, but a HOLD always has a place: those that wait already
/// do what it wants. Two threads.
class OrderBox {
 public:
  static constexpr std::size_t kMostOrders = 64;
  static constexpr std::size_t kMostHolds = 16;

  OrderBox();
  /// @return false: there are too many
  bool put(SaidOrder order, bool hold);
  /// HOLDs first, then the oldest; at most so many.
  [[nodiscard]] std::vector<SaidOrder> take(std::size_t most);
  /// Becomes readable when something is in it; -1: the system has none to give.
  [[nodiscard]] int file() const { return wake_.get(); }
  /// Somebody asks for something else than an order.
  void wake() const;

 private:
  std::mutex mutex_;
  std::deque<SaidOrder> holds_;
  std::deque<SaidOrder> orders_;
  FileDescriptor wake_;
};

}  // namespace footlight::app
