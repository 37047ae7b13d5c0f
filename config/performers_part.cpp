// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <unordered_map>

#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

using IdIndex = std::unordered_map<std::string, PerformerIndex>;

IdIndex index_ids(const std::vector<Performer>& performers) {
  IdIndex out;
  for (std::size_t i = 0; i < performers.size(); ++i) out.emplace(performers[i].id, PerformerIndex::of(i));
  return out;
}

std::optional<Colour> read_colour(MappingReader& mapping) {
  const auto written = mapping.written("colour");
  if (!written) return std::nullopt;
  const auto colour = parse_colour(written->text);
  if (!colour) mapping.error(*written, in_quotes(written->text) + " is not a colour", "write \"#RRGGBB\", in quotes");
  return colour;
}

/// "1-300": both ends included.
std::optional<std::pair<int, int>> parse_span(const std::string& text) {
  const std::size_t dash = text.find('-', 1);
  if (dash == std::string::npos) return std::nullopt;
  const auto first = parse_integer(text.substr(0, dash));
  const auto last = parse_integer(text.substr(dash + 1));
  if (!first || !last) return std::nullopt;
  return std::pair{*first, *last};
}

/// The people whom a list names by ids and ranges of numbers; `take` says whether to go on with a range.
template <class Take>
void each_person(const Show& show, const IdIndex& ids, MappingReader& mapping, const Written& written, Take take) {
  const auto unknown = [&](const std::string& id) {
    mapping.error(written, "no performer has the id " + in_quotes(id),
                  show.performers.empty()
                      ? std::string()
                      : "ids run from " + show.performers.front().id + " to " + show.performers.back().id);
  };
  if (const auto one = ids.find(written.text); one != ids.end()) {
    (void)take(one->second);
    return;
  }
  const auto span = parse_span(written.text);
  if (!span) return unknown(written.text);
  if (span->first > span->second) {
    return mapping.error(written, in_quotes(written.text) + " runs backwards", "the smaller number stands first");
  }
  for (int id = span->first; id <= span->second; ++id) {
    const auto one = ids.find(std::to_string(id));
    if (one == ids.end()) return unknown(std::to_string(id));
    if (!take(one->second)) return;
  }
}

/// Puts somebody into a group, and says when she is in two.
bool join(Show& show, MappingReader& reader, const Written& written, GroupIndex index, PerformerIndex performer) {
  auto& group = show.performers[performer.at()].group;
  if (group) {  // in this one, too: so nobody is looked at twice, however often she is named
    reader.error(written,
                 "performer " + show.performers[performer.at()].id + " is already in the group " +
                     in_quotes(show.groups[group->at()].name),
                 "everybody is in one group at most");
    return false;
  }
  group = index;
  return true;
}

/// Names and colours; members later, as a roster's rows name groups and members name rows.
std::vector<MappingReader> read_groups(ShowReading& show, MappingReader& performers) {
  std::vector<MappingReader> kept;
  std::set<std::string> names;
  for (MappingReader& group : performers.mappings("groups")) {
    const auto name = group.text("name");
    const auto colour = read_colour(group);
    if (!name) continue;
    if (!names.insert(*name).second) {
      group.error("name", "a second group has the name " + in_quotes(*name), "names of groups are unique");
      continue;
    }
    show.show().groups.push_back(
        {*name, colour.value_or(Colour{255, 255, 255}), group.boolean("exchange").value_or(true)});
    kept.push_back(std::move(group));
  }
  return kept;
}

/// What a group says of its people, to those who have nothing of their own in the roster.
void give_limits(Show& show, MappingReader& group, GroupIndex index) {
  const auto speed_mps = group.quantity("max_speed");
  const auto agility = group.number("agility");
  const auto reaction_s = group.quantity("reaction");
  for (Performer& performer : show.performers) {
    if (performer.group != index) continue;
    if (performer.max_speed_mps == 0) performer.max_speed_mps = speed_mps.value_or(0);
    if (!performer.agility) performer.agility = agility;
    if (!performer.reaction_s) performer.reaction_s = reaction_s;
  }
}

void read_understudies(ShowReading& show, MappingReader& performers, const IdIndex& ids) {
  std::set<std::string> known;
  for (MappingReader& one : performers.mappings("understudies")) {
    const auto id = one.text("id");
    Understudy out;
    out.radius_m = one.quantity("radius").value_or(0);
    out.max_speed_mps = one.quantity("max_speed").value_or(0);
    for (const Written& written : one.list("covers")) {
      each_person(show.show(), ids, one, written, [&](PerformerIndex performer) {
        out.covers.push_back(performer);
        return true;
      });
    }
    if (!id) continue;
    if (ids.contains(*id) || !known.insert(*id).second) {
      one.error("id", "somebody else has the id " + in_quotes(*id), "ids of performers and understudies are unique");
      continue;
    }
    out.id = *id;
    out.name = one.text("name").value_or(*id);
    show.show().understudies.push_back(std::move(out));
  }
}

void count_performers(ShowReading& show, int count) {
  for (int i = 1; i <= count; ++i) {
    Performer performer;
    performer.id = std::to_string(i);
    performer.name = performer.id;
    show.show().performers.push_back(std::move(performer));
  }
}

/// Everybody needs a cell of her own from the first instant on.
void check_room(ShowReading& show, MappingReader& performers) {
  const Show& read = show.show();
  const auto free = static_cast<std::size_t>(read.stage.grid.size()) - read.stage.blocked.size();
  if (!show.has_stage || read.performers.size() <= free) return;
  performers.error(performers.has("from") ? "from" : "count",
                   std::to_string(read.performers.size()) + " performers and only " + std::to_string(free) +
                       " cells that are not blocked",
                   "a larger grid, or fewer people");
}

}  // namespace

void read_absent(ShowReading& show, MappingReader& root) {
  Show& read = show.show();
  if (!show.has_performers || !root.has("absent")) return;
  const IdIndex ids = index_ids(read.performers);
  std::size_t absent = 0;
  for (const Written& written : root.list("absent")) {
    each_person(read, ids, root, written, [&](PerformerIndex performer) {
      bool& away = read.performers[performer.at()].absent;
      if (away) {
        root.error(written, "performer " + read.performers[performer.at()].id + " is absent already", "once will do");
        return false;
      }
      ++absent;
      return away = true;
    });
  }
  if (absent == read.performers.size()) root.error("absent", "nobody is left", "somebody has to come");
}

void read_performers(ShowReading& show, MappingReader performers) {
  if (const auto colour = read_colour(performers)) show.show().default_colour = *colour;
  auto groups = read_groups(show, performers);
  if (performers.has("from")) {
    const std::string file = existing_file(performers, "from", show.folder, show.loaded.files);
    if (!file.empty()) read_roster_csv(show, file);
  } else if (const auto count = performers.integer("count")) {
    count_performers(show, *count);
  }
  show.has_performers = !show.show().performers.empty();
  if (!show.has_performers) return;
  const IdIndex ids = index_ids(show.show().performers);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const Written& written : groups[g].list("members")) {
      each_person(show.show(), ids, groups[g], written, [&](PerformerIndex performer) {
        return join(show.show(), groups[g], written, GroupIndex::of(g), performer);
      });
    }
    give_limits(show.show(), groups[g], GroupIndex::of(g));
  }
  read_understudies(show, performers, ids);
  check_room(show, performers);
}

}  // namespace footlight::config
