// SPDX-License-Identifier: Apache-2.0
// Whole shows from shows/, planned by the library; reading and decoding are timed apart.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <tbb/global_control.h>

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
/// formations as images, half a minute of walking between them.
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
    section.start_count = 1 + 68.0 * f;
    section.hold_counts = 8;
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

}  // namespace

void register_shows(const Effort& effort) {
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
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
