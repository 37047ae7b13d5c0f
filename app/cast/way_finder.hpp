// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cast/cast_plan.hpp"
#include "app/cast/desk_word.hpp"

namespace footlight::app {

/// Where the show will stand and wait for somebody: at the end of a cue, of a loop, or of the set. Nothing: it goes on
/// to its end.
[[nodiscard]] std::optional<Instant> stops_at(const CastPlan& cast, const DeskWord& word, Instant position);

/// Answers "where?". Ways that were given are kept, so that two who are lost are not sent into each other. One thread.
class WayFinder {
 public:
  /// Nobody sets out sooner: time to read it, and to look around.
  static constexpr Duration kToRead = milliseconds(4000);
  static constexpr Duration kAhead = milliseconds(60'000);  ///< so much of the show is looked at
  static constexpr std::size_t kMostGiven = 256;

  struct Question {
    PerformerIndex who;
    CellIndex from;
    Language language = Language::english;
    DeskWord word;  ///< where the show is
    Instant position;
  };
  /// {"where": {"who", "kind", "places", "until_s", "ask_s", "at_once"}}: docs/cast.md.
  [[nodiscard]] std::string answer(const std::shared_ptr<const CastPlan>& cast, const Question& question);
  /// Ways that are under way.
  [[nodiscard]] std::size_t given() const { return given_.size(); }

 private:
  /// Everybody where she stands while the show does.
  struct Standing {
    Instant position;
    Plan plan;
    std::optional<planner::WaysIn> ways;
    std::shared_ptr<const planner::WaysIn::Stretch> stretch;
  };
  void take(const std::shared_ptr<const CastPlan>& cast);
  [[nodiscard]] planner::WayIn way_while_it_runs(const Question& question, Instant latest);
  [[nodiscard]] std::optional<planner::WayIn> way_while_it_stands(const Question& question);
  void forget(Instant position);

  std::shared_ptr<const CastPlan> cast_;
  std::vector<planner::GivenWay> given_;
  std::shared_ptr<const planner::WaysIn::Stretch> stretch_;
  Instant stretch_from_;
  Instant stretch_to_;
  std::unique_ptr<Standing> standing_;
};

}  // namespace footlight::app
