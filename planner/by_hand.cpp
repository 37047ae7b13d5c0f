// SPDX-License-Identifier: Apache-2.0
#include "planner/by_hand.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace footlight::planner {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFU;
/// Counts that are nearer are one.
constexpr double kSameCount = 1e-6;

std::string count_text(double count) { return fmt::format("{:g}", std::round(count * 100) / 100); }

/// One override on one formation.
class Hand {
 public:
  Hand(const Show& show, SectionIndex section, std::size_t number, const Ways& ways, Station& station)
      : show_(show),
        override_(show.sections[section.at()].overrides[number]),
        key_(fmt::format("sections[{}].overrides[{}]", section.value(), number)),
        ways_(ways),
        station_(station),
        who_(static_cast<std::size_t>(show.stage.grid.size()), kNobody) {
    for (std::uint32_t i = 0; i < station.cells.size(); ++i) who_[station.cells[i].at()] = i;
  }

  std::optional<Error> run() {
    const int before = on_floor();
    leave();
    take();
    if (!error_) pin();
    if (error_) return error_;
    station_.in_picture += on_floor() - before;
    station_.moved += static_cast<int>(override_.move.size() + std::max(override_.add.size(), override_.remove.size()));
    station_.key = true;
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::string name(CellIndex cell) const { return show_.stage.grid.name(cell); }
  [[nodiscard]] std::string when() const { return "at count " + count_text(station_.count); }
  [[nodiscard]] bool reserve(CellIndex cell) const {
    return std::binary_search(show_.stage.reserve.begin(), show_.stage.reserve.end(), cell);
  }
  [[nodiscard]] int on_floor() const {
    return static_cast<int>(
        std::count_if(station_.cells.begin(), station_.cells.end(), [&](CellIndex cell) { return !reserve(cell); }));
  }
  /// The first thing wrong is kept.
  void fail(const Position& position, std::string text, std::string hint) {
    if (!error_) error_ = input_error(message_at(show_, position, key_, std::move(text), std::move(hint)));
  }

  /// Takes who stands on a cell off it.
  std::uint32_t lift(CellIndex cell, const Position& position) {
    const std::uint32_t who = who_[cell.at()];
    if (who == kNobody) {
      fail(position, fmt::format("nobody stands on {} {}", name(cell), when()),
           station_.exact ? "footlight export --csv lists who stands where"
                          : "the formation as drawn is meant; who is late stands elsewhere in the plan");
    }
    who_[cell.at()] = kNobody;
    return who;
  }
  void put(std::uint32_t who, CellIndex cell, const Position& position) {
    if (error_) return;
    if (!ways_.can_stand(cell)) {
      return fail(position, fmt::format("nobody can stand on {}", name(cell)), "it is too near to a blocked cell");
    }
    if (who_[cell.at()] != kNobody) {
      return fail(position, fmt::format("the cell {} is taken {}", name(cell), when()), "move or remove who is there");
    }
    who_[cell.at()] = who;
    station_.cells[who] = cell;
  }

  void leave() {
    for (const Override::Move& move : override_.move) moved_.push_back(lift(move.from, move.position));
    for (const Override::Place& place : override_.remove) {
      if (reserve(place.cell)) {
        fail(place.position, fmt::format("{} is in the reserve", name(place.cell)), "who is removed goes there");
      }
      freed_.push_back(lift(place.cell, place.position));
    }
  }

  void take() {
    for (std::size_t n = 0; n < moved_.size(); ++n) put(moved_[n], override_.move[n].to, override_.move[n].position);
    for (const Override::Place& place : override_.add) {
      if (error_) return;
      if (reserve(place.cell)) {
        return fail(place.position, fmt::format("{} is in the reserve", name(place.cell)), "add cells of the picture");
      }
      const std::uint32_t who = nearest_free(place.cell);
      if (who == kNobody) {
        return fail(place.position, fmt::format("nobody waits in the reserve {} to take {}", when(), name(place.cell)),
                    "remove somebody in the same override");
      }
      put(who, place.cell, place.position);
    }
    for (std::size_t n = 0; n < freed_.size() && !error_; ++n) {
      const Position& position = override_.remove.front().position;
      const CellIndex from = station_.cells[freed_[n]];
      const auto to = nearest_reserve(from);
      if (!to) {
        return fail(position, fmt::format("the reserve has no cell left for who leaves {} {}", name(from), when()),
                    "add as many cells as are removed, or make the reserve larger");
      }
      put(freed_[n], *to, position);
    }
  }

  /// Who comes to a cell: of those who were removed, else of those who wait, the nearest.
  std::uint32_t nearest_free(CellIndex cell) {
    const Grid& grid = show_.stage.grid;
    const auto away = [&](std::uint32_t i) { return distance(grid.centre(station_.cells[i]), grid.centre(cell)); };
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) { return away(a) < away(b); };
    if (!freed_.empty()) {
      const auto best = std::min_element(freed_.begin(), freed_.end(), nearer);
      const std::uint32_t who = *best;
      freed_.erase(best);
      return who;
    }
    std::uint32_t who = kNobody;
    for (std::uint32_t i = 0; i < station_.cells.size(); ++i) {
      const bool waits = reserve(station_.cells[i]) && who_[station_.cells[i].at()] == i;
      if (waits && (who == kNobody || nearer(i, who))) who = i;
    }
    if (who != kNobody) who_[station_.cells[who].at()] = kNobody;
    return who;
  }

