// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace footlight::app {

/// Where the lines of a football field are by which drill tells places, in steps of 8 to 5 (22.5 inches) from the front
/// side line.
enum class HashLines {
  college,      ///< 32, 52
  high_school,  ///< 28, 56
};
enum class FieldDepth {
  grid,      ///< 84 steps, as drill programs draw it: hashes on whole steps
  measured,  ///< 160 feet: hashes 60 feet (college) or 53 feet 4 inches (high school) from the side lines
};
struct DrillField {
  HashLines hashes = HashLines::college;  ///< where the words do not say, as "(HS)" or "(CH)" do
  FieldDepth depth = FieldDepth::grid;
};

/// Steps, or what is wrong with the words and where in them.
struct DrillSteps {
  std::optional<double> steps;
  std::size_t offset = 0;  ///< byte of the text at which the error is
  std::string error;
  std::string hint;
  bool hash_assumed = false;  ///< a hash line without its kind
};

/// "Side 1: 2.5 steps outside 40 yd ln", "2 outside Side 2 35", "On 50 yd ln": steps from the 50 yard line, side 2 (the
/// audience's right, stage left) positive. Side 1 is also Left, A or S1. Yard lines are 0, 5 .. 50; outside is away
/// from the 50.
[[nodiscard]] DrillSteps side_to_side(std::string_view words);

/// "8.0 steps behind Front Hash (HS)", "4 in front of Back side line", "On Front sideline": steps from the front side
/// line, towards the back positive. Home and visitor are front and back.
[[nodiscard]] DrillSteps front_to_back(std::string_view words, const DrillField& field);

}  // namespace footlight::app
