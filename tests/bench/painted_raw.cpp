// SPDX-License-Identifier: Apache-2.0
// footlight_painted_raw SHOW                   plans it and says where everybody is every half second of its painted
//                                              section: as the model leads people, and as they walk
// footlight_painted_raw --maps                 how good maps of a shape are, as Kang 2014, figure 3
// footlight_painted_raw --train PEOPLE INPUTS  processor time of one map
// footlight_painted_raw --steps SHOW           processor time of the show's model on one thread, and of what it asks of
//                                              the painting
// Prints one JSON object. For scripts/kang2014.
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "config/media.hpp"
#include "config/show_file.hpp"
#include "core/motion.hpp"
#include "core/rng.hpp"
#include "planner/motion/mark_instants.hpp"
#include "planner/motion/models.hpp"
#include "planner/painted/painted_model.hpp"
#include "planner/painted/section_scene.hpp"
#include "planner/plan_section.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"

namespace footlight {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStep_s = 0.5;  // at most a count

[[noreturn]] void fail(const std::string& message) {
  std::cerr << message << '\n';
  std::exit(2);
}

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A show of one painted section, its painting decoded.
struct Painted {
  explicit Painted(const std::string& path) {
    auto loaded = config::load_show(path);
    if (!loaded) fail(loaded.error().to_text());
    show = std::move(loaded->show);
    films.resize(show.sections.size());
    const auto* source = std::get_if<PaintingSource>(&show.sections.at(0).from);
    if (source == nullptr || !show.sections[0].motion) fail(path + ": its first section is not painted");
    auto film = config::decode_painting(*source);
    if (!film) fail(film.error().message);
    films[0] = std::move(*film);
  }
  [[nodiscard]] planner::PaintedScene scene() const {
    auto out = planner::section_scene(show, SectionIndex(0), films, {});
    if (!out) fail(out.error().message);
    return std::move(*out);
  }
  [[nodiscard]] const Section& section() const { return show.sections[0]; }
  [[nodiscard]] const PaintedOptions& options() const { return std::get<PaintedOptions>(section().motion->options); }

  Show show;
  std::vector<std::optional<Film>> films;
};

/// What the planner asks the model for, at other instants.
planner::MotionTask task_of(const Painted& one, const planner::PaintedScene& scene, const planner::MotionFloor& floor) {
  const Show& show = one.show;
  const Section& section = one.section();
  const double duration_s =
      to_seconds(show.tempo.at(section.start_count + section.duration_counts) - show.tempo.at(section.start_count));
  const planner::MarkInstants marks = planner::mark_instants(
      {&show.tempo, &show.stage.grid, show.stage.walk, section.start_count, section.duration_counts,
       planner::section_speed(show, section), section.motion->mark_counts});
  planner::MotionTask task;
  for (const CellIndex cell : scene.begin_cells()) task.from.push_back(show.stage.grid.centre(cell));
  for (const CellIndex cell : scene.end_cells()) task.to.push_back(show.stage.grid.centre(cell));
  task.group.assign(task.people(), planner::kNoGroup);
  task.radius_m.assign(task.people(), show.stage.clearance_m / 2);
  task.speed_mps.assign(task.people(), planner::kModelShare * marks.followed_mps);
  for (double at_s = 0; at_s < duration_s - 1e-9; at_s += kStep_s) task.at_s.push_back(at_s);
  task.at_s.push_back(duration_s);
  task.floor = &floor;
  task.painting = &scene;
  task.seed = section.motion->seed;
  return task;
}

/// Millimetres are enough for whoever reads it.
Json place(Point at) { return {std::round(at.x * 1000) / 1000, std::round(at.y * 1000) / 1000}; }

Json follow(const Painted& one) {
  const Show& show = one.show;
  const auto planned = planner::plan_show(show, one.films);
  if (!planned) fail(planned.error().message);
  const Plan& plan = planned->plan;
  const planner::Verdict verdict = planner::validate(plan);
  const planner::PaintedScene scene = one.scene();
  const Instant start = show.tempo.at(one.section().start_count);
  const planner::MotionFloor floor(*scene.ways, one.section().motion->obstacles, show.tempo, start);
  const planner::MotionTask task = task_of(one, scene, floor);
  const auto led = planner::move_crowd(task, one.section().motion->options, planner::Progress{});
  if (!led) fail(led.error().message);
  std::map<CellIndex, std::size_t> on;
  for (std::size_t p = 0; p < plan.tracks.size(); ++p) {
    on[show.stage.grid.nearest(position_at(show.stage.grid, plan.tracks[p], start))] = p;
  }
  std::vector<std::size_t> who;
  for (const CellIndex cell : scene.begin_cells()) who.push_back(on.at(cell));
  Json out = {{"people", task.people()},
              {"valid", plan.valid},
              {"violations", verdict.violations},
              {"min_clearance_m", verdict.min_clearance_m},
              {"max_speed_mps", verdict.max_speed_mps},
              {"refusal", planned->refusal},
              {"notes", plan.sections.at(0).notes},
              {"model_speed_mps", task.speed_mps.front()},
              {"at_s", task.at_s}};
  for (const std::size_t p : who) {
    const auto group = show.performers[p].group;
    out["group"].push_back(group ? show.groups[group->at()].name : "");
  }
  for (std::size_t k = 0; k < task.at_s.size(); ++k) {
    Json raw;
    Json walked;
    for (std::size_t i = 0; i < who.size(); ++i) {
      raw.push_back(place(led->at[k][i]));
      walked.push_back(place(position_at(show.stage.grid, plan.tracks[who[i]], start + seconds(task.at_s[k]))));
    }
    out["raw"].push_back(std::move(raw));
    out["walked"].push_back(std::move(walked));
  }
  return out;
}

/// Shapes that no lattice fits.
planner::PixelSet shape_where(const std::function<bool(double, double)>& inside) {
  constexpr int kSide = 80;
  planner::PixelSet out(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) out.at(x, y) = inside(x - 39.5, y - 39.5) ? 1 : 0;
  }
  return out;
}

