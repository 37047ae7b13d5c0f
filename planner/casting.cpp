// SPDX-License-Identifier: Apache-2.0
#include "planner/casting.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "core/motion.hpp"
#include "core/parts.hpp"
#include "planner/formation/cell_distance.hpp"

namespace footlight::planner {
namespace {

/// What says whose a section's places are.
std::string source_text(const Section& section) {
  const auto* list = std::get_if<CellsSource>(&section.from);
  return list != nullptr ? "'" + list->path + "'" : "section '" + section.name + "'";
}

/// The binding of one station. Classes: performers by their number, then groups, then whoever is in none of these.
class StationBinding {
 public:
  StationBinding(const Show& show, const Station& station)
      : show_(show),
        section_(show.sections[station.section.at()]),
        station_(station),
        people_(static_cast<std::uint32_t>(show.performers.size())),
        others_(people_ + static_cast<std::uint32_t>(show.groups.size())) {}

  Result<Binding> run() {
    const bool groups = !station_.groups.empty();
    if ((station_.pinned || groups) && !section_.regions.empty()) {
      return input_error(message_at(show_, section_.regions.front().position,
                                    fmt::format("sections[{}].regions", station_.section.value()),
                                    source_text(section_) + " says who stands where already",
                                    "leave out the regions or its column of names or groups"));
    }
    if (!station_.pinned && !groups && section_.regions.empty() && station_.pins.empty()) return Binding();
    binding_.person.assign(people_, others_);
    binding_.place.assign(station_.cells.size(), others_);
    if (station_.pinned) {
      for (std::uint32_t p = 0; p < people_; ++p) binding_.person[p] = binding_.place[p] = p;
    } else if (groups) {
      // Whoever is in a group without places is as good as who is in none.
      std::vector<char> has_places(show_.groups.size(), 0);
      for (const auto& group : station_.groups) {
        if (group) has_places[group->at()] = 1;
      }
      bind_groups([&](GroupIndex group) { return has_places[group.at()] != 0; });
      for (std::size_t i = 0; i < station_.cells.size(); ++i) {
        if (station_.groups[i]) binding_.place[i] = class_of(*station_.groups[i]);
      }
    }
    if (auto error = pin_people()) return *error;
    if (!section_.regions.empty()) bind_regions();
    return std::move(binding_);
  }

 private:
  [[nodiscard]] std::uint32_t class_of(GroupIndex group) const { return people_ + group.value(); }

  template <class Wanted>
  void bind_groups(Wanted wanted) {
    for (std::uint32_t p = 0; p < people_; ++p) {
      const auto& group = show_.performers[p].group;
      if (group && wanted(*group)) binding_.person[p] = class_of(*group);
    }
  }

  std::optional<Error> pin_people() {
    for (const auto& [performer, cell] : station_.pins) {
      const auto at = std::find(station_.cells.begin(), station_.cells.end(), cell);
      FL_CHECK(at != station_.cells.end());
      std::uint32_t& place = binding_.place[static_cast<std::size_t>(at - station_.cells.begin())];
      std::uint32_t& person = binding_.person[performer.at()];
      if (place != person) return contradiction(performer, cell, place);
      place = person = performer.value();
    }
    return std::nullopt;
  }

  [[nodiscard]] Error contradiction(PerformerIndex performer, CellIndex cell, std::uint32_t place) const {
    std::string whose = "who is in no group";
    if (place < people_) whose = "performer " + show_.performers[place].id;
    if (place >= people_ && place < others_) whose = "the group '" + show_.groups[place - people_].name + "'";
    const Performer& one = show_.performers[performer.at()];
    const std::string group = one.group ? "in '" + show_.groups[one.group->at()].name + "'" : "in no group";
    const auto [position, key] = pin_position(performer);
    return input_error(
        message_at(show_, position, key,
                   fmt::format("{} gives {} to {}, and performer {} is {}", source_text(section_),
                               show_.stage.grid.name(cell), whose, one.id, place < people_ ? "not" : group),
                   "pin somebody whose place it is, or change the list"));
  }