  [[nodiscard]] std::optional<CellIndex> nearest_reserve(CellIndex from) const {
    const Grid& grid = show_.stage.grid;
    std::optional<CellIndex> best;
    double best_m = std::numeric_limits<double>::infinity();
    for (const CellIndex cell : show_.stage.reserve) {
      if (who_[cell.at()] != kNobody || !ways_.can_stand(cell)) continue;
      const double away_m = distance(grid.centre(cell), grid.centre(from));
      if (away_m < best_m) {
        best = cell;
        best_m = away_m;
      }
    }
    return best;
  }

  void pin() {
    for (const Override::Pin& pin : override_.pin) {
      const std::string& id = show_.performers[pin.performer.at()].id;
      if (who_[pin.cell.at()] == kNobody) {
        return fail(pin.position, fmt::format("nobody stands on {} {}, so that {} cannot", name(pin.cell), when(), id),
                    "move somebody there in the same override");
      }
      for (const auto& [performer, cell] : station_.pins) {
        if (performer == pin.performer) {
          return fail(pin.position, fmt::format("performer {} is pinned to {} {} already", id, name(cell), when()),
                      "once will do");
        }
        if (cell == pin.cell) {
          return fail(pin.position,
                      fmt::format("performer {} is pinned to {} {} already", show_.performers[performer.at()].id,
                                  name(cell), when()),
                      "a cell holds one person");
        }
      }
      station_.pins.emplace_back(pin.performer, pin.cell);
    }
  }

  const Show& show_;
  const Override& override_;
  std::string key_;
  const Ways& ways_;
  Station& station_;
  std::vector<std::uint32_t> who_;    // index in the station's cells of who is on each cell
  std::vector<std::uint32_t> moved_;  // who moves, in the order written
  std::vector<std::uint32_t> freed_;  // who is removed and has no cell yet
  std::optional<Error> error_;
};

/// The formation that an override means.
Station* find_station(const Override& asked, SectionPlan& plan) {
  if (!asked.count) {
    const auto n = static_cast<std::size_t>(asked.number);
    return n <= plan.stations.size() ? &plan.stations[n - 1] : nullptr;
  }
  for (Station& station : plan.stations) {
    if (std::abs(station.count - *asked.count) < kSameCount) return &station;
  }
  return nullptr;
}

Error no_formation(const Show& show, SectionIndex section, std::size_t number, const SectionPlan& plan) {
  const Override& asked = show.sections[section.at()].overrides[number];
  std::string text = fmt::format("the section has {} formations", plan.stations.size());
  std::string hint = fmt::format("1 to {}", plan.stations.size());
  if (asked.count) {
    text = fmt::format("the section has no formation at count {}", count_text(*asked.count));
    std::vector<double> counts;
    for (const Station& station : plan.stations) counts.push_back(station.count);
    std::stable_sort(counts.begin(), counts.end(),
                     [&](double a, double b) { return std::abs(a - *asked.count) < std::abs(b - *asked.count); });
    hint = "the nearest is at count " + count_text(counts.front());
    if (counts.size() > 1) hint += ", then count " + count_text(counts[1]);
    if (std::holds_alternative<VideoSource>(show.sections[section.at()].from)) {
      hint += fmt::format("; keys: [count {}] makes one", count_text(*asked.count));
    }
  }
  return input_error(message_at(show, asked.position,
                                fmt::format("sections[{}].overrides[{}]", section.value(), number), std::move(text),
                                std::move(hint)));
}

}  // namespace

std::optional<Error> apply_overrides(const Show& show, SectionIndex section, const Ways& ways, SectionPlan& plan) {
  const std::vector<Override>& overrides = show.sections[section.at()].overrides;
  for (std::size_t n = 0; n < overrides.size(); ++n) {
    Station* station = find_station(overrides[n], plan);
    if (station == nullptr) return no_formation(show, section, n, plan);
    if (auto error = Hand(show, section, n, ways, *station).run()) return error;
  }
  return std::nullopt;
}

}  // namespace footlight::planner
