// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::planner {

/// What becomes of the track of somebody who does not come.
struct StandIn {
  PerformerIndex absent;
  std::optional<PerformerIndex> taker;  ///< walks it instead of her own, which nobody walks; nothing: it stays empty
  Duration on_stage{};                  ///< of the track: out of the reserve
  Duration given_up{};                  ///< of the taker's own track: out of the reserve
  std::size_t marks = 0;                ///< of the track
  /// Takes the way and gives nothing up for it, having none of her own: a place in the show's list.
  std::optional<std::size_t> understudy{};

  friend bool operator==(const StandIn&, const StandIn&) = default;
};

/// Who has no way of her own and covers this absent person; nothing: nobody does. A place in the show's list
[[nodiscard]] std::optional<std::size_t> understudy_of(const Show& show, const Performer& absent);

/// The fewest changes for the others: for each absent person, in order, whoever comes, stands in for nobody yet, can
/// walk the track, is of the same group where groups have places of their own, and is on stage least (the first of
/// equals), if that is less than the track is on stage. Nobody else changes, and a track that never leaves the reserve
/// needs nobody. Where the show says who covers her it is that one, whoever that is: what she cannot walk the judge
/// finds.
/// @param tracks of everybody in the show, as if all of them came
/// @param wide_enough every track keeps the distances of the widest people; else a taker is as narrow as the absent
/// O(marks + absent x people)
[[nodiscard]] std::vector<StandIn> stand_ins(const Show& show, const std::vector<std::vector<Mark>>& tracks,
                                             bool wide_enough);

/// "performer 4 is absent: performer 7 takes the way; 1 of 12 people changes, 9 marks"
[[nodiscard]] std::string stand_in_text(const Show& show, const StandIn& stand_in);

}  // namespace footlight::planner
