// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

// The three files that other programs read (docs/export.md). Numbers survive a round trip; the same instant prints the
// same text in every row and file.

/// What each mark is, as marks.csv and dot sheets tell it: `dark` in the reserve, `here` for who stays, `handover`
/// where the performer leaves and somebody else comes before the next mark, `arrive` where the performer passes on the
/// way.
class MarkLooks {
 public:
  /// Borrows the plan. O(marks log marks)
  explicit MarkLooks(const Plan& plan);
  [[nodiscard]] std::string_view of(std::size_t performer, std::size_t mark) const;

 private:
  /// Whether somebody arrives on the cell after `from` and until `to`.
  [[nodiscard]] bool arrives(CellIndex cell, Instant from, Instant to) const;

  const Plan& plan_;
  std::vector<std::vector<Instant>> arrivals_;  ///< at each cell, ascending
};

/// A field of CSV after RFC 4180: in quotes where it must be, and where it would read as a comment or lose blanks.
[[nodiscard]] std::string csv_field(std::string_view text);

/// `performer,count,time_s,col,row,x_m,y_m,look,section`, a row for each mark, by performer in the show's order, then
/// time. `look`: see MarkLooks.
[[nodiscard]] std::string marks_csv(const Plan& plan, const Show& show);
/// `formation,count,time_s,frame,performer,col,row`; no frame where there is no video.
[[nodiscard]] std::string formations_csv(const Plan& plan);
/// Grid, limits, sections and how films lie on the stage. Media paths are as seen from the show file's folder.
[[nodiscard]] std::string stage_json(const Plan& plan, const Show& show);

}  // namespace footlight::app
