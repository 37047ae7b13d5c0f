// SPDX-License-Identifier: Apache-2.0
#include "planner/picture_section.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "planner/formation/cell_shares.hpp"
#include "planner/formation/formation.hpp"
#include "planner/formation/placement.hpp"
#include "planner/formation/sampling.hpp"
#include "planner/joint_section.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

/// Key frames are so far apart that everybody could walk this many pitches in between.
constexpr double kShortestInterval = 2.5;

const PictureOptions& picture_options(const Section& section) {
  if (const auto* video = std::get_if<VideoSource>(&section.from)) return video->picture;
  return std::get<ImageSource>(section.from).picture;
}
const std::string& picture_path(const Section& section) {
  if (const auto* video = std::get_if<VideoSource>(&section.from)) return video->path;
  return std::get<ImageSource>(section.from).path;
}

/// Percentage as people write it: "83 %".
std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

class PictureSection {
 public:
  PictureSection(const Show& show, SectionIndex index, const Film& film, const Ways& ways, const Station* before,
                 const Progress& progress)
      : show_(show),
        section_(show.sections[index.at()]),
        index_(index),
        film_(film),
        ways_(ways),
        before_(before),
        progress_(progress),
        grid_(show.stage.grid),
        people_(static_cast<int>(show.performers.size())) {
    usable_ = ways.standable();
    for (const CellIndex cell : show.stage.reserve) {
      usable_[cell.at()] = 0;
      if (ways.can_stand(cell)) reserve_.push_back(cell);
    }
  }

  Result<SectionPlan> run() {
    if (auto error = choose_keys()) return *error;
    const auto extent = picture_extent(key_masks());
    if (auto error = place(extent)) return *error;
    if (!draw_all()) return Error{ErrorKind::interrupted, "stopped while drawing formations"};
    if (auto error = too_many_people()) return *error;
    SectionPlan plan;
    plan.section.notes = notes();
    describe(plan.section);
    fill_stations(plan);
    if (jointly_) why_not_ = draw_and_walk({&show_, index_, before_, joint_task()}, plan, progress_);
    if (!why_not_.empty()) plan.section.notes.push_back("planned as `model: hierarchical`: " + why_not_);
    if (progress_.stopped()) return Error{ErrorKind::interrupted, "stopped while drawing formations"};
    return plan;
  }

 private:
  [[nodiscard]] JointTask joint_task() const {
    return {&film_,
            &ways_,
            &usable_,
            reserve_,
            placement_.map,
            fps_,
            keys_.front().time,
            keys_,
            static_cast<std::size_t>(people_),
            {},
            section_speed(show_, section_),
            section_.planner.effort,
            {}};
  }

  /// The director's key frames, ascending; an instant named twice is one.
  std::optional<Error> find_given(const FilmTime& time, std::vector<KeyFrame>& given) const {
    for (const SectionKey& key : section_.keys) {
      const auto found = given_key(film_, time, key);
      if (!found) {
        const double frames = static_cast<double>(film_.frames.size()) - 1;
        return input_error(message_at(
            show_, key.position, fmt::format("sections[{}].keys", index_.value()),
            key.count ? fmt::format("count {:g} is outside of the video", *key.count)
                      : fmt::format("{:g} s is outside of the frames that are shown", key.film_s),
            key.count       ? fmt::format("it runs from count {:g} to count {:g}", time.start_count,
                                          time.start_count + time.duration_counts)
            : film_.fps > 0 ? fmt::format("they are {:.3g} s to {:.3g} s of its file", film_.first_frame / film_.fps,
                                          (film_.first_frame + frames) / film_.fps)
                            : "its file has no frame rate; write counts"));
      }
      given.push_back(*found);
    }
    const auto earlier = [](const KeyFrame& a, const KeyFrame& b) { return a.time < b.time; };
    std::stable_sort(given.begin(), given.end(), earlier);
    const auto same = [](const KeyFrame& a, const KeyFrame& b) { return a.time == b.time; };
    given.erase(std::unique(given.begin(), given.end(), same), given.end());
    return std::nullopt;
  }

