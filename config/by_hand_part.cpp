// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>

#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

constexpr std::string_view kArrow = "->";

std::string trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return std::string(text);
}

/// "A -> B" in its two halves; nothing after an error.
std::optional<std::pair<Written, Written>> read_arrow(MappingReader& from, const Written& written,
                                                      const std::string& hint) {
  const std::size_t at = written.text.rfind(kArrow);
  if (at == std::string::npos) {
    from.error(written, in_quotes(written.text) + " has no arrow", hint);
    return std::nullopt;
  }
  std::pair<Written, Written> both{written, written};
  both.first.text = trimmed(std::string_view(written.text).substr(0, at));
  both.second.text = trimmed(std::string_view(written.text).substr(at + kArrow.size()));
  return both;
}

/// What overrides and regions need to know of the show that is being read.
class HandReader {
 public:
  explicit HandReader(ShowReading& show) : reading_(show), show_(show.show()) {}

  std::optional<Override> override_of(MappingReader& reader) const {
    Override out;
    out.position = reader.position();
    const auto at = reader.quantity("at");
    const auto number = reader.integer("formation");
    if (!reading_.has_stage) return std::nullopt;
    for (const Written& written : reader.list("move")) {
      const auto both = read_arrow(reader, written, "write for example B4 -> C4");
      if (!both) continue;
      const auto from = cell_of(reader, both->first);
      const auto to = cell_of(reader, both->second);
      if (from && to) out.move.push_back({*from, *to, written.position});
    }
    out.add = places(reader, "add");
    out.remove = places(reader, "remove");
    for (const Written& written : reader.list("pin")) {
      if (auto pin = pin_of(reader, written)) out.pin.push_back(std::move(*pin));
    }
    if (!at && !number) return std::nullopt;
    out.count = at;
    out.number = number.value_or(0);
    return out;
  }

  std::optional<Region> region_of(MappingReader& reader) const {
    Region out;
    out.position = reader.position();
    const auto name = reader.written("group");
    if (!name || !reading_.has_stage || !reading_.has_performers) return std::nullopt;
    out.cells = read_cells(reader, "cells", show_.stage.grid);
    const auto group = find_group(reading_, reader, *name);
    if (!group) return std::nullopt;
    out.group = *group;
    return out;
  }

 private:
  [[nodiscard]] std::optional<CellIndex> cell_of(MappingReader& reader, const Written& written) const {
    const auto cell = parse_cell(written.text);
    const Grid& grid = show_.stage.grid;
    if (!cell) {
      reader.error(written, in_quotes(written.text) + " is not a cell", "write for example A1");
      return std::nullopt;
    }
    if (!grid.contains(*cell)) {
      reader.error(written, "the cell " + cell_name(*cell) + " is off the grid",
                   "A1 to " + cell_name({grid.columns() - 1, grid.rows() - 1}));
      return std::nullopt;
    }
    const CellIndex index = grid.index(*cell);
    if (std::binary_search(show_.stage.blocked.begin(), show_.stage.blocked.end(), index)) {
      reader.error(written, "the cell " + cell_name(*cell) + " is blocked", "nobody can stand on a blocked cell");
      return std::nullopt;
    }
    return index;
  }

  std::vector<Override::Place> places(MappingReader& reader, std::string_view key) const {
    std::vector<Override::Place> out;
    for (const Written& written : reader.list(key)) {
      if (const auto cell = cell_of(reader, written)) out.push_back({*cell, written.position});
    }
    return out;
  }

  [[nodiscard]] std::optional<Override::Pin> pin_of(MappingReader& reader, const Written& written) const {
    const auto both = read_arrow(reader, written, "write for example 17 -> C4: performer 17 stands on C4");
    if (!both) return std::nullopt;
    const auto cell = cell_of(reader, both->second);
    if (!reading_.has_performers) return std::nullopt;
    const auto who = std::find_if(show_.performers.begin(), show_.performers.end(),
                                  [&](const Performer& performer) { return performer.id == both->first.text; });
    if (who == show_.performers.end()) {
      reader.error(written, "no performer has the id " + in_quotes(both->first.text),
                   "ids run from " + show_.performers.front().id + " to " + show_.performers.back().id);
      return std::nullopt;
    }
    if (!cell) return std::nullopt;
    return Override::Pin{PerformerIndex::of(who - show_.performers.begin()), *cell, written.position};
  }

  ShowReading& reading_;
  const Show& show_;
};

void read_one_key(MappingReader& reader, const Written& written, Section& out) {
  SectionKey key;
  key.position = written.position;
  if (written.text.starts_with("count")) {
    const ParsedQuantity count = parse_at_count(written.text);
    if (!count.value) return reader.error(written, count.text, count.hint);
    key.count = count.value;
  } else {
    const ParsedQuantity film = parse_quantity(written.text, Dimension::time);
    if (!film.value) {
      return reader.error(written, in_quotes(written.text) + " is neither a count nor a time of the video",
                          "write for example count 17, or 2.4 s: seconds of the video's file");
    }
    if (*film.value < 0) {
      return reader.error(written, in_quotes(written.text) + " is before the video begins", "0 s is its first frame");
    }
    key.film_s = *film.value;
  }
  const bool twice = std::any_of(out.keys.begin(), out.keys.end(), [&](const SectionKey& other) {
    return other.count == key.count && other.film_s == key.film_s;
  });
  if (twice) return reader.error(written, in_quotes(written.text) + " stands here for the second time", "once will do");
  const double end = out.start_count + out.duration_counts;
  if (key.count && (*key.count < out.start_count || (out.duration_counts > 0 && *key.count > end))) {
    return reader.error(written, in_quotes(written.text) + " is outside of the section",
                        out.duration_counts > 0
                            ? "its video runs from count " + plain(out.start_count) + " to count " + plain(end)
                            : "it starts at count " + plain(out.start_count));
  }
  out.keys.push_back(std::move(key));
}

/// A cell has one group at most.
void read_regions(const HandReader& hand, MappingReader& section, Section& out) {
  std::map<CellIndex, GroupIndex> taken;
  for (MappingReader& reader : section.mappings("regions")) {
    auto region = hand.region_of(reader);
    if (!region) continue;
    const auto other =
        std::find_if(region->cells.begin(), region->cells.end(), [&](CellIndex cell) { return taken.contains(cell); });
    if (other != region->cells.end() && taken.at(*other) != region->group) {
      reader.error("cells", "a cell stands in the regions of two groups", "a cell belongs to one group at most");
      continue;
    }
    for (const CellIndex cell : region->cells) taken.emplace(cell, region->group);
    out.regions.push_back(std::move(*region));
  }
}

}  // namespace

std::optional<GroupIndex> find_group(ShowReading& show, MappingReader& mapping, const Written& name) {
  const std::vector<Group>& groups = show.show().groups;
  const auto found =
      std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.name == name.text; });
  if (found != groups.end()) return GroupIndex::of(found - groups.begin());
  std::vector<std::string> names;
  for (const Group& group : groups) names.push_back(group.name);
  mapping.error(name, "no group has the name " + in_quotes(name.text),
                names.empty() ? "the show has no groups" : suggestion(name.text, names, "groups"));
  return std::nullopt;
}

void read_by_hand(ShowReading& show, MappingReader& section, Section& out) {
  const HandReader hand(show);
  for (const Written& written : section.list("keys")) read_one_key(section, written, out);
  for (MappingReader& reader : section.mappings("overrides")) {
    if (auto made = hand.override_of(reader)) out.overrides.push_back(std::move(*made));
  }
  read_regions(hand, section, out);
}

}  // namespace footlight::config
