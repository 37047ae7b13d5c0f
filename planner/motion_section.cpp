// SPDX-License-Identifier: Apache-2.0
#include "planner/motion_section.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/motion.hpp"
#include "planner/motion/mark_instants.hpp"
#include "planner/motion/models.hpp"
#include "planner/motion/snap_crowd.hpp"
#include "planner/motion/swept_discs.hpp"
#include "planner/painted/scene.hpp"
#include "planner/painted/walls.hpp"

namespace footlight::planner {
namespace {

using Groups = std::vector<std::optional<GroupIndex>>;

/// Who stands where when the section begins, or shall when it ends.
struct Places {
  std::vector<CellIndex> cells;
  Groups groups;       ///< whose place each cell is; empty: not known, or anybody's
  bool named = false;  ///< cells are those of the performers, in their order
};

std::string place_text(Point at) { return fmt::format("[{:g} m, {:g} m]", at.x, at.y); }

class MotionSection {
 public:
  MotionSection(const Show& show, SectionIndex index, const Ways& ways, const Station* before, const Progress& progress)
      : show_(show),
        section_(show.sections[index.at()]),
        motion_(*section_.motion),
        index_(index),
        ways_(ways),
        grid_(ways.grid()),
        before_(before),
        progress_(progress) {}

  Result<SectionPlan> run(const std::optional<Film>& film) {
    auto plan = find_places(film);
    if (!plan) return plan;
    if (auto error = check_paths()) return *error;
    if (auto error = choose_instants()) return *error;
    const MotionFloor floor(ways_, motion_.obstacles, show_.tempo, show_.tempo.at(section_.start_count),
                            show_.terrain.get());
    const MotionTask task = motion_task(floor);
    auto led = move_crowd(task, motion_.options, progress_);
    if (!led) return positioned(led.error());
    take_goal(*led);
    instants_.thin(led->at, ways_);
    const std::vector<Ways> leg_ways = ways_beside_obstacles();
    if (auto error = check_ends(leg_ways)) return *error;
    const auto snapped = snap_crowd({&ways_, leg_ways, from_.cells, goal_cells_, &led->at, instants_.at_s,
                                     instants_.longest_m, show_.stage.clearance_m, task.group},
                                    progress_);
    if (!snapped) return interrupted();
    if (snapped->caught) return caught(*snapped->caught);
    plan->section.obstacles = obstacles();
    plan->section.film.reset();  // people stand in the picture at the end alone
    std::move(led->notes.begin(), led->notes.end(), std::back_inserter(plan->section.notes));
    note_marks(*snapped, plan->section.notes);
    plan->stations = stations(*snapped);
    return plan;
  }

 private:
  static Error interrupted() { return {ErrorKind::interrupted, "planning was stopped"}; }
  [[nodiscard]] Error positioned(const Error& error) const {
    if (error.kind != ErrorKind::input) return error;
    return input_error(
        message_at(show_, section_.position, fmt::format("sections[{}].planner", index_.value()), error.message, ""));
  }

  /// Where people begin and end. @return the plan of the source, without its stations
  Result<SectionPlan> find_places(const std::optional<Film>& film) {
    if (const auto* painted = std::get_if<PaintedOptions>(&motion_.options)) return read_painted(*painted, film);
    auto plan = plan_source(show_, index_, film, ways_, nullptr, progress_);
    if (!plan) return plan;
    to_ = places_of(plan->stations.front());
    if (auto error = find_beginning()) return *error;
    return plan;
  }

  /// A painting gives the beginning and the end.
  Result<SectionPlan> read_painted(const PaintedOptions& options, const std::optional<Film>& film) {
    if (!film || film->rgb.empty()) return internal_error("the painting of section '" + section_.name + "' is missing");
    const RgbPicture picture = picture_of(*film);
    auto scene = read_painting({&show_, index_, &options, &picture, &ways_, motion_.seed}, progress_);
    if (!scene) return scene.error();
    painting_.emplace(std::move(*scene));
    const Groups groups = show_.groups.empty() ? Groups{} : painting_->groups();
    from_ = {painting_->begin_cells(), groups, false};
    to_ = {painting_->end_cells(), groups, false};
    SectionPlan plan;
    plan.section.reserve = show_.stage.reserve;
    plan.section.notes = painting_->notes;
    return plan;
  }

