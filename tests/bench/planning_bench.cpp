// SPDX-License-Identifier: Apache-2.0
// Formation, one whole unit (formation and pairing, PAT and MAP of Li 2020 table 1), and the judges.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "planner/assignment/assignment.hpp"
#include "planner/formation/cell_shares.hpp"
#include "planner/formation/formation.hpp"
#include "planner/hierarchy/hierarchical_matching.hpp"
#include "planner/measure.hpp"
#include "planner/schedule/steps.hpp"
#include "planner/validate.hpp"
#include "tests/bench/instances.hpp"
#include "tests/bench/job.hpp"
#include "tests/support/plan_builder.hpp"

namespace footlight::bench {
namespace {

using planner::CellFlags;

struct FrameSize {
  const char* name;
  int width;
  int height;
};
constexpr FrameSize kFrameSizes[] = {{"640x480", 640, 480}, {"1920x1080", 1920, 1080}};

/// A section's picture laid on a floor that the flower fills to about half; what a unit finds ready.
class Floor {
 public:
  Floor(int people, int width, int height)
      : people_(people), width_(width), height_(height), first_(flower_picture(width, height, 0)) {
    const int side = static_cast<int>(std::ceil(2.4 * std::sqrt(static_cast<double>(people))));
    stage_.grid = *Grid::make(GridKind::square, side, side, 1.0);
    usable_.assign(static_cast<std::size_t>(stage_.grid.size()), 1);
    ranks_ = planner::even_ranks(stage_.grid);
    place();
  }

  void place() {
    const auto extent = planner::picture_extent({&first_});
    placement_ = planner::place_picture({&stage_, &usable_, Fit::area, &first_, *extent, people_});
  }
  [[nodiscard]] Mask frame(double turn) const { return flower_picture(width_, height_, turn); }
  [[nodiscard]] std::vector<double> shares(const Mask& mask) const {
    return planner::cell_shares(mask, stage_.grid, placement_.map);
  }
  [[nodiscard]] planner::Drawing drawing(const Mask& mask) const {
    const auto picture = shares(mask);
    return planner::draw({&stage_.grid, &picture, &usable_, &ranks_, people_, people_, {}});
  }
  [[nodiscard]] const Grid& grid() const { return stage_.grid; }
  [[nodiscard]] const StageToFrame& map() const { return placement_.map; }
  [[nodiscard]] int people() const { return people_; }

