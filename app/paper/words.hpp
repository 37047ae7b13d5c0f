// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace footlight::app {

/// The language of a performer's paper.
enum class Language { english, chinese };
inline constexpr int kLanguages = 2;

/// "en", "zh".
[[nodiscard]] std::optional<Language> language_from(std::string_view code);
/// As Pango and HTML know it: "en", "zh-cn".
[[nodiscard]] const char* code_of(Language language);

/// What is printed on paper for performers. Each has a text in every language (words.cpp), with the same places to
/// fill.
enum class Word {
  left_of_centre,
  right_of_centre,
  on_centre,
  upstage_of_row,
  downstage_of_row,
  on_row,
  side_outside,
  side_inside,
  side_on_line,
  on_fifty,
  behind,
  in_front_of,
  on_line,
  front_sideline,
  front_hash,
  back_hash,
  back_sideline,
  upstage,
  upstage_left,
  stage_left,
  downstage_left,
  downstage,
  downstage_right,
  stage_right,
  upstage_right,
  backward,
  backward_left,
  to_the_left,
  forward_left,
  forward,
  forward_right,
  to_the_right,
  backward_right,
  left_foot,
  right_foot,
  one_step,
  steps,
  small_steps,
  arrive_at,
  stay_until,
  stay_to_the_end,
  beside_left,
  beside_right,
  ahead,
  closest,
  nobody_near,
  light_here,
  light_arrive,
  light_handover,
  light_dark,
  cue,
  group,
  legend,
  page_of,
  count_heading,
  place_heading,
  way_heading,
  others_heading,
  map_heading,
  call_list,
  standby,
  go,
  follows,
  walk_and_wait,
  everybody,
  audience,
  stage_right_side,
  stage_left_side,
  you,
  next_place,
  place_before,
  dark_or_light,
  whole_floor,
  your_way,
  and_more,
  // Keep last.
  number_of_words,
};

/// The text, with places as {name}.
[[nodiscard]] std::string_view text_of(Language language, Word word);

/// The text with its places filled by fmt::arg("name", value).
template <class... Arguments>
[[nodiscard]] std::string say(Language language, Word word, Arguments&&... arguments) {
  return fmt::format(fmt::runtime(text_of(language, word)), std::forward<Arguments>(arguments)...);
}

}  // namespace footlight::app
