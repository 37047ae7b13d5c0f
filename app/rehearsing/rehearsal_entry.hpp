// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/rehearsing/remark.hpp"

namespace footlight::app {

/// One line of what happened in a rehearsal.
struct RehearsalEntry {
  enum class Kind : std::uint8_t {
    begun,    ///< the program; `text` is the show's title
    start,    ///< of a cue
    end,      ///< of a cue
    hold,     ///< in a cue
    goes_on,  ///< after a hold
    reset,    ///< people were sent to another place
    order,    ///< an order of the desk that was carried out
    refused,  ///< one that was not
    alarm,
    note,
    absent,  ///< somebody is, by the desk's word; `text` is her name
    ended,   ///< the program, as it should
  };
  Kind kind = Kind::order;
  double since_1970_s = 0;  ///< wall clock
  double position_s = 0;    ///< show time
  double count = 0;
  std::string cue{};   ///< number; empty: none
  std::string who{};   ///< said it, where somebody did
  std::string text{};  ///< of a note: what is written
  Remark::About about = Remark::About::all;
  std::string whom{};
};

[[nodiscard]] std::string_view to_text(RehearsalEntry::Kind kind);

/// One line of JSON, without its end.
[[nodiscard]] std::string json_of(const RehearsalEntry& entry);
/// Nothing for a line that is none: the last one of a program that was killed may be cut.
[[nodiscard]] std::optional<RehearsalEntry> entry_from(std::string_view line);

}  // namespace footlight::app
