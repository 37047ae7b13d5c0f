// SPDX-License-Identifier: Apache-2.0
#include "app/paper/words.hpp"

#include <array>
#include <cstddef>

#include "core/check.hpp"

namespace footlight::app {
namespace {

struct Entry {
  Word word;
  std::array<const char*, kLanguages> texts;
};

constexpr std::array kCatalogue = {
    Entry{Word::left_of_centre, {"{n} steps stage left of centre", "中线舞台左侧 {n} 步"}},
    Entry{Word::right_of_centre, {"{n} steps stage right of centre", "中线舞台右侧 {n} 步"}},
    Entry{Word::on_centre, {"on the centre line", "在中线上"}},
    Entry{Word::upstage_of_row, {"{n} upstage of row {row}", "第 {row} 排往后 {n} 步"}},
    Entry{Word::downstage_of_row, {"{n} downstage of row {row}", "第 {row} 排往前 {n} 步"}},
    Entry{Word::on_row, {"on row {row}", "在第 {row} 排上"}},
    Entry{Word::side_outside, {"Side {side}: {n} steps outside {yard} yd ln", "第 {side} 侧：{yard} 码线外 {n} 步"}},
    Entry{Word::side_inside, {"Side {side}: {n} steps inside {yard} yd ln", "第 {side} 侧：{yard} 码线内 {n} 步"}},
    Entry{Word::side_on_line, {"Side {side}: on {yard} yd ln", "第 {side} 侧：在 {yard} 码线上"}},
    Entry{Word::on_fifty, {"on 50 yd ln", "在 50 码线上"}},
    Entry{Word::behind, {"{n} steps behind {line}", "{line}后 {n} 步"}},
    Entry{Word::in_front_of, {"{n} steps in front of {line}", "{line}前 {n} 步"}},
    Entry{Word::on_line, {"on {line}", "在{line}上"}},
    Entry{Word::front_sideline, {"front side line", "前边线"}},
    Entry{Word::front_hash, {"front hash", "前标线"}},
    Entry{Word::back_hash, {"back hash", "后标线"}},
    Entry{Word::back_sideline, {"back side line", "后边线"}},
    Entry{Word::upstage, {"upstage", "向台后"}},
    Entry{Word::upstage_left, {"upstage left", "向台后左"}},
    Entry{Word::stage_left, {"stage left", "向舞台左"}},
    Entry{Word::downstage_left, {"downstage left", "向台前左"}},
    Entry{Word::downstage, {"downstage", "向台前"}},
    Entry{Word::downstage_right, {"downstage right", "向台前右"}},
    Entry{Word::stage_right, {"stage right", "向舞台右"}},
    Entry{Word::upstage_right, {"upstage right", "向台后右"}},
    Entry{Word::backward, {"backward", "后退"}},
    Entry{Word::backward_left, {"backward left", "左后退"}},
    Entry{Word::to_the_left, {"to your left", "向左横移"}},
    Entry{Word::forward_left, {"forward left", "左前进"}},
    Entry{Word::forward, {"forward", "前进"}},
    Entry{Word::forward_right, {"forward right", "右前进"}},
    Entry{Word::to_the_right, {"to your right", "向右横移"}},
    Entry{Word::backward_right, {"backward right", "右后退"}},
    Entry{Word::left_foot, {"left foot first", "左脚先"}},
    Entry{Word::right_foot, {"right foot first", "右脚先"}},
    Entry{Word::one_step,
          {"1 step {direction} ({facing}), {foot}, {cm} cm", "1 步{direction}（{facing}），{foot}，步长 {cm} 厘米"}},
    Entry{Word::steps,
          {"{n} steps {direction} ({facing}), {foot}, {cm} cm each",
           "{n} 步{direction}（{facing}），{foot}，步长 {cm} 厘米"}},
    Entry{Word::small_steps,
          {"{m} m {direction} ({facing}) in {n} counts, {foot}", "{n} 拍内{direction}（{facing}）{m} 米，{foot}"}},
    Entry{Word::arrive_at, {"there at {count}", "第 {count} 拍到位"}},
    Entry{Word::stay_until, {"stay until {count}", "停到第 {count} 拍"}},
    Entry{Word::stay_to_the_end, {"stay to the end", "停到结束"}},
    Entry{Word::beside_left, {"left {name}", "左 {name}"}},
    Entry{Word::beside_right, {"right {name}", "右 {name}"}},
    Entry{Word::ahead, {"ahead {name}", "前 {name}"}},
    Entry{Word::closest, {"closest {name}: {cm} cm at {count}", "最近 {name}：{cm} 厘米，第 {count} 拍"}},
    Entry{Word::nobody_near, {"nobody near", "附近无人"}},
    Entry{Word::light_here, {"light: here", "灯：在此"}},
    Entry{Word::light_arrive, {"light: pass", "灯：经过"}},
    Entry{Word::light_handover, {"light: hand over", "灯：交接"}},
    Entry{Word::light_dark, {"dark", "暗"}},
    Entry{Word::cue, {"Cue {number}  {name}", "第 {number} 场  {name}"}},
    Entry{Word::group, {"group {name}", "{name} 组"}},
    Entry{
        Word::legend,
        {"You face the audience; left and right are yours. 1 step of a place = {cm} cm. A measure has {beats} counts.",
         "面向观众，左右以自己为准。位置中的 1 步 = {cm} 厘米。每小节 {beats} 拍。"}},
    Entry{Word::page_of, {"{page} of {pages}", "第 {page} 页，共 {pages} 页"}},
    Entry{Word::count_heading, {"Count", "拍"}},
    Entry{Word::place_heading, {"Place", "位置"}},
    Entry{Word::way_heading, {"Then", "然后"}},
    Entry{Word::others_heading, {"Beside you", "身边"}},
    Entry{Word::map_heading, {"Way", "路线"}},
    Entry{Word::call_list, {"Called cues", "口令表"}},
    Entry{Word::standby, {"Standby", "预备"}},
    Entry{Word::go, {"GO", "走"}},
    Entry{Word::follows, {"follows by itself", "自动接续"}},
    Entry{Word::walk_and_wait, {"{walk} walk, {wait} stay", "{walk} 人走，{wait} 人留"}},
    Entry{Word::everybody, {"everybody", "全体"}},
    Entry{Word::audience, {"audience", "观众"}},
    Entry{Word::stage_right_side, {"stage right", "舞台右"}},
    Entry{Word::stage_left_side, {"stage left", "舞台左"}},
    Entry{Word::you, {"you", "你"}},
    Entry{Word::next_place, {"next place", "下一个位置"}},
    Entry{Word::place_before, {"place before", "上一个位置"}},
    Entry{Word::dark_or_light, {"dark or light", "深色或浅色"}},
    Entry{Word::whole_floor, {"the floor", "全场"}},
    Entry{Word::your_way, {"your way", "你的路线"}},
    Entry{Word::and_more, {"and {n} more", "还有 {n} 个"}},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kCatalogue.size(); ++i) {
    if (kCatalogue[i].word != static_cast<Word>(i)) return false;
  }
  return kCatalogue.size() == static_cast<std::size_t>(Word::number_of_words);
}
static_assert(in_order(), "every word once, in the order of the enumeration");

}  // namespace

std::optional<Language> language_from(std::string_view code) {
  if (code == "en") return Language::english;
  if (code == "zh") return Language::chinese;
  return std::nullopt;
}

const char* code_of(Language language) { return language == Language::chinese ? "zh-cn" : "en"; }

std::string_view text_of(Language language, Word word) {
  return kCatalogue[static_cast<std::size_t>(word)].texts[static_cast<std::size_t>(language)];
}

}  // namespace footlight::app
