// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/rehearsal_entry.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 12> kKinds{"begun", "start",   "end",   "hold", "goes-on", "reset",
                                                  "order", "refused", "alarm", "note", "absent",  "ended"};

}  // namespace

std::string_view to_text(RehearsalEntry::Kind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }

std::string json_of(const RehearsalEntry& entry) {
  Json line{{"what", to_text(entry.kind)},
            {"since_1970_s", entry.since_1970_s},
            {"position_s", entry.position_s},
            {"count", entry.count},
            {"cue", entry.cue}};
  if (!entry.who.empty()) line["who"] = entry.who;
  if (entry.kind == RehearsalEntry::Kind::note) {
    line["about"] = to_text(entry.about);
    line["whom"] = entry.whom;
  }
  if (!entry.text.empty()) line["text"] = entry.text;
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);  // whatever somebody typed
}

std::optional<RehearsalEntry> entry_from(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  RehearsalEntry entry;
  const auto word = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto number = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
  };
  const auto kind = std::ranges::find(kKinds, word("what"));
  if (kind == kKinds.end()) return std::nullopt;
  entry.kind = static_cast<RehearsalEntry::Kind>(kind - kKinds.begin());
  entry.since_1970_s = number("since_1970_s");
  entry.position_s = number("position_s");
  entry.count = number("count");
  entry.cue = word("cue");
  entry.who = word("who");
  entry.text = word("text");
  entry.whom = word("whom");
  for (const auto about : {Remark::About::person, Remark::About::group, Remark::About::cell}) {
    if (word("about") == to_text(about)) entry.about = about;
  }
  return entry;
}

}  // namespace footlight::app
