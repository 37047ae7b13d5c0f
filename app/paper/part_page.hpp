// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/paper/part.hpp"
#include "app/paper/sheet_rows.hpp"
#include "app/paper/stamp.hpp"

namespace footlight::app {

/// Makes one performer's part an HTML page for a telephone: one place after the other, seen with the performer's own
/// eyes, the audience above. A page needs no other file and no network, and forbids itself to ask for any; without
/// scripts it shows all places, without maps. The words are the dot sheet's. Borrows the show and the plan.
class PartPages {
 public:
  PartPages(const Show& show, const Plan& plan, Stamp stamp, const PlaceWords& words);
  [[nodiscard]] std::string page_of(PerformerIndex who, const Part& part) const;

 private:
  [[nodiscard]] std::string section(const Place& place, const SheetRow& row, const std::string& cue) const;
  [[nodiscard]] std::string neighbours(const Place& place) const;
  [[nodiscard]] std::string word(Word word) const;
  [[nodiscard]] const std::string& name_of(PerformerIndex who) const { return show_.performers.at(who.at()).name; }

  const Show& show_;
  const Plan& plan_;
  Stamp stamp_;
  SheetWords words_;
  std::string floor_;  ///< its hull in centimetres, left, downstage, right, upstage, and the pitch
};

/// A page with a link to each part. @param people  names, and the files of their pages beside this one
[[nodiscard]] std::string parts_index(const std::vector<std::pair<std::string, std::string>>& people,
                                      const Stamp& stamp, Language language);

/// A part in few bytes, for a QR code that leads nowhere: the name, the plan's digits, and in each line from when to
/// when on which cell. What does not fit is counted in the last line.
[[nodiscard]] std::string part_text(const Show& show, const Plan& plan, const Stamp& stamp, PerformerIndex who,
                                    const Part& part, Language language, std::size_t most_bytes);

}  // namespace footlight::app