Json quality_of(const planner::PixelSet& shape, const planner::Lattice& lattice, const std::vector<Point>& places) {
  const planner::MapQuality q = planner::quality(shape, lattice, places);
  return {{"kept", q.neighbours_kept}, {"separation", q.separation}, {"coverage", q.coverage}, {"inside", q.inside}};
}

/// 225 people, 3,000 inputs, as in figure 3; ten seeds each.
Json maps() {
  constexpr int kPeople = 225;
  const planner::Lattice lattice(kPeople, 1);
  const std::vector<std::pair<std::string, planner::PixelSet>> shapes{
      {"horseshoe", shape_where([](double x, double y) {
         const double r = std::hypot(x, y);
         return r <= 38 && r >= 16 && !(y > 0 && std::abs(x) < 15);
       })},
      {"star",
       shape_where([](double x, double y) { return std::hypot(x, y) <= 26 + 12 * std::cos(5 * std::atan2(x, -y)); })}};
  const std::vector<std::tuple<std::string, bool, bool>> kinds{{"both forces", true, true},
                                                               {"without the distance force", true, false},
                                                               {"without the shape force", false, true},
                                                               {"plain map", false, false}};
  Json out;
  for (const auto& [name, shape] : shapes) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      for (const auto& [kind, fit, apart] : kinds) {
        planner::SodmTask task{&shape, &lattice, 3000, seed, fit, apart};
        out[name][kind].push_back(quality_of(shape, lattice, planner::sodm(task)));
      }
      Rng rng(seed);
      std::vector<Point> random;
      while (random.size() < kPeople) {
        const Point at{rng.uniform() * shape.width, rng.uniform() * shape.height};
        if (shape.at(static_cast<int>(at.x), static_cast<int>(at.y)) != 0) random.push_back(at);
      }
      out[name]["random"].push_back(quality_of(shape, lattice, random));
    }
  }
  return out;
}

Json train(int people, int inputs) {
  const planner::PixelSet shape = shape_where([](double x, double y) { return std::hypot(x, y) <= 38; });
  const planner::Lattice lattice(people, 1);
  const double begin = cpu_s();
  const auto places = planner::sodm({&shape, &lattice, inputs, 1, true, true});
  const double spent = cpu_s() - begin;
  return {{"people", people},
          {"inputs", std::max(inputs, 20 * people)},
          {"cpu_s", spent},
          {"quality", quality_of(shape, lattice, places)}};
}

Json steps(const Painted& one) {
  const tbb::global_control thread(tbb::global_control::max_allowed_parallelism, 1);
  double begin = cpu_s();
  const planner::PaintedScene scene = one.scene();
  const double read_s = cpu_s() - begin;
  const planner::MotionFloor floor(*scene.ways, one.section().motion->obstacles, one.show.tempo, Instant{});
  const planner::MotionTask task = task_of(one, scene, floor);
  begin = cpu_s();
  const planner::PaintedModel model(task, one.options(), scene);
  auto now = model.begin();
  auto next = now;
  const double prepared_s = cpu_s() - begin;
  begin = cpu_s();
  int done = 0;
  for (; model.step_s() * (done + 1) <= task.duration_s(); ++done) {
    next = now;
    ++next.tick;
    model.step(now, next);
    std::swap(now, next);
  }
  const double spent_s = cpu_s() - begin;
  return {{"people", task.people()}, {"read_cpu_s", read_s},   {"prepared_cpu_s", prepared_s},
          {"steps", done},           {"steps_cpu_s", spent_s}, {"steps_a_second", done / spent_s}};
}

}  // namespace
}  // namespace footlight

int main(int argc, char** argv) {
  using namespace footlight;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "--maps" && argc == 2) {
    std::cout << maps() << '\n';
  } else if (what == "--train" && argc == 4) {
    std::cout << train(std::atoi(argv[2]), std::atoi(argv[3])) << '\n';
  } else if (what == "--steps" && argc == 3) {
    std::cout << steps(Painted(argv[2])) << '\n';
  } else if (argc == 2 && what.find("--") != 0) {
    std::cout << follow(Painted(what)) << '\n';
  } else {
    fail("footlight_painted_raw SHOW | --maps | --train PEOPLE INPUTS | --steps SHOW");
  }
}