  /// Groups are known where the formation says whose places its cells are, or whose in person.
  [[nodiscard]] Places places_of(const Station& station) const {
    Places out{station.cells, station.groups, station.pinned};
    if (!out.named || show_.groups.empty()) return out;
    for (const Performer& performer : show_.performers) out.groups.push_back(performer.group);
    return out;
  }

  /// What the section asks for groups for; nothing: it does not.
  [[nodiscard]] std::optional<std::string> needs_groups() const {
    for (const GroupPath& path : motion_.paths) {
      if (path.group) return "a path of the group '" + show_.groups[path.group->at()].name + "'";
    }
    if (to_.named) return std::nullopt;
    for (const auto& group : to_.groups) {
      if (group) return "places of the group '" + show_.groups[group->at()].name + "'";
    }
    return std::nullopt;
  }

  std::optional<Error> find_beginning() {
    if (before_ == nullptr) {
      return input_error(section_message(
          show_, index_,
          "its model leads people from where the section before leaves them, and there is none before it",
          "put a section before it that says where they begin, from cells, an image or parts"));
    }
    from_ = places_of(*before_);
    if (from_.named && to_.named) {
      return input_error(section_message(
          show_, index_, "who stands where is given by name at its beginning and at its end, and its model chooses",
          "list the cells at its end by groups, or without names"));
    }
    const auto need = needs_groups();
    if (need && from_.groups.empty()) {
      return input_error(section_message(
          show_, index_,
          fmt::format("it has {}, and nothing says who is in which group when it begins: section '{}' gives its "
                      "places to anybody",
                      *need, show_.sections[before_->section.at()].name),
          fmt::format("let section '{}' say whose its places are: cells with a column of groups or performers, or "
                      "parts with groups",
                      show_.sections[before_->section.at()].name)));
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Error> check_paths() const {
    const auto error = [&](std::size_t n, std::string text, std::string hint) {
      return input_error(message_at(show_, motion_.paths[n].position,
                                    fmt::format("sections[{}].paths[{}]", index_.value(), n), std::move(text),
                                    std::move(hint)));
    };
    for (std::size_t n = 0; n < motion_.paths.size(); ++n) {
      const std::vector<Point>& through = motion_.paths[n].through;
      for (std::size_t i = 0; i < through.size(); ++i) {
        const Point nearest = grid_.centre(grid_.nearest(through[i]));
        if (distance(nearest, through[i]) > 1.5 * grid_.pitch_m()) {
          return error(
              n, fmt::format("the point {} is off the floor", place_text(through[i])),
              fmt::format("the nearest cell is {} at {}", grid_.name(grid_.nearest(through[i])), place_text(nearest)));
        }
        const Point from = i > 0 ? through[i - 1] : through[i];
        if (ways_.straight(from, through[i])) continue;
        return error(n,
                     i > 0 ? fmt::format("the straight way from {} to {} goes through blocked cells, or comes nearer "
                                         "than {:g} m to one",
                                         place_text(from), place_text(through[i]), ways_.keep_m())
                           : fmt::format("the point {} is on a blocked cell, or nearer than {:g} m to one",
                                         place_text(from), ways_.keep_m()),
                     i > 0 ? "put points in between that lead around them" : "choose a point that is free");
      }
    }
    return std::nullopt;
  }

  std::optional<Error> choose_instants() {
    const double speed_mps = section_speed(show_, section_);
    const MarkTask task{
        &show_.tempo,       &grid_, show_.stage.walk, section_.start_count, section_.duration_counts, speed_mps,
        motion_.mark_counts};
    const double least_counts = least_mark_counts(task);
    if (motion_.mark_counts && *motion_.mark_counts < least_counts) {
      return input_error(message_at(
          show_, section_.position, fmt::format("sections[{}].marks", index_.value()),
          fmt::format("in {:g} count{} nobody comes to the next cell, {:g} m away at {:g} m/s", *motion_.mark_counts,
                      *motion_.mark_counts == 1 ? "" : "s", grid_.pitch_m(), speed_mps),
          fmt::format("marks: {:g} counts or more, or leave it out", std::ceil(least_counts * 100) / 100)));
    }
    instants_ = mark_instants(task);
    if (instants_.followed_mps > 0) return std::nullopt;
    return input_error(section_message(
        show_, index_,
        fmt::format("in {:g} count{} nobody comes to the next cell, {:g} m away at {:g} m/s", section_.duration_counts,
                    section_.duration_counts == 1 ? "" : "s", grid_.pitch_m(), speed_mps),
        "a longer duration"));
  }

  [[nodiscard]] MotionTask motion_task(const MotionFloor& floor) const {
    const std::size_t people = from_.cells.size();
    MotionTask task;
    for (const CellIndex cell : from_.cells) task.from.push_back(grid_.centre(cell));
    for (const CellIndex cell : to_.cells) task.to.push_back(grid_.centre(cell));
    const auto number = [](const std::optional<GroupIndex>& group) { return group ? group->value() : kNoGroup; };
    task.group.assign(people, kNoGroup);
    if (!from_.groups.empty()) {
      std::transform(from_.groups.begin(), from_.groups.end(), task.group.begin(), number);
      for (const auto& group : to_.groups) task.to_group.push_back(number(group));
    }
    for (std::size_t i = 0; i < people; ++i) task.radius_m.push_back(radius_m(i));
    task.agility = slowest(&Performer::agility, std::less<>());
    task.reaction_s = slowest(&Performer::reaction_s, std::greater<>());
    task.speed_mps.assign(people, kModelShare * instants_.followed_mps);
    task.at_s = instants_.at_s;
    task.paths = motion_.paths;
    task.floor = &floor;
    task.painting = painting_ ? &*painting_ : nullptr;
    task.seed = motion_.seed;
    return task;
  }

  /// Half of the room of whoever may stand on a cell at the beginning.
  [[nodiscard]] double radius_m(std::size_t place) const {
    double widest_m = show_.stage.clearance_m / 2;
    for (std::size_t p = 0; p < show_.performers.size(); ++p) {
      if (from_.named && p != place) continue;
      if (!from_.groups.empty() && show_.performers[p].group != from_.groups[place]) continue;
      widest_m = std::max(widest_m, show_.performers[p].radius_m);
    }
    return widest_m;
  }

  /// What people have of their own, by whoever may stand on each cell at the beginning: of several the one who is worst
  /// at it.  @param worse orders two of them  @return empty when nobody has any
  template <class Worse>
  [[nodiscard]] std::vector<std::optional<double>> slowest(std::optional<double> Performer::*own, Worse worse) const {
    const auto has = [&](const Performer& performer) { return (performer.*own).has_value(); };
    if (std::none_of(show_.performers.begin(), show_.performers.end(), has)) return {};
    std::map<std::optional<GroupIndex>, std::optional<double>> of_group;
    std::optional<double> of_all;
    const auto take = [&](std::optional<double>& worst, double one) {
      if (!worst || worse(one, *worst)) worst = one;
    };
    for (const Performer& performer : show_.performers) {
      if (!has(performer)) continue;
      take(of_group[performer.group], *(performer.*own));
      take(of_all, *(performer.*own));
    }
    std::vector<std::optional<double>> out(from_.cells.size(), of_all);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (from_.named) {
        out[i] = show_.performers[i].*own;
      } else if (!from_.groups.empty()) {
        const auto found = of_group.find(from_.groups[i]);
        out[i] = found != of_group.end() ? found->second : std::nullopt;
      }
    }
    return out;
  }

  /// Of each person, in the order of the beginning.
  void take_goal(const Trajectory& led) {
    FL_CHECK(led.at.size() == instants_.at_s.size() && led.place_of.size() == to_.cells.size());
    for (const std::uint32_t place : led.place_of) goal_cells_.push_back(to_.cells.at(place));
  }

  [[nodiscard]] Instant instant(std::size_t k) const { return show_.tempo.at(instants_.count[k]); }

  [[nodiscard]] std::vector<PlanObstacle> obstacles() const {
    std::vector<PlanObstacle> out;
    for (const MovingObstacle& one : motion_.obstacles) {
      PlanObstacle& obstacle = out.emplace_back();
      obstacle.radius_m = one.radius_m;
      for (const MovingObstacle::At& at : one.at) obstacle.at.push_back({show_.tempo.at(at.count), at.centre});
    }
    return out;
  }

  /// Of each walk; none when nothing moves.
  [[nodiscard]] std::vector<Ways> ways_beside_obstacles() const {
    std::vector<Ways> out;
    if (motion_.obstacles.empty()) return out;
    const Instant end = show_.tempo.at(section_.end_count());
    for (std::size_t k = 1; k < instants_.count.size(); ++k) {
      const Instant next = k + 1 < instants_.count.size() ? instant(k + 1) : end;
      out.push_back(ways_.beside(swept_discs(show_, instant(k - 1), instant(k)), swept_discs(show_, instant(k), next)));
    }
    return out;
  }

  /// Nobody can begin or end where a moving obstacle is.
  [[nodiscard]] std::optional<Error> check_ends(const std::vector<Ways>& leg_ways) const {
    if (leg_ways.empty()) return std::nullopt;
    const Instant start = instant(0);
    const Ways at_start = ways_.beside({}, swept_discs(show_, start, start));
    for (const auto& [ways, cells, where] :
         {std::tuple(&at_start, &from_.cells, "begins"), std::tuple(&leg_ways.back(), &goal_cells_, "ends")}) {
      for (const CellIndex cell : *cells) {
        if (ways->can_stand(cell)) continue;
        return obstacle_error(
            fmt::format("somebody stands on {} when the section {}, where it is then, or nearer to it "
                        "than {:g} m",
                        grid_.name(cell), where, ways_.keep_m()),
            "another way for the obstacle, or other places");
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] Error obstacle_error(std::string text, std::string hint) const {
    return input_error(message_at(show_, motion_.obstacles.front().position,
                                  fmt::format("sections[{}].obstacles", index_.value()), std::move(text),
                                  std::move(hint)));
  }

  [[nodiscard]] Error caught(const SnappedCrowd::Caught& caught) const {
    return obstacle_error(
        fmt::format("at count {:g} it reaches somebody on {}, and no cell is free that she can reach in time",
                    instants_.count[caught.instant], grid_.name(grid_.nearest(caught.at))),
        "a slower or smaller obstacle, another way for it, or more room beside it");
  }

  [[nodiscard]] std::vector<Station> stations(const SnappedCrowd& snapped) const {
    std::vector<Station> out;
    // Where the section before ends people stand already; a painting has a beginning of its own.
    const bool touches = !painting_ && before_ != nullptr && before_->depart >= instant(0);
    for (std::size_t k = touches ? 1 : 0; k < snapped.cells.size(); ++k) {
      const bool last = k + 1 == snapped.cells.size();
      Station& station = out.emplace_back();
      station.section = index_;
      station.count = instants_.count[k];
      station.arrive = station.depart = show_.tempo.at(station.count);
      if (last) station.depart = std::max(station.arrive, show_.tempo.at(section_.end_count()));
      station.cells = snapped.cells[k];
      station.groups = from_.groups;
      station.follows = true;
      station.exact = station.key = last && !goal_cells_.empty();
      if (k == 0 && painting_) {
        station.follows = false;
        station.exact = station.key = true;
      }
      if (last && to_.named) {
        station.cells = to_.cells;
        station.groups.clear();
        station.pinned = true;
        station.follows = false;
      }
      const auto& reserve = show_.stage.reserve;
      station.in_picture =
          static_cast<int>(std::count_if(station.cells.begin(), station.cells.end(), [&](CellIndex cell) {
            return !std::binary_search(reserve.begin(), reserve.end(), cell);
          }));
    }
    return out;
  }

  void note_marks(const SnappedCrowd& snapped, std::vector<std::string>& notes) const {
    notes.push_back(fmt::format(
        "{} marks, every {:g} counts where that is enough, are {:.2f} m from the model's way, at most {:.2f} m (count "
        "{:g})",
        snapped.cells.size(), instants_.spacing_counts, snapped.mean_m, snapped.max_m,
        instants_.count[snapped.farthest_instant]));
  }

  const Show& show_;
  const Section& section_;
  const Motion& motion_;
  SectionIndex index_;
  const Ways& ways_;
  const Grid& grid_;
  const Station* before_;
  const Progress& progress_;
  Places from_;
  Places to_;
  std::vector<CellIndex> goal_cells_;  ///< of each person; empty: wherever the model ends
  MarkInstants instants_;
  std::optional<PaintedScene> painting_;
};

}  // namespace

Result<SectionPlan> plan_motion(const Show& show, SectionIndex section, const std::optional<Film>& film,
                                const Ways& ways, const Station* before, const Progress& progress) {
  return MotionSection(show, section, ways, before, progress).run(film);
}

}  // namespace footlight::planner
