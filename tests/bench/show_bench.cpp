// SPDX-License-Identifier: Apache-2.0
// Whole shows from shows/, planned by the library; reading and decoding are timed apart.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <tbb/global_control.h>

#include "app/reset_way.hpp"
#include "config/media.hpp"
#include "config/show_file.hpp"
#include "planner/plan_show.hpp"
#include "planner/validate.hpp"
#include "tests/bench/instances.hpp"
#include "tests/bench/job.hpp"

namespace footlight::bench {
namespace {

struct DecodedShow {
  Show show;
  std::vector<std::optional<Film>> films;
};

std::optional<DecodedShow> decode(const std::string& name) {
  auto loaded = config::load_show(std::string(FOOTLIGHT_SHOWS) + "/" + name + "/show.yaml");
  if (!loaded) return std::nullopt;
  DecodedShow out{std::move(loaded->show), {}};
  std::vector<std::optional<config::FilmLength>> lengths;
  for (const Section& section : out.show.sections) {
    std::optional<Film> film;
    if (!std::holds_alternative<CellsSource>(section.from)) {
      const auto* video = std::get_if<VideoSource>(&section.from);
      auto decoded =
          video != nullptr ? config::decode_video(*video) : config::decode_image(std::get<ImageSource>(section.from));
      if (!decoded) return std::nullopt;
      film = std::move(decoded).value();
    }
    lengths.push_back(film ? std::optional<config::FilmLength>({static_cast<int>(film->frames.size()), film->fps})
                           : std::nullopt);
    out.films.push_back(std::move(film));
  }
  if (!config::settle_film_lengths(out.show, lengths)) return std::nullopt;
  return out;
}

void decode_show(benchmark::State& state, const std::string& show) {
  std::optional<DecodedShow> decoded;
  for (auto _ : state) decoded = decode(show);
  if (!decoded) return state.SkipWithError("the show cannot be read");
  state.counters["people"] = static_cast<double>(decoded->show.performers.size());
}

/// A hundred thousand people in a block of 400 x 300 cells with a flower cut out, which goes around and turns: twenty
/// formations as images, 96 s of walking between them. People are matched all at once, so that nobody's way is
/// longer than it must be.
DecodedShow stadium() {
  constexpr int kColumns = 400;
  constexpr int kRows = 300;
  constexpr std::size_t kPeople = 100'000;
  DecodedShow out;
  out.show.file = "stadium";
  out.show.title = "stadium";
  out.show.stage.grid = *Grid::make(GridKind::square, kColumns, kRows, 1.0);
  for (std::size_t p = 1; p <= kPeople; ++p) {
    Performer performer;
    performer.id = performer.name = std::to_string(p);
    out.show.performers.push_back(performer);
  }
  for (int f = 0; f < 20; ++f) {
    Mask mask(2 * kColumns, 2 * kRows);
    const double turn = 0.314159 * f;
    // Sixteen thousand cells are cut out: four thousand more are left than there are people.
    const double petals_px = 480;
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        const double dx = x - mask.width() / 2.0 - 200 * std::cos(turn);
        const double dy = y - mask.height() / 2.0 - 100 * std::sin(turn);
        if (outside_of_flower(dx / petals_px, dy / petals_px, turn) >= 1) mask.set(x, y);
      }
    }
    Section section;
    section.name = "formation" + std::to_string(f + 1);
    section.from = ImageSource{section.name, {Fit::contain, {}, {}}};
    section.start_count = 1 + 200.0 * f;
    section.hold_counts = 8;
    section.planner.model = PlannerModel::flat;
    section.planner.cost = PairingCost::squared;
    out.show.sections.push_back(section);
    out.films.emplace_back(Film{mask.width(), mask.height(), 0, 0, 128, false, {mask}});
  }
  return out;
}

