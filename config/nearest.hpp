// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footlight::config {

/// Edit distance with transpositions (optimal string alignment; Damerau 1964), ASCII case ignored. O(|a| |b|)
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);
/// The candidate that `word` was probably meant to be; empty when none is near. The first among equals.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);
/// `did you mean "clearance"?`, or `known keys: a, b, c` when nothing is near. @param kind plural, as "known keys"
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& candidates,
                                     std::string_view kind);
/// `"text"`, shortened when long.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace footlight::config