  [[nodiscard]] std::pair<Position, std::string> pin_position(PerformerIndex performer) const {
    for (std::size_t n = 0; n < section_.overrides.size(); ++n) {
      for (const Override::Pin& pin : section_.overrides[n].pin) {
        if (pin.performer != performer) continue;
        return {pin.position, fmt::format("sections[{}].overrides[{}]", station_.section.value(), n)};
      }
    }
    return {section_.position, fmt::format("sections[{}].overrides", station_.section.value())};
  }

  void bind_regions() {
    const auto has_region = [&](GroupIndex group) {
      return std::any_of(section_.regions.begin(), section_.regions.end(),
                         [&](const footlight::Region& region) { return region.group == group; });
    };
    RegionTask task{&show_, &section_.regions, &station_.cells, {}, std::vector<int>(show_.groups.size() + 1, 0)};
    for (std::uint32_t p = 0; p < people_; ++p) {
      if (binding_.person[p] != others_) continue;  // pinned
      const auto& group = show_.performers[p].group;
      const bool bound = group && has_region(*group);
      if (bound) binding_.person[p] = class_of(*group);
      ++task.people[bound ? group->at() : show_.groups.size()];
    }
    for (const std::uint32_t place : binding_.place) task.taken.push_back(place != others_ ? 1 : 0);
    const std::vector<std::uint32_t> whose = divide_by_regions(task);
    for (std::size_t i = 0; i < whose.size(); ++i) {
      if (task.taken[i] != 0) continue;
      binding_.place[i] = whose[i] == kOpenPlace ? kOpenPlace : people_ + whose[i];
    }
  }

  const Show& show_;
  const Section& section_;
  const Station& station_;
  std::uint32_t people_;
  std::uint32_t others_;
  Binding binding_;
};

/// Hands out the places of one formation in tiers, each nearest first.
class RegionDivider {
 public:
  explicit RegionDivider(const RegionTask& task)
      : task_(task),
        grid_(task.show->stage.grid),
        others_(static_cast<std::uint32_t>(task.show->groups.size())),
        left_(task.people),
        region_of_(static_cast<std::size_t>(grid_.size()), kNoRegion),
        out_(task.cells->size(), kNobody) {
    for (const footlight::Region& region : *task.regions) {
      for (const CellIndex cell : region.cells) region_of_[cell.at()] = region.group.value();
      auto& cells = cells_[region.group.value()];
      cells.insert(cells.end(), region.cells.begin(), region.cells.end());
    }
    for (std::size_t i = 0; i < out_.size(); ++i) {
      const CellIndex cell = (*task.cells)[i];
      const auto& reserve = task.show->stage.reserve;
      if (task.taken[i] != 0 || std::binary_search(reserve.begin(), reserve.end(), cell)) out_[i] = kOpenPlace;
    }
  }

  std::vector<std::uint32_t> run() {
    std::vector<Choice> own;
    std::vector<Choice> beside;
    std::vector<Choice> anywhere;
    for (const auto& [group, cells] : cells_) {
      Point sum;
      for (const CellIndex cell : cells) sum = sum + grid_.centre(cell);
      const Point middle = (1.0 / static_cast<double>(cells.size())) * sum;
      CellDistance away(grid_);
      away.set_to(cells);
      for (std::uint32_t i = 0; i < out_.size(); ++i) {
        const CellIndex cell = (*task_.cells)[i];
        const std::uint32_t region = region_of_[cell.at()];
        if (out_[i] != kNobody) continue;
        if (region == group) own.push_back({distance(grid_.centre(cell), middle), i, group});
        if (region == kNoRegion) beside.push_back({away.of(cell), i, group});
        if (region != group && region != kNoRegion) anywhere.push_back({away.of(cell), i, group});
      }
    }
    hand_out(own);
    hand_out(beside);
    for (const bool in_region : {false, true}) give_others(in_region);
    hand_out(anywhere);
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t kNoRegion = kOpenPlace;
  static constexpr std::uint32_t kNobody = kOpenPlace - 1;
  struct Choice {
    double away_m = 0;
    std::uint32_t place = 0;
    std::uint32_t group = 0;
  };

  void hand_out(std::vector<Choice>& choices) {
    std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
      return std::tie(a.away_m, a.place, a.group) < std::tie(b.away_m, b.place, b.group);
    });
    for (const Choice& choice : choices) {
      if (out_[choice.place] != kNobody || left_[choice.group] == 0) continue;
      out_[choice.place] = choice.group;
      --left_[choice.group];
    }
  }

