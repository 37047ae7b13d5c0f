// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/cast/desk_word.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// What phones know of the show: an instant of the cast's clock, where the show was then and how fast it goes. They go
/// on by themselves; they are told when what they show would be wrong.
class ShowNow {
 public:
  /// Phones may be off by so much.
  static constexpr double kAllowed_s = 0.06;

  /// @param came when, by the cast's clock  @return whether phones have to be told
  [[nodiscard]] bool take(const DeskWord& word, Instant came);
  /// The desk is not heard. @return whether that is new
  [[nodiscard]] bool lost();
  /// Another plan is shown from here on. @param same whether it is the one that the desk plays
  void take_plan(bool same);
  /// A reset move is known, or none any more. @return whether that is new
  bool take_way(bool there);

  [[nodiscard]] bool heard() const { return heard_; }
  [[nodiscard]] bool same_plan() const { return same_plan_; }
  [[nodiscard]] const DeskWord& word() const { return word_; }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
  /// Where the show is at an instant of the cast's clock, s.
  [[nodiscard]] double position_s(Instant now) const;
  /// One message for all. @param stops_s where the show will stand, if it is known
  [[nodiscard]] std::string json(Instant now, std::optional<double> stops_s) const;

 private:
  [[nodiscard]] bool differs(const DeskWord& word, Instant came) const;

  DeskWord word_;
  Instant at_ = Instant::min();
  bool heard_ = false;
  bool same_plan_ = true;
  std::uint32_t epoch_ = 1;  ///< of plans
  std::uint32_t ways_ = 0;   ///< reset moves so far
  bool way_ = false;
};

}  // namespace footlight::app
