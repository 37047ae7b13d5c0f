// SPDX-License-Identifier: Apache-2.0
#include "app/console/show_document.hpp"

#include <bit>
#include <cstring>
#include <string_view>

#include <nlohmann/json.hpp>

#include "controller/cue_list.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the documents are little endian, and written as they lie");

template <class T>
void put(std::string& out, T value) {
  static_assert(sizeof(T) == 4);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_count(std::string& out, std::size_t value) { put(out, static_cast<std::uint32_t>(value)); }

Json cells_json(const std::vector<CellIndex>& cells) {
  Json out = Json::array();
  for (const CellIndex cell : cells) out.push_back(cell.value());
  return out;
}

Json stage_json(const Stage& stage) {
  return {{"grid", to_text(stage.grid.kind())}, {"columns", stage.grid.columns()},
          {"rows", stage.grid.rows()},          {"pitch_m", stage.grid.pitch_m()},
          {"clearance_m", stage.clearance_m},   {"blocked", cells_json(stage.blocked)},
          {"wings", cells_json(stage.reserve)}};
}

void tell_people(Json& json, const Show& show) {
  json["groups"] = Json::array();
  for (const Group& group : show.groups) {
    json["groups"].push_back({{"name", group.name}, {"colour", to_text(group.colour)}, {"exchange", group.exchange}});
  }
  json["performers"] = Json::array();
  for (const Performer& one : show.performers) {
    Json person{{"id", one.id}, {"name", one.name}, {"group", nullptr}};
    if (one.group) person["group"] = one.group->value();
    if (one.absent) person["absent"] = true;
    json["performers"].push_back(std::move(person));
  }
}

void tell_sections(Json& json, const Show& show, const Plan& plan) {
  json["sections"] = Json::array();
  for (const PlanSection& section : plan.sections) {
    json["sections"].push_back({{"name", section.name},
                                {"start_s", to_seconds(section.start)},
                                {"end_s", to_seconds(section.end)},
                                {"start_count", show.tempo.count_at(section.start)},
                                {"max_speed_mps", section.max_speed_mps},
                                {"notes", section.notes}});
  }
  json["formations"] = Json::array();
  for (const Formation& formation : plan.formations) {
    json["formations"].push_back({{"id", formation.id},
                                  {"section", formation.section.value()},
                                  {"count", formation.count},
                                  {"time_s", to_seconds(formation.time)},
                                  {"key", formation.key}});
  }
}

std::string_view to_text(ContinueMode mode) {
  switch (mode) {
    case ContinueMode::manual:
      return "manual";
    case ContinueMode::auto_continue:
      return "auto-continue";
    case ContinueMode::auto_follow:
      return "auto-follow";
  }
  return "";
}

void tell_cues(Json& json, const ShownShow& shown) {
  json["cues"] = Json::array();
  const auto plays = controller::cue_plays(shown.show, shown.plan);
  for (std::size_t c = 0; c < plays.size(); ++c) {
    const controller::CuePlay& play = plays[c];
    Json cue{{"number", play.cue.number.to_text()},
             {"name", play.cue.name},
             {"from_s", to_seconds(play.from)},
             {"to_s", to_seconds(play.to)},
             {"gap_after_s", nullptr},
             {"pre_wait_s", to_seconds(play.cue.pre_wait)},
             {"post_wait_s", to_seconds(play.cue.post_wait)},
             {"continue", to_text(play.cue.continue_mode)},
             {"notes", play.cue.notes}};
    if (play.gap_after) cue["gap_after_s"] = to_seconds(*play.gap_after);
    if (shown.limits != nullptr && c < shown.limits->size()) {
      cue["most_percent"] = (*shown.limits)[c].percent;
      cue["because"] = (*shown.limits)[c].because;
    }
    json["cues"].push_back(std::move(cue));
  }
}

void tell_tempo(Json& json, const TempoMap& tempo) {
  json["tempo"] = Json::array();
  for (const TempoChange& change : tempo.changes()) {
    json["tempo"].push_back(
        {{"count", change.count}, {"time_s", to_seconds(tempo.at(change.count))}, {"bpm", change.bpm}});
  }
  json["meter"] = Json::array();
  for (const MeterChange& change : tempo.meters()) {
    json["meter"].push_back({{"count", change.count}, {"beats", change.beats}});
  }
}

void tell_schedule(Json& json, const controller::CueSchedule* schedule) {
  json["switch_at"] = Json::array();
  json["looks"] = Json::array();
  if (schedule == nullptr) return;
  for (const controller::Switch& one : schedule->switches()) {
    Json at{{"time_s", to_seconds(one.time)}, {"cause", one.cause}, {"cue", nullptr}};
    if (one.cue) at["cue"] = *one.cue;
    json["switch_at"].push_back(std::move(at));
  }
  for (const Look& look : schedule->looks()) {
    json["looks"].push_back({{"colour", footlight::to_text(look.colour)},
                             {"effect", footlight::to_text(look.effect)},
                             {"brightness", look.brightness}});
  }
}

Json channels_json(const Node& node) {
  Json out = Json::array();
  for (const Channel& channel : node.channels) {
    switch (channel.kind) {
      case Channel::Kind::unused:
        out.push_back(nullptr);
        break;
      case Channel::Kind::cell:
        out.push_back(channel.cell.value());
        break;
      case Channel::Kind::wearable:
        out.push_back(-1 - static_cast<std::int64_t>(channel.performer.value()));
        break;
    }
  }
  return out;
}

/// @return how many lamps there are
std::size_t tell_rig(Json& json, const Rig* rig) {
  std::size_t lamps = 0;
  json["buses"] = Json::array();
  json["rig"] = Json::array();
  if (rig == nullptr) return lamps;
  for (const Bus& bus : rig->buses) {
    json["buses"].push_back({{"name", bus.name}, {"kind", footlight::to_text(bus.kind)}, {"url", bus.url}});
  }
  for (const Node& node : rig->nodes) {
    for (const Channel& channel : node.channels) lamps += channel.kind != Channel::Kind::unused ? 1 : 0;
    json["rig"].push_back(
        {{"name", node.name}, {"bus", node.bus.value()}, {"address", node.address}, {"channels", channels_json(node)}});
  }
  return lamps;
}

}  // namespace

