// SPDX-License-Identifier: Apache-2.0
#include "app/paper/sheet_rows.hpp"

#include <cmath>

#include "core/sha256.hpp"

namespace footlight::app {
namespace {

// Who has more time than steps makes as many as she likes.
constexpr double kShortestStep_m = 0.25;

std::string centimetres(double metres) { return fmt::format("{:.0f}", 100 * metres); }

}  // namespace

SheetWords::SheetWords(const Show& show, const Plan& plan, const PlaceWords& words)
    : show_(show), plan_(plan), words_(words), plays_(controller::cue_plays(show, plan)) {}

std::string SheetWords::count(Instant instant) const { return spoken_count(show_.tempo.count_at(instant)); }

std::string SheetWords::beside(const Place& place) const {
  std::string out;
  const auto add = [&](const std::optional<PerformerIndex>& who, Word word) {
    if (!who) return;
    if (!out.empty()) out += "  ";
    out += say(words_.language, word, fmt::arg("name", show_.performers.at(who->at()).name));
  };
  add(place.left, Word::beside_left);
  add(place.right, Word::beside_right);
  add(place.ahead, Word::ahead);
  return out.empty() ? say(words_.language, Word::nobody_near) : out;
}

SheetRow SheetWords::row_of(const Place& place, bool last) const {
  const Language language = words_.language;
  const Grid& grid = plan_.stage.grid;
  SheetRow out;
  const double from = show_.tempo.count_at(place.from);
  out.count = spoken_count(from);
  out.measure = show_.tempo.measure_beat(std::round(100 * from) / 100);
  out.cell = grid.name(place.cell);
  out.place = place_in_words(words_, grid, grid.centre(place.cell));
  out.beside = beside(place);
  if (last) {
    out.stay = say(language, Word::stay_to_the_end);
  } else if (place.until > place.from) {
    out.stay = say(language, Word::stay_until, fmt::arg("count", count(place.until)));
  }
  if (place.way) {
    const Way& way = *place.way;
    const Word told = way.step_m() < kShortestStep_m ? Word::small_steps
                      : way.steps == 1               ? Word::one_step
                                                     : Word::steps;
    out.way = say(language, told, fmt::arg("n", way.steps), fmt::arg("m", fmt::format("{:.1f}", way.length_m)),
                  fmt::arg("direction", text_of(language, direction_of(way.walk))),
                  fmt::arg("facing", text_of(language, facing_of(way.walk))),
                  fmt::arg("foot", text_of(language, way.left_foot ? Word::left_foot : Word::right_foot)),
                  fmt::arg("cm", centimetres(way.step_m())));
    out.way += language == Language::chinese ? "，" : ", ";
    out.way += say(language, Word::arrive_at, fmt::arg("count", count(way.arrive)));
    if (way.closest) {
      out.closest =
          say(language, Word::closest, fmt::arg("name", show_.performers.at(way.closest->who.at()).name),
              fmt::arg("cm", centimetres(way.closest->distance_m)), fmt::arg("count", count(way.closest->at)));
    }
  }
  const Word light = place.look == "here"       ? Word::light_here
                     : place.look == "arrive"   ? Word::light_arrive
                     : place.look == "handover" ? Word::light_handover
                                                : Word::light_dark;
  out.light = say(language, light);
  return out;
}

std::vector<SheetRow> SheetWords::rows_of(const Part& part) const {
  std::vector<SheetRow> out;
  std::size_t cue = plays_.size();
  for (std::size_t i = 0; i < part.size(); ++i) {
    out.push_back(row_of(part[i], i + 1 == part.size()));
    std::size_t now = 0;
    while (now + 1 < plays_.size() && plays_[now].to < part[i].from) ++now;
    if (now == cue || plays_.empty()) continue;
    cue = now;
    out.back().cue = say(words_.language, Word::cue, fmt::arg("number", plays_[now].cue.number.to_text()),
                         fmt::arg("name", plays_[now].cue.name));
  }
  return out;
}

std::string digits_of(const std::vector<SheetRow>& rows) {
  std::string all;
  for (const SheetRow& row : rows) {
    for (const std::string* text : {&row.cue, &row.count, &row.measure, &row.cell, &row.place, &row.stay, &row.way,
                                    &row.beside, &row.closest, &row.light}) {
      all.append(*text).append(1, '\n');
    }
  }
  return Sha256().text(all).hex().substr(0, 6);
}

}  // namespace footlight::app