  std::optional<Error> choose_keys() {
    const bool video = std::holds_alternative<VideoSource>(section_.from);
    if (!video || film_.frames.size() < 2 || section_.duration_counts <= 0) {
      keys_ = {{0, section_.start_count, show_.tempo.at(section_.start_count)}};
      return std::nullopt;
    }
    const FilmTime time{section_.start_count, section_.duration_counts, &show_.tempo};
    fps_ = show_fps(film_, time);
    std::vector<KeyFrame> given;
    if (auto error = find_given(time, given)) return error;
    const double walk_s = grid_.pitch_m() / section_speed(show_, section_);
    if (section_.planner.model == PlannerModel::joint && !section_.regions.empty()) {
      why_not_ = "groups are bound to regions";
    } else if (section_.planner.model == PlannerModel::joint) {
      auto instants = walking_instants(film_, time, section_.sampling.snap_to_count, kJointInterval * walk_s);
      jointly_ = can_plan_jointly(grid_, instants.size());
      if (jointly_) {
        keys_ = with_given(std::move(instants), given, kJointInterval * walk_s);
        return std::nullopt;
      }
      why_not_ = "more than 3 million cells times instants";
    }
    Sampling sampling = section_.sampling;
    if (section_.planner.model == PlannerModel::flat && !given.empty()) {
      // Global matching at the given key frames: nothing is sampled between them.
      sampling.interval = show_.tempo.span(time.start_count, time.duration_counts);
      sampling.hash = 1;
    }
    keys_ = sample(film_, time, sampling, kShortestInterval * walk_s, given);
    return std::nullopt;
  }

  [[nodiscard]] std::vector<const Mask*> key_masks() const {
    std::vector<const Mask*> masks;
    masks.reserve(keys_.size());
    for (const KeyFrame& key : keys_) masks.push_back(&film_.frames[static_cast<std::size_t>(key.frame)]);
    return masks;
  }

  std::optional<Error> place(const std::optional<Box>& extent) {
    std::int64_t most = -1;
    const Mask* largest = nullptr;
    for (const Mask* mask : key_masks()) {
      const std::int64_t area = picture_area(*mask);
      if (area > most) {
        most = area;
        largest = mask;
      }
    }
    const int usable = static_cast<int>(std::count(usable_.begin(), usable_.end(), 1));
    const int room = usable + static_cast<int>(reserve_.size());
    if (room < people_) {
      return input_error(section_message(
          show_, index_, fmt::format("{} performers, but the stage has {} cells to stand on", people_, room),
          "a larger grid, a smaller pitch or fewer performers"));
    }
    if (usable == 0) {
      return input_error(section_message(
          show_, index_, "no cell is left for the picture beside reserve and blocked cells", "free some cells"));
    }
    const Box whole{0, 0, double(film_.width), double(film_.height)};
    placement_ = place_picture({&show_.stage, &usable_, picture_options(section_).fit, largest, extent.value_or(whole),
                                std::min(people_, usable)});
    return std::nullopt;
  }

  bool draw_all() {
    const auto ranks = even_ranks(grid_);
    drawings_.resize(keys_.size());
    std::vector<CellIndex> middle;
    const int least = std::max(0, people_ - static_cast<int>(reserve_.size()));
    const auto draw_one = [&](std::size_t k, std::span<const CellIndex> when_blank) {
      const Mask& picture = film_.frames[static_cast<std::size_t>(keys_[k].frame)];
      const auto shares = cell_shares(picture, grid_, placement_.map);
      drawings_[k] = draw({&grid_, &shares, &usable_, &ranks, people_, least, when_blank});
    };
    if (!for_each_index(keys_.size(), "formations", progress_, [&](std::size_t k) { draw_one(k, {}); })) return false;
    // A blank frame without a reserve keeps the picture before it, or the first one after it.
    for (std::size_t pass = 0; pass < 2; ++pass) {
      for (std::size_t n = 1; n < keys_.size(); ++n) {
        const std::size_t k = pass == 0 ? n : keys_.size() - 1 - n;
        const std::size_t other = pass == 0 ? k - 1 : k + 1;
        const bool copied = drawings_[k].touched == 0 && !drawings_[k].cells.empty();
        if (copied && (pass == 0 ? drawn(other) : drawn(other) && !drawn(k))) {
          draw_one(k, drawings_[other].cells);
          kept_.resize(keys_.size());
          kept_[k] = 1;
        }
      }
    }
    return true;
  }
  [[nodiscard]] bool drawn(std::size_t k) const {
    return drawings_[k].touched > 0 || (k < kept_.size() && kept_[k] != 0);
  }