  void give_others(bool in_region) {
    for (std::uint32_t i = 0; i < out_.size() && left_[others_] > 0; ++i) {
      if (out_[i] != kNobody || (region_of_[(*task_.cells)[i].at()] != kNoRegion) != in_region) continue;
      out_[i] = others_;
      --left_[others_];
    }
  }

  const RegionTask& task_;
  const Grid& grid_;
  std::uint32_t others_;
  std::vector<int> left_;
  std::vector<std::uint32_t> region_of_;
  std::map<std::uint32_t, std::vector<CellIndex>> cells_;
  std::vector<std::uint32_t> out_;
};

}  // namespace

std::vector<std::uint32_t> divide_by_regions(const RegionTask& task) { return RegionDivider(task).run(); }

std::vector<char> bound_groups(const Show& show) {
  std::vector<char> bound;
  for (const Group& group : show.groups) bound.push_back(group.exchange ? 0 : 1);
  for (const Section& section : show.sections) {
    for (const footlight::Region& region : section.regions) bound[region.group.at()] = 1;
    const auto* list = std::get_if<CellsSource>(&section.from);
    if (list != nullptr && !list->groups.empty()) bound.assign(bound.size(), 1);
    const auto* parts = std::get_if<PartsSource>(&section.from);
    for (std::size_t k = 0; parts != nullptr && k < parts->parts->size(); ++k) {
      if (const auto& group = (*parts->parts)[k].group) bound[group->at()] = 1;
    }
    if (section.motion == nullptr) continue;
    for (const GroupPath& path : section.motion->paths) {
      if (path.group) bound[path.group->at()] = 1;
    }
  }
  return bound;
}

void keep_apart_by_radius(const Show& show, Casting& casting) {
  double widest_m = 0;
  for (const Performer& performer : show.performers) widest_m = std::max(widest_m, performer.radius_m);
  Refinement kinds;
  std::map<double, std::uint32_t> of_radius{{0.0, 0}};
  casting.kind.resize(show.performers.size(), 0);
  for (std::size_t p = 0; p < casting.kind.size(); ++p) {
    const double radius_m = show.performers[p].radius_m;
    const bool wide = radius_m + widest_m > show.stage.clearance_m;
    casting.radius_m.push_back(wide ? radius_m : 0);
    const auto number = static_cast<std::uint32_t>(of_radius.size());
    const std::uint32_t radius = of_radius.try_emplace(casting.radius_m.back(), number).first->second;
    casting.kind[p] = kinds.of(casting.kind[p], radius);
  }
}

Result<Casting> casting_of(const Show& show, const std::vector<Station>& stations) {
  Casting casting;
  if (std::any_of(show.groups.begin(), show.groups.end(), [](const Group& group) { return !group.exchange; })) {
    for (const Performer& performer : show.performers) {
      const bool alone = performer.group && !show.groups[performer.group->at()].exchange;
      casting.kind.push_back(alone ? performer.group->value() + 1 : 0);
    }
  }
  bool bound = false;
  std::vector<Binding> bindings;
  for (const Station& station : stations) {
    auto binding = StationBinding(show, station).run();
    if (!binding) return binding.error();
    bound = bound || binding->binds();
    bindings.push_back(std::move(*binding));
  }
  if (bound) casting.bindings = std::move(bindings);
  return casting;
}

}  // namespace footlight::planner
