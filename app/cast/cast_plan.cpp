// SPDX-License-Identifier: Apache-2.0
#include "app/cast/cast_plan.hpp"

#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console/show_document.hpp"
#include "app/paper/sheet_rows.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json places_of(const SheetWords& words, const Part& part) {
  const std::vector<SheetRow> rows = words.rows_of(part);
  Json places = Json::array();
  for (std::size_t i = 0; i < part.size(); ++i) {
    places.push_back({{"from_s", to_seconds(part[i].from)},
                      {"until_s", to_seconds(part[i].until)},
                      {"cell", part[i].cell.value()},
                      {"count", rows[i].count},
                      {"measure", rows[i].measure},
                      {"place", rows[i].place},
                      {"stay", rows[i].stay},
                      {"way", rows[i].way},
                      {"beside", rows[i].beside}});
  }
  return places;
}

/// Reads the document from its beginning to its end.
class Words {
 public:
  explicit Words(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T next() {
    T value{};
    if (at_ + sizeof value > bytes_.size()) {
      short_ = true;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] bool cut_off() const { return short_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool short_ = false;
};

}  // namespace

Result<std::vector<std::vector<Mark>>> tracks_from(std::string_view plan_bin, std::size_t people, int cells) {
  const auto wrong = [](const std::string& what) { return input_error("the desk's plan " + what); };
  Words words(plan_bin);
  if (words.next<std::uint32_t>() != 0x4d504c46U || words.next<std::uint32_t>() != 1) {  // FLPM
    return wrong("is of another version of Footlight");
  }
  (void)words.next<std::uint32_t>();
  const auto told = words.next<std::uint32_t>();
  const auto marks = words.next<std::uint32_t>();
  if (words.cut_off() || words.left() != 4 * (std::size_t{told} + 1) + 8 * std::size_t{marks}) {
    return wrong("is not as long as it says");
  }
  if (told != people) return wrong(fmt::format("is of {} people, this show of {}", told, people));
  std::vector<std::uint32_t> first(people + 1);
  for (std::uint32_t& one : first) one = words.next<std::uint32_t>();
  std::vector<float> time_s(marks);
  for (float& one : time_s) one = words.next<float>();
  std::vector<std::vector<Mark>> tracks(people);
  if (first.front() != 0 || first.back() != marks) return wrong("has marks that are nobody's");
  for (std::size_t p = 0; p < people; ++p) {
    if (first[p] >= first[p + 1] || first[p + 1] > marks) return wrong("has people without marks");
    for (std::uint32_t k = first[p]; k < first[p + 1]; ++k) {
      const auto cell = words.next<std::uint32_t>();
      if (cell >= static_cast<std::uint32_t>(cells)) return wrong("has cells that are not on this stage");
      if (!std::isfinite(time_s[k]) || std::abs(time_s[k]) > 1e7F) return wrong("has times that are none");
      const Instant time = instant_at(static_cast<double>(time_s[k]));
      if (!tracks[p].empty() && tracks[p].back().time >= time) return wrong("has marks that are out of order");
      tracks[p].push_back({time, CellIndex(cell)});
    }
  }
  return tracks;
}

CastPlan::CastPlan(Show show, Plan plan)
    : show_(std::move(show)),
      plan_(std::move(plan)),
      parts_(parts_of(plan_, show_)),
      plays_(controller::cue_plays(show_, plan_)),
      stands_(plan_),
      ways_(plan_) {}

std::shared_ptr<const CastPlan> CastPlan::with(std::vector<std::vector<Mark>> tracks) const {
  Plan plan = plan_;
  plan.tracks = std::move(tracks);
  return std::make_shared<const CastPlan>(show_, std::move(plan));
}

std::string CastPlan::show_json() const {
  Json json = Json::parse(app::show_json({show_, plan_}));
  for (const char* lamps :
       {"epoch", "markers", "nodes", "switches", "sections", "formations", "switch_at", "buses", "rig", "looks"}) {
    json.erase(lamps);
  }
  return text_of(json);
}

std::string CastPlan::part_json(PerformerIndex who, Language language) const {
  PlaceWords style;
  style.language = language;
  return text_of({{"who", who.value()}, {"places", places_of(SheetWords(show_, plan_, style), parts_.at(who.at()))}});
}

std::string places_json(const Show& show, const Plan& plan, PerformerIndex who, const std::vector<Mark>& marks,
                        Language language) {
  Plan own;
  own.stage = plan.stage;
  own.sections = plan.sections;
  own.performers = {plan.performers.at(who.at())};
  own.radius_m = {0};
  own.max_speed_mps = {0};
  own.tracks = {marks};
  PlaceWords style;
  style.language = language;
  return text_of(places_of(SheetWords(show, own, style), parts_of(own, show).front()));
}

}  // namespace footlight::app
