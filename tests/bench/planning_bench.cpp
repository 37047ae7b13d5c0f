// SPDX-License-Identifier: Apache-2.0
// Formation, one whole unit (formation and pairing, PAT and MAP of Li 2020 table 1), and the judges.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "planner/formation/cell_shares.hpp"
#include "planner/formation/formation.hpp"
#include "planner/hierarchy/hierarchical_matching.hpp"
#include "planner/measure.hpp"
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
  add(effort, "validate 100 marks", 3290, judge)->MeasureProcessCPUTime();
  add(effort, "measure 100 marks", 3290, measure_all)->MeasureProcessCPUTime();
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
