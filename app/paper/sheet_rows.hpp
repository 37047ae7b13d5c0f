// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/paper/part.hpp"
#include "app/paper/stage_words.hpp"
#include "controller/cue_list.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// One place of a part in words.
struct SheetRow {
  std::string cue;      ///< heading of the cue that begins with this row; else empty
  std::string count;    ///< on which she arrives
  std::string measure;  ///< "17:3"
  std::string cell;
  std::string place;
  std::string stay;    ///< until when
  std::string way;     ///< to the next place; empty for the last
  std::string beside;  ///< left, right and ahead of her
  std::string closest;
  std::string light;

  friend bool operator==(const SheetRow&, const SheetRow&) = default;
};

/// Puts parts into words. Borrows everything.
class SheetWords {
 public:
  SheetWords(const Show& show, const Plan& plan, const PlaceWords& words);
  [[nodiscard]] std::vector<SheetRow> rows_of(const Part& part) const;
  [[nodiscard]] const PlaceWords& words() const { return words_; }

 private:
  [[nodiscard]] SheetRow row_of(const Place& place, bool last) const;
  [[nodiscard]] std::string beside(const Place& place) const;
  [[nodiscard]] std::string count(Instant instant) const;

  const Show& show_;
  const Plan& plan_;
  PlaceWords words_;
  std::vector<controller::CuePlay> plays_;
};

/// Six hexadecimal digits that stay the same while what the rows say does: a sheet that was not printed anew is still
/// right when its digits are.
[[nodiscard]] std::string digits_of(const std::vector<SheetRow>& rows);

}  // namespace footlight::app