 private:
  int people_;
  int width_;
  int height_;
  Mask first_;
  Stage stage_;
  CellFlags usable_;
  std::vector<std::uint32_t> ranks_;
  planner::Placement placement_;
};

bool distinct(std::vector<std::uint32_t> values) {
  std::ranges::sort(values);
  return std::ranges::adjacent_find(values) == values.end();
}

void formation(benchmark::State& state, const std::string& name, FrameSize size) {
  const Floor floor(3290, size.width, size.height);
  const Mask mask = floor.frame(0.17);
  planner::Drawing drawing;
  const auto work = [&] { drawing = floor.drawing(mask); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  if (drawing.cells.size() != 3290) state.SkipWithError("not exactly 3290 cells");
  const auto shares = floor.shares(mask);
  double picture = 0;
  for (const CellIndex cell : drawing.cells) picture += shares[cell.at()];
  state.counters["cost"] = picture;
}

void placement(benchmark::State& state, const std::string& name, FrameSize size) {
  Floor floor(3290, size.width, size.height);
  const auto work = [&] { floor.place(); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
}

void unit(benchmark::State& state, const std::string& name, int people, PlannerModel model) {
  const Floor floor(people, 640, 480);
  const auto before = floor.drawing(floor.frame(0)).cells;
  const Mask mask = floor.frame(0.17);
  PlannerOptions options;
  options.model = model;
  std::vector<std::uint32_t> pairing;
  const auto work = [&] {
    const auto drawing = floor.drawing(mask);
    pairing = planner::pair_formations(floor.grid(), before, drawing.cells, options);
  };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  const bool everybody = pairing.size() == static_cast<std::size_t>(people) && distinct(pairing) &&
                         *std::ranges::max_element(pairing) < static_cast<std::uint32_t>(people);
  if (!everybody) state.SkipWithError("the pairing is no bijection of everybody");
}

constexpr int kMarks = 100;

/// A flower that turns for a hundred marks, five seconds each, paired by squared distance: no two people come nearer
/// than 0.7 cells.
struct TurningFlower {
  Plan plan;
  std::vector<std::optional<Film>> films;
};

const TurningFlower& turning_flower() {
  static const auto show = [] {
    auto out = std::make_unique<TurningFlower>();
    const Floor floor(3290, 640, 480);
    Film film{640, 480, 0.2, 0, 128, false, {}};
    std::vector<CellIndex> now;
    std::vector<std::vector<Mark>> tracks(3290);
    PlannerOptions flat;
    flat.model = PlannerModel::flat;
    for (int k = 0; k < kMarks; ++k) {
      film.frames.push_back(floor.frame(0.02 * k));
      const auto cells = floor.drawing(film.frames.back()).cells;
      if (k == 0) now = cells;
      const auto pairing = planner::pair_formations(floor.grid(), now, cells, flat);
      for (std::size_t i = 0; i < now.size(); ++i) {
        now[i] = cells[pairing[i]];
        tracks[i].push_back({instant_at(5.0 * k), now[i]});
      }
    }
    out->plan = tests::plan_of(floor.grid(), std::move(tracks));
    out->plan.stage.max_speed_mps = 20;
    PlanSection section;
    section.name = "flower";
    section.end = instant_at(5.0 * (kMarks - 1));
    section.max_speed_mps = 20;
    section.film = FilmPlacement{"flower", 0, kMarks - 1, 0.2, 640, 480, 128, false, floor.map()};
    out->plan.sections.push_back(section);
    out->films.emplace_back(std::move(film));
    return out;
  }();
  return *show;
}

void judge(benchmark::State& state, const std::string& name) {
  const Plan& plan = turning_flower().plan;
  planner::Verdict verdict;
  const auto work = [&] { verdict = planner::validate(plan); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  if (!verdict.valid()) state.SkipWithError("the turning flower is not valid");
}

void measure_all(benchmark::State& state, const std::string& name) {
  const TurningFlower& show = turning_flower();
  planner::ShowMeasures measures;
  const auto work = [&] { measures = planner::measure(show.plan, show.films); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  const auto theta = measures.show.theta_dev;
  if (measures.show.frames != kMarks || !theta || *theta > 0.2) state.SkipWithError("the flower is not drawn");
}

/// A disk opens into a ring over neighbouring cells, on a floor of four cells a person.
struct CellWalk {
  explicit CellWalk(int people) {
    const Instance instance = make_instance(Scene::disk_to_ring, people);
    const auto pairing = planner::assign(instance.sources, instance.targets, planner::WalkCost::squared,
                                         std::numeric_limits<double>::infinity());
    FL_CHECK(pairing.has_value());
    Point low = instance.sources[0];
    Point high = low;
    for (const auto* points : {&instance.sources, &instance.targets}) {
      for (const Point& point : *points) {
        low = {std::min(low.x, point.x), std::min(low.y, point.y)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y)};
      }
    }
    const int side = std::max(static_cast<int>(std::ceil(2 * std::sqrt(static_cast<double>(people)))),
                              static_cast<int>(std::lround(std::max(high.x - low.x, high.y - low.y))) + 1);
    stage.grid = *Grid::make(GridKind::square, side, side, 1.0);
    const auto cell = [&](Point point) {
      return stage.grid.index(
          {static_cast<int>(std::lround(point.x - low.x)), static_cast<int>(std::lround(point.y - low.y))});
    };
    for (const Point& point : instance.sources) from.push_back(cell(point));
    for (const std::uint32_t target : pairing->target_of) to.push_back(cell(instance.targets[target]));
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Cell a = stage.grid.cell(from[i]);
      const Cell b = stage.grid.cell(to[i]);
      longest = std::max(longest, std::abs(a.column - b.column) + std::abs(a.row - b.row));
    }
  }

  Stage stage;
  std::vector<CellIndex> from;
  std::vector<CellIndex> to;
  int longest = 0;  ///< cells of the longest way
};

void schedule(benchmark::State& state, const std::string& name, int people) {
  const CellWalk walk(people);
  const planner::Ways ways(walk.stage, walk.stage.clearance_m / 2);
  std::optional<planner::Steps> steps;
  const auto work = [&] { steps = planner::step_through({&ways, walk.from, walk.to, 10 * walk.longest}); };
  state.counters["mb"] = peak_memory_once_mb(name, work);
  for (auto _ : state) work();
  if (!steps || !steps->arrived) return state.SkipWithError("not everybody has arrived");
  // What the prototype comes to, too: as many steps as the longest way has cells.
  if (steps->count() > walk.longest + 2) state.SkipWithError("it takes more steps than the longest way");
  state.counters["steps"] = steps->count();
}

template <class Work>
benchmark::internal::Benchmark* add(const Effort& effort, const std::string& job, long size, Work work) {
  const std::string name = job_name("ours", job, size);
  return benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { work(state, name); })
      ->Repetitions(effort.repetitions());
}

}  // namespace

void register_planning(const Effort& effort) {
  for (const FrameSize size : kFrameSizes) {
    add(effort, std::string("formation ") + size.name, 3290,
        [=](benchmark::State& state, const std::string& name) { formation(state, name, size); });
    add(effort, std::string("placement ") + size.name, 3290,
        [=](benchmark::State& state, const std::string& name) { placement(state, name, size); });
  }
  for (const int people : {100, 330, 1000, 3290, 5000}) {
    for (const PlannerModel model : {PlannerModel::flat, PlannerModel::hierarchical}) {
      add(effort, model == PlannerModel::flat ? "unit flat" : "unit hierarchical", people,
          [=](benchmark::State& state, const std::string& name) { unit(state, name, people, model); });
    }
  }
  for (const int people : {1000, 3290, 10'000, 100'000}) {
    if (effort.quick && people > 10'000) continue;
    add(effort, "schedule over cells", people,
        [=](benchmark::State& state, const std::string& name) { schedule(state, name, people); });
  }
  add(effort, "validate 100 marks", 3290, judge)->MeasureProcessCPUTime();
  add(effort, "measure 100 marks", 3290, measure_all)->MeasureProcessCPUTime();
}

void write_cell_walks(const std::string& folder) {
  for (const int people : {1000, 3290, 10'000, 100'000}) {
    const CellWalk walk(people);
    std::ofstream pairs(folder + "/cells_" + std::to_string(people) + ".txt");
    std::ofstream matching(folder + "/cells_" + std::to_string(people) + ".match.txt");
    pairs << people << "\n";
    for (std::size_t i = 0; i < walk.from.size(); ++i) {
      const Cell a = walk.stage.grid.cell(walk.from[i]);
      const Cell b = walk.stage.grid.cell(walk.to[i]);
      pairs << a.column << " " << a.row << " " << b.column << " " << b.row << "\n";
      matching << i << "\n";
    }
  }
}

void write_pictures(const std::string& folder) {
  for (const FrameSize size : kFrameSizes) {
    const Floor floor(3290, size.width, size.height);
    const Mask mask = floor.frame(0.17);
    std::ofstream out(folder + "/picture_" + size.name + ".txt");
    out.precision(17);
    out << size.width << " " << size.height << " " << floor.grid().columns() << " " << floor.grid().rows() << "\n";
    for (const double value : floor.map()) out << value << " ";
    out << "\n";
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) out << (mask.at(x, y) ? '1' : '0');
      out << "\n";
    }
  }
}

}  // namespace footlight::bench
