// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace footlight::planner {

/// Memory that steps need for their time and leave to the next one: asking the system for it anew in each step costs as
/// much as what is done with it. Nothing in it is remembered. Thread: reentrant, each user has one of her own.
template <class T>
class Spare {
 public:
  /// One that is given back when it goes out of scope.
  class Lent {
   public:
    Lent(const Spare& spare, std::unique_ptr<T> one) : spare_(spare), one_(std::move(one)) {}
    ~Lent() {
      const std::lock_guard lock(spare_.mutex_);
      spare_.free_.push_back(std::move(one_));
    }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    T& operator*() const { return *one_; }

   private:
    const Spare& spare_;
    std::unique_ptr<T> one_;
  };

  Spare() = default;
  /// A copy of a model has memory of its own.
  Spare(const Spare&) {}
  Spare& operator=(const Spare&) { return *this; }

  [[nodiscard]] Lent take() const {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return {*this, std::make_unique<T>()};
    auto one = std::move(free_.back());
    free_.pop_back();
    return {*this, std::move(one)};
  }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<T>> free_;
};

}  // namespace footlight::planner
