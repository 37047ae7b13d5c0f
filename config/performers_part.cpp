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

/// Puts people into one group, and says who is in two or does not exist.
class Membership {
 public:
  Membership(ShowReading& show, MappingReader& group, GroupIndex index, const IdIndex& ids)
      : show_(show.show()), group_(group), index_(index), ids_(ids) {}

  void add(const Written& written) {
    if (const auto one = ids_.find(written.text); one != ids_.end()) {
      (void)join(written, one->second);
      return;
    }
    const auto span = parse_span(written.text);
    if (!span) {
      return group_.error(written, "no performer has the id " + in_quotes(written.text), ids_hint());
    }
    if (span->first > span->second) {
      return group_.error(written, in_quotes(written.text) + " runs backwards", "the smaller number stands first");
    }
    for (int id = span->first; id <= span->second; ++id) {
      const auto one = ids_.find(std::to_string(id));
      if (one == ids_.end()) {
        return group_.error(written, "no performer has the id " + in_quotes(std::to_string(id)), ids_hint());
      }
      if (!join(written, one->second)) return;
    }
  }

 private:
  bool join(const Written& written, PerformerIndex performer) {
    auto& group = show_.performers[performer.at()].group;
    if (group) {  // in this one, too: so nobody is looked at twice, however often she is named
      group_.error(written,
                   "performer " + show_.performers[performer.at()].id + " is already in the group " +
                       in_quotes(show_.groups[group->at()].name),
                   "everybody is in one group at most");
      return false;
    }
    group = index_;
    return true;
  }
  [[nodiscard]] std::string ids_hint() const {
    if (show_.performers.empty()) return {};
    return "ids run from " + show_.performers.front().id + " to " + show_.performers.back().id;
  }

  Show& show_;
  MappingReader& group_;
  GroupIndex index_;
  const IdIndex& ids_;
};

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
    show.show().groups.push_back({*name, colour.value_or(Colour{255, 255, 255})});
    kept.push_back(std::move(group));
  }
  return kept;
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
    Membership membership(show, groups[g], GroupIndex::of(g), ids);
    for (const Written& written : groups[g].list("members")) membership.add(written);
  }
  check_room(show, performers);
}

}  // namespace footlight::config