void plan_whole(benchmark::State& state, const std::string& show, int threads) {
  const auto decoded = show == "stadium" ? std::optional(stadium()) : decode(show);
  if (!decoded) return state.SkipWithError("the show cannot be read");
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::optional<Result<planner::Planned>> planned;
  // Planning a show twice only for its memory would double the run.
  for (auto _ : state) {
    state.counters["mb"] = peak_memory_mb([&] { planned = planner::plan_show(decoded->show, decoded->films); });
  }
  if (!*planned) return state.SkipWithError("the show cannot be planned");
  if ((*planned)->plan.formations.empty()) return state.SkipWithError("nothing was planned");
  if (!planner::validate((*planned)->plan).valid()) state.SkipWithError("the plan is not valid");
  state.counters["people"] = static_cast<double>(decoded->show.performers.size());
  state.counters["formations"] = static_cast<double>((*planned)->plan.formations.size());
}

/// The formation of a section of one image with one place moved by hand: from the topmost of its cells to a free one
/// above it.
std::optional<Override> moved_by_hand(const Plan& plan, SectionIndex section) {
  for (const Formation& formation : plan.formations) {
    if (formation.section != section) continue;
    const Grid& grid = plan.stage.grid;
    std::vector<CellIndex> taken = formation.cells;
    std::sort(taken.begin(), taken.end());
    const auto is_free = [&](CellIndex cell) {
      return !std::binary_search(taken.begin(), taken.end(), cell) &&
             !std::binary_search(plan.stage.reserve.begin(), plan.stage.reserve.end(), cell);
    };
    for (auto from = taken.rbegin(); from != taken.rend(); ++from) {
      if (std::binary_search(plan.stage.reserve.begin(), plan.stage.reserve.end(), *from)) continue;
      for (const CellIndex to : grid.neighbours(*from)) {
        if (!is_free(to)) continue;
        Override change;
        change.count = formation.count;
        change.move = {{*from, to, {}}};
        return change;
      }
    }
  }
  return std::nullopt;
}

/// One place of one formation of the ceremony is changed by hand, and the show planned again with what is kept.
void replan(benchmark::State& state, SectionIndex section, std::size_t most_anew) {
  auto decoded = decode("ceremony");
  if (!decoded) return state.SkipWithError("the show cannot be read");
  planner::Reuse reuse;
  planner::Stages stages;
  reuse.stages = &stages;
  for (const Section& one : decoded->show.sections) reuse.film_ids.push_back(one.name);
  const auto before = planner::plan_show(decoded->show, decoded->films, {}, reuse);
  if (!before) return state.SkipWithError("the show cannot be planned");
  const auto kept = stages.all();
  std::vector<std::pair<planner::StageKey, std::string>> first;
  for (const auto& [key, value] : kept) first.emplace_back(key, value);
  const auto change = moved_by_hand(before->plan, section);
  if (!change) return state.SkipWithError("no place can be moved");
  decoded->show.sections[section.at()].overrides = {*change};
  std::optional<Result<planner::Planned>> planned;
  for (auto _ : state) {
    state.PauseTiming();
    planner::Stages again;
    for (const auto& [key, value] : first) again.load(key, value);
    reuse.stages = &again;
    state.ResumeTiming();
    planned = planner::plan_show(decoded->show, std::vector<std::optional<Film>>(decoded->films.size()), {}, reuse);
  }
  if (!*planned || !(*planned)->plan.valid) return state.SkipWithError("the changed show cannot be planned");
  state.counters["anew"] = static_cast<double>((*planned)->facts.anew);
  if ((*planned)->facts.anew > most_anew) state.SkipWithError("more was planned again than depends on the change");
  state.counters["people"] = static_cast<double>(decoded->show.performers.size());
}

