// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/paper/part.hpp"
#include "app/paper/words.hpp"
#include "controller/cue_list.hpp"
#include "controller/stands.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "planner/way_in.hpp"

namespace footlight::app {

/// Tracks as the console tells them (docs/console.md, "GET /api/plan.bin"), to the rounding of their times.
/// Errors (ErrorKind::input): not such a document, of other people than `people`, or of cells beyond `cells`.
[[nodiscard]] Result<std::vector<std::vector<Mark>>> tracks_from(std::string_view plan_bin, std::size_t people,
                                                                 int cells);

/// A show and its plan for the phones of its people: names, parts in words, ways in. Nothing in it changes.
class CastPlan {
 public:
  /// O(marks log marks + near pairs): everybody's part is made
  CastPlan(Show show, Plan plan);
  CastPlan(const CastPlan&) = delete;
  CastPlan& operator=(const CastPlan&) = delete;

  [[nodiscard]] const Show& show() const { return show_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] const planner::WaysIn& ways() const { return ways_; }
  [[nodiscard]] const controller::Stands& stands() const { return stands_; }
  [[nodiscard]] const std::vector<controller::CuePlay>& plays() const { return plays_; }

  /// The same show with other tracks, where people walk otherwise than the file says: absent people, an edit.
  [[nodiscard]] std::shared_ptr<const CastPlan> with(std::vector<std::vector<Mark>> tracks) const;

  /// For GET /api/show: stage, names, groups, cues, tempo; no lamps.
  [[nodiscard]] std::string show_json() const;
  /// `{"who": 7, "places": [...]}`: what is on her sheet, with the sheet's words. @param who of the plan
  [[nodiscard]] std::string part_json(PerformerIndex who, Language language) const;

 private:
  Show show_;
  Plan plan_;
  std::vector<Part> parts_;
  std::vector<controller::CuePlay> plays_;
  controller::Stands stands_;
  planner::WaysIn ways_;
};

/// Somebody's marks in the sheet's words, as an array for JSON: [{"from_s", "until_s", "cell", "count", "measure",
/// "place", "stay", "way", "beside"}]. @param show its tempo counts the marks' times  @param stage, sections of the
/// plan
[[nodiscard]] std::string places_json(const Show& show, const Plan& plan, PerformerIndex who,
                                      const std::vector<Mark>& marks, Language language);

}  // namespace footlight::app
