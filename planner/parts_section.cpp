// SPDX-License-Identifier: Apache-2.0
#include "planner/parts_section.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/check.hpp"
#include "core/motion.hpp"
#include "core/parts.hpp"
#include "planner/formation/part_points.hpp"
#include "planner/formation/seats.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding = 1e-6;

/// Who takes the places of parts without a group: whoever is in no group that a part names.
using Pool = std::optional<GroupIndex>;

class PartsSection {
 public:
  PartsSection(const Show& show, SectionIndex index, const std::optional<Film>& film, const Ways& ways)
      : show_(show),
        section_(show.sections[index.at()]),
        index_(index),
        film_(film),
        parts_(*std::get<PartsSource>(section_.from).parts),
        grid_(show.stage.grid),
        usable_(ways.standable()),
        seats_(grid_, usable_, show.performers.size()),
        // Cells are a pitch apart, whatever else is asked for.
        apart_m_(std::max(grid_.pitch_m(), show.stage.clearance_m)) {
    for (const CellIndex cell : show.stage.reserve) {
      usable_[cell.at()] = 0;
      if (ways.can_stand(cell)) reserve_.push_back(cell);
    }
  }

  Result<SectionPlan> run() {
    fill_pools();
    if (auto error = count_people()) return *error;
    int frame = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Mask* picture = nullptr;
      if (parts_[k].needs_picture()) {
        FL_CHECK(film_ && static_cast<std::size_t>(frame) < film_->frames.size());
        picture = &film_->frames[static_cast<std::size_t>(frame++)];
      }
      if (auto error = add(k, picture)) return *error;
    }
    Station station = placed();
    if (auto error = let_others_wait(station)) return *error;
    if (auto error = too_near(station)) return *error;
    SectionPlan plan;
    plan.section.reserve = show_.stage.reserve;
    plan.stations.push_back(std::move(station));
    return plan;
  }

 private:
  [[nodiscard]] Error error_at(std::size_t k, std::string text, std::string hint) const {
    std::string key = fmt::format("sections[{}].from", index_.value());
    if (parts_.size() > 1) key += fmt::format(".parts[{}]", k);
    return input_error(message_at(show_, parts_[k].position, std::move(key), std::move(text), std::move(hint)));
  }
  [[nodiscard]] std::string whose(const Pool& pool) const {
    if (pool) return "the group '" + show_.groups[pool->at()].name + "'";
    return pools_.size() > 1 ? "who is in no other part's group" : "the show";
  }

  void fill_pools() {
    for (const Part& part : parts_) pools_[part.group] = 0;
    for (const Performer& performer : show_.performers) {
      const auto named = performer.group ? pools_.find(performer.group) : pools_.end();
      const auto pool = named != pools_.end() ? named : pools_.find(std::nullopt);
      ++(pool != pools_.end() ? pool->second : left_out_);
    }
  }

  /// How many people each part has: the numbers that are written, then an even share of who is left.
  std::optional<Error> count_people() {
    std::map<Pool, int> open;  // parts that share what is left
    people_.resize(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Part& part = parts_[k];
      if (!part.people) {
        ++open[part.group];
        continue;
      }
      people_[k] = *part.people;
      int& left = pools_[part.group];
      if (people_[k] > left) {
        return error_at(
            k, fmt::format("{} people, but {} has {}", people_[k], whose(part.group), whole_of(part.group)),
            left > 0 ? fmt::format("at most {} are left for this part", left) : "other parts have them all already");
      }
      left -= people_[k];
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const Part& part = parts_[k];
      if (part.people) continue;
      int& left = pools_[part.group];
      people_[k] = (left + open[part.group] - 1) / open[part.group];
      if (people_[k] == 0) {
        return error_at(k,
                        fmt::format("nobody is left for it: {} has {} people", whose(part.group), whole_of(part.group)),
                        "fewer people in other parts, or one part less");
      }
      left -= people_[k];
      --open[part.group];
    }
    return std::nullopt;
  }
  [[nodiscard]] int whole_of(const Pool& pool) const {
    return static_cast<int>(
        std::count_if(show_.performers.begin(), show_.performers.end(), [&](const Performer& performer) {
          const bool named = performer.group && pools_.contains(performer.group);
          return pool ? performer.group == pool : !named;
        }));
  }

  std::optional<Error> add(std::size_t k, const Mask* picture) {
    const PartTask task{&show_.stage, &parts_[k], picture, &usable_, people_[k], apart_m_, seed() + k};
    const auto made = part_points(task);
    const std::string name = part_name(parts_[k]);
    if (!made) return error_at(k, made.error().message, made.error().hint);
    if (made->apart_m < apart_m_ * (1 - kRounding)) {
      return error_at(k,
                      fmt::format("{} is too small for its {} people: they would stand {:.2g} m apart", name,
                                  people_[k], made->apart_m),
                      fmt::format("{:.3g} m are needed: {:.2g} times as large, or fewer people", apart_m_,
                                  apart_m_ / made->apart_m));
    }
    if (auto error = off_stage(k, made->points)) return error;
    if (!seats_.add(made->points, made->only)) {
      return error_at(k, fmt::format("not all of the {} people of {} find a cell of their own", people_[k], name),
                      "blocked cells, the reserve or parts before it are in the way");
    }
    points_.insert(points_.end(), made->points.begin(), made->points.end());
    return std::nullopt;
  }
  [[nodiscard]] std::uint64_t seed() const { return section_.motion ? section_.motion->seed : 1; }

  [[nodiscard]] std::optional<Error> off_stage(std::size_t k, const std::vector<Point>& points) const {
    const Box floor = whole_floor(grid_);
    int off = 0;
    double farthest_m = 0;
    for (const Point p : points) {
      const double out_m = std::max({floor.x0 - p.x, p.x - floor.x1, floor.y0 - p.y, p.y - floor.y1});
      off += out_m > kRounding ? 1 : 0;
      farthest_m = std::max(farthest_m, out_m);
    }
    if (off == 0) return std::nullopt;
    return error_at(k,
                    fmt::format("{} of the {} people of {} would stand off the stage, up to {:.2g} m", off, people_[k],
                                part_name(parts_[k]), farthest_m),
                    fmt::format("the floor is {:.4g} m to {:.4g} m from side to side and {:.4g} m to {:.4g} m deep",
                                rounded(floor.x0), rounded(floor.x1), rounded(floor.y0), rounded(floor.y1)));
  }
  /// To the millimetre; an edge at 0 is not at -1e-16.
  static double rounded(double metres) { return std::round(metres * 1000) / 1000 + 0.0; }

  [[nodiscard]] Station placed() const {
    Station station;
    station.section = index_;
    station.count = section_.start_count;
    station.arrive = show_.tempo.at(section_.start_count);
    station.depart = show_.tempo.at(section_.end_count());
    station.cells = seats_.cells();
    station.in_picture = static_cast<int>(station.cells.size());
    station.exact = true;
    if (pools_.size() == 1 && pools_.contains(std::nullopt)) return station;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      station.groups.insert(station.groups.end(), static_cast<std::size_t>(people_[k]), parts_[k].group);
    }
    return station;
  }

  /// Who is in no part waits in the reserve, near the parts of her group.
  std::optional<Error> let_others_wait(Station& station) const {
    std::map<Pool, int> waiting = pools_;  // what is left of each
    waiting[std::nullopt] += left_out_;
    int all = 0;
    for (const auto& [pool, people] : waiting) all += people;
    if (all > static_cast<int>(reserve_.size())) {
      return error_at(
          0, fmt::format("{} performers are in no part, and the reserve has room for {}", all, reserve_.size()),
          "more people in parts, or more reserve cells");
    }
    std::vector<CellIndex> free = reserve_;
    for (const auto& [pool, people] : waiting) {
      const Point middle = middle_of(pool);
      std::stable_sort(free.begin(), free.end(), [&](CellIndex a, CellIndex b) {
        return distance(grid_.centre(a), middle) < distance(grid_.centre(b), middle);
      });
      station.cells.insert(station.cells.end(), free.begin(), free.begin() + people);
      if (!station.groups.empty()) station.groups.insert(station.groups.end(), static_cast<std::size_t>(people), pool);
      free.erase(free.begin(), free.begin() + people);
    }
    return std::nullopt;
  }
  [[nodiscard]] Point middle_of(const Pool& pool) const {
    Point sum;
    int people = 0;
    std::size_t first = 0;
    for (std::size_t k = 0; k < parts_.size(); first += static_cast<std::size_t>(people_[k++])) {
      if (parts_[k].group != pool) continue;
      for (std::size_t i = 0; i < static_cast<std::size_t>(people_[k]); ++i) sum = sum + points_[first + i];
      people += people_[k];
    }
    return people > 0 ? (1.0 / people) * sum : sum;
  }

  /// Cells nearer than the clearance: where it is more than a pitch, drawings are moved onto cells that may be too
  /// near.
  [[nodiscard]] std::optional<Error> too_near(const Station& station) const {
    if (show_.stage.clearance_m <= grid_.pitch_m() * (1 + kRounding)) return std::nullopt;
    std::vector<char> taken(static_cast<std::size_t>(grid_.size()), 0);
    for (const CellIndex cell : station.cells) taken[cell.at()] = 1;
    for (const CellIndex cell : station.cells) {
      for (const CellIndex near : grid_.within(grid_.centre(cell), show_.stage.clearance_m * (1 - kRounding))) {
        if (near == cell || taken[near.at()] == 0) continue;
        return error_at(0,
                        fmt::format("the nearest cells for it bring two people to {} and {}, nearer than the clearance",
                                    grid_.name(cell), grid_.name(near)),
                        fmt::format("a pitch of {:.3g} m or more, or parts of more than {:.3g} m from person to person",
                                    show_.stage.clearance_m, show_.stage.clearance_m + grid_.pitch_m()));
      }
    }
    return std::nullopt;
  }

  const Show& show_;
  const Section& section_;
  SectionIndex index_;
  const std::optional<Film>& film_;
  const std::vector<Part>& parts_;
  const Grid& grid_;
  CellFlags usable_;
  std::vector<CellIndex> reserve_;
  Seats seats_;
  double apart_m_;
  std::map<Pool, int> pools_;  ///< people of each who are in no part yet
  int left_out_ = 0;           ///< people in no pool: every part has a group, and not theirs
  std::vector<int> people_;    ///< of each part
  std::vector<Point> points_;  ///< of all parts, in order
};

}  // namespace

Result<SectionPlan> plan_parts(const Show& show, SectionIndex section, const std::optional<Film>& film,
                               const Ways& ways) {
  return PartsSection(show, section, film, ways).run();
}

}  // namespace footlight::planner