  [[nodiscard]] std::optional<Error> too_many_people() const {
    int hold = 0;
    for (const Drawing& drawing : drawings_) hold = std::max(hold, drawing.touched);
    const int reserve = static_cast<int>(reserve_.size());
    if (hold + reserve >= people_) return std::nullopt;
    return input_error(
        section_message(show_, index_,
                        fmt::format("{} performers, but the largest picture of '{}' holds {} and the reserve {}",
                                    people_, picture_path(section_), hold, reserve),
                        fmt::format("at least {} more reserve cells, a larger floor, fit: area, or fewer performers",
                                    people_ - hold - reserve)));
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    if (placement_.drawn_share < 0.9995) {
      notes.push_back(
          fmt::format("the picture is drawn at {} of the size that gives everybody a cell: more would not "
                      "fit on the floor beside reserve and blocked cells",
                      percent(placement_.drawn_share)));
    }
    int fullest = 0;
    int widened = 0;
    int most_added = 0;
    for (const Drawing& drawing : drawings_) {
      fullest = std::max(fullest, drawing.full);
      const int added = static_cast<int>(drawing.cells.size()) - std::max(drawing.full, 0);
      widened += added > 0 ? 1 : 0;
      most_added = std::max(most_added, added);
    }
    if (fullest > people_ * 1.02) {
      notes.push_back(fmt::format("the largest picture fills {} cells for {} performers: thinned evenly to {}", fullest,
                                  people_, percent(double(people_) / fullest)));
    }
    if (widened > 0 && most_added > people_ / 100) {
      notes.push_back(
          fmt::format("{} of {} pictures are widened by up to {} cells: the reserve has no room for who is "
                      "not in the picture",
                      widened, drawings_.size(), most_added));
    }
    return notes;
  }

  void describe(PlanSection& section) const {
    section.reserve = show_.stage.reserve;
    if (picture_options(section_).colour) return;  // a plan remembers pictures by their threshold
    FilmPlacement film;
    film.path = picture_path(section_);
    film.first_frame = film_.first_frame;
    film.last_frame = film_.first_frame + static_cast<int>(film_.frames.size()) - 1;
    film.show_fps = fps_;
    film.width = film_.width;
    film.height = film_.height;
    film.threshold = film_.threshold;
    film.inverted = film_.inverted;
    film.stage_to_frame = placement_.map;
    section.film = film;
  }

  void fill_stations(SectionPlan& plan) const {
    const auto waiting = waiting_places({&grid_, &reserve_, &drawings_, people_});
    const bool video = fps_ > 0;
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      Station station;
      station.section = index_;
      station.count = keys_[k].count;
      station.arrive = station.depart = keys_[k].time;
      if (video) station.frame = film_.first_frame + keys_[k].frame;
      station.cells = drawings_[k].cells;
      station.in_picture = drawings_[k].in_picture;
      station.cells.insert(station.cells.end(), waiting[k].begin(), waiting[k].end());
      station.exact = !video || k == 0 || keys_[k].given;
      station.key = station.exact || section_.keys.empty();
      plan.stations.push_back(std::move(station));
    }
    plan.stations.back().depart = std::max(plan.stations.back().arrive, show_.tempo.at(section_.end_count()));
  }

  const Show& show_;
  const Section& section_;
  SectionIndex index_;
  const Film& film_;
  const Ways& ways_;
  const Station* before_;
  const Progress& progress_;
  const Grid& grid_;
  int people_;
  CellFlags usable_;
  std::vector<CellIndex> reserve_;
  std::vector<KeyFrame> keys_;
  double fps_ = 0;
  Placement placement_;
  std::vector<Drawing> drawings_;
  std::vector<char> kept_;
  bool jointly_ = false;
  std::string why_not_;  // planned jointly, though the section asks for it
};

}  // namespace

Result<SectionPlan> plan_pictures(const Show& show, SectionIndex section, const Film& film, const Ways& ways,
                                  const Station* before, const Progress& progress) {
  return PictureSection(show, section, film, ways, before, progress).run();
}

}  // namespace footlight::planner