/// Somebody of the ceremony does not come: whoever changes least takes her way.
void repair(benchmark::State& state) {
  auto decoded = decode("ceremony");
  if (!decoded) return state.SkipWithError("the show cannot be read");
  planner::Reuse reuse;
  planner::Stages stages;
  reuse.stages = &stages;
  for (const Section& one : decoded->show.sections) reuse.film_ids.push_back(one.name);
  const auto before = planner::plan_show(decoded->show, decoded->films, {}, reuse);
  if (!before) return state.SkipWithError("the show cannot be planned");
  std::vector<std::pair<planner::StageKey, std::string>> first;
  for (const auto& [key, value] : stages.all()) first.emplace_back(key, value);
  decoded->show.performers[6].absent = true;
  std::optional<Result<planner::Planned>> planned;
  for (auto _ : state) {
    state.PauseTiming();
    planner::Stages again;
    for (const auto& [key, value] : first) again.load(key, value);
    reuse.stages = &again;
    state.ResumeTiming();
    planned = planner::plan_show(decoded->show, std::vector<std::optional<Film>>(decoded->films.size()), {}, reuse);
  }
  if (!*planned || !(*planned)->plan.valid) return state.SkipWithError("the repaired show cannot be planned");
  const Plan& after = (*planned)->plan;
  std::size_t changed = 0;
  for (std::size_t p = 0, q = 0; p < before->plan.performers.size(); ++p) {
    if (q < after.performers.size() && after.performers[q] == before->plan.performers[p]) {
      changed += after.tracks[q++] != before->plan.tracks[p] ? 1 : 0;
    }
  }
  if (changed != 1) state.SkipWithError("somebody else changes than who takes the way");
  state.counters["people"] = static_cast<double>(decoded->show.performers.size());
}

/// Everybody of the ceremony goes back, from the last formation of a section to the first of the one before.
void reset_way(benchmark::State& state) {
  const auto decoded = decode("ceremony");
  if (!decoded) return state.SkipWithError("the show cannot be read");
  const auto planned = planner::plan_show(decoded->show, decoded->films);
  if (!planned || !planned->plan.valid) return state.SkipWithError("the show cannot be planned");
  const Plan& plan = planned->plan;
  const std::size_t last = plan.sections.size() / 2;
  const std::atomic<bool> goes_on{false};
  std::optional<Result<Plan>> way;
  for (auto _ : state) {
    way = app::plan_reset_way(decoded->show, plan, plan.sections[last].end, plan.sections[last - 1].start, 4, goes_on);
  }
  if (!*way || !planner::validate(**way).valid()) return state.SkipWithError("no way was found");
  state.counters["people"] = static_cast<double>((*way)->performers.size());
}

}  // namespace

void register_shows(const Effort& effort) {
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  // An image's two transitions, and the one before, whose lateness looks into them; a film's to its end, since what it
  // gives way at one formation is missing at the next.
  for (const auto& [name, section, most] : {std::tuple{"image", 4U, std::size_t{4}}, {"film", 2U, std::size_t{40}}}) {
    benchmark::RegisterBenchmark(
        job_name("ours", std::string("replan ceremony, ") + name, 0).c_str(),
        [=, s = section, m = most](benchmark::State& state) { replan(state, SectionIndex(s), m); })
        ->Iterations(1)
        ->Repetitions(3)
        ->MeasureProcessCPUTime();
  }
  using Job = std::pair<const char*, void (*)(benchmark::State&)>;
  for (const auto& [name, job] : {Job{"repair ceremony", repair}, Job{"reset way ceremony", reset_way}}) {
    benchmark::RegisterBenchmark(job_name("ours", name, 0).c_str(), job)
        ->Iterations(1)
        ->Repetitions(3)
        ->MeasureProcessCPUTime();
  }
  for (const std::string show : {"vine", "ceremony", "stadium"}) {
    if (effort.quick && show == "stadium") continue;
    const int repetitions = (effort.quick && show == "ceremony") || show == "stadium" ? 1 : 3;
    if (show != "stadium") {
      benchmark::RegisterBenchmark(job_name("ours", "decode " + show, 0).c_str(),
                                   [=](benchmark::State& state) { decode_show(state, show); })
          ->Iterations(1)
          ->Repetitions(repetitions);
    }
    const bool on_all_cores_only = effort.quick || cores == 1 || show == "stadium";
    for (const int threads : on_all_cores_only ? std::vector{cores} : std::vector{1, cores}) {
      const std::string name = job_name("ours", "show " + show + " " + std::to_string(threads) + " threads", 0);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { plan_whole(state, show, threads); })
          ->Iterations(1)
          ->Repetitions(repetitions)
          ->MeasureProcessCPUTime();
    }
  }
}

}  // namespace footlight::bench
