// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/schedule/chain.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {

/// Why a plan is refused, one line for each section that cannot be walked: the worst walk and what would help, then the
/// worst conflict, then whatever else the judge found. Empty for a valid plan.
[[nodiscard]] std::vector<std::string> refusal_texts(const Show& show, const Plan& plan, const Verdict& verdict);

/// People who cannot pass each other on the way to an exact formation.
struct CannotPass {
  Instant start;
  SectionIndex section;  ///< to which they go
  double given_s = 0;
  std::optional<double> needed_s;                              ///< nothing: no way was found
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< performers, who come too near on straight walks
  std::optional<std::uint32_t> last;                           ///< performer who would arrive last, where known
};

/// "file:line:col: error: sections[i]: performers 3 and 7 ... cannot pass each other ...": with the time that would do.
[[nodiscard]] std::string cannot_pass_text(const Show& show, const CannotPass& fact);

}  // namespace footlight::planner