std::string show_json(const ShownShow& shown) {
  Json json{{"epoch", shown.epoch},
            {"title", shown.show.title},
            {"version", shown.show.version},
            {"plan", shown.plan.show_hash},
            {"markers", 0},
            {"nodes", shown.rig == nullptr ? 0 : shown.rig->nodes.size()},
            {"switches", shown.schedule == nullptr ? 0 : shown.schedule->switches().size()}};
  json["stage"] = stage_json(shown.plan.stage);
  tell_people(json, shown.show);
  tell_sections(json, shown.show, shown.plan);
  tell_cues(json, shown);
  tell_tempo(json, shown.show.tempo);
  tell_schedule(json, shown.schedule);
  json["markers"] = tell_rig(json, shown.rig);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string plan_bytes(const Plan& plan, std::uint32_t epoch) {
  std::size_t marks = 0;
  for (const auto& track : plan.tracks) marks += track.size();
  std::string out;
  out.reserve(24 + plan.tracks.size() * 4 + marks * 8);
  out += "FLPM";
  put_count(out, 1);
  put(out, epoch);
  put_count(out, plan.tracks.size());
  put_count(out, marks);
  std::size_t first = 0;
  for (const auto& track : plan.tracks) {
    put_count(out, first);
    first += track.size();
  }
  put_count(out, first);
  for (const auto& track : plan.tracks) {
    for (const Mark& mark : track) put(out, static_cast<float>(to_seconds(mark.time)));
  }
  for (const auto& track : plan.tracks) {
    for (const Mark& mark : track) put_count(out, static_cast<std::size_t>(mark.cell.value()));
  }
  return out;
}

std::optional<std::string> looks_bytes(const controller::CueSchedule& schedule, std::size_t nodes, std::size_t k,
                                       std::uint32_t epoch) {
  if (!schedule.has(k)) return std::nullopt;
  std::string out;
  out.reserve(20 + nodes * kChannelsPerNode);
  out += "FLLK";
  put_count(out, 1);
  put(out, epoch);
  put_count(out, k);
  put_count(out, nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    for (const LookIndex look : schedule.looks_of(k, NodeIndex::of(n))) out += static_cast<char>(look);
  }
  return out;
}

}  // namespace footlight::app
