// SPDX-License-Identifier: Apache-2.0
#include "app/commission_command.hpp"

#include <charconv>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commission/film_reading.hpp"
#include "app/commission/findings.hpp"
#include "app/commission/flash_sequence.hpp"
#include "app/commission/floor_fit.hpp"
#include "app/commission_report.hpp"
#include "app/commission_steps.hpp"
#include "app/commissioning.hpp"
#include "app/typed_lines.hpp"
#include "config/lamp_film.hpp"
#include "config/nearest.hpp"
#include "config/quantity.hpp"

namespace footlight::app {
namespace {

constexpr Duration kSettle = milliseconds(30'000);
constexpr Duration kLook = milliseconds(50);
constexpr double kRadiusOfCells = 0.1;  // of a lamp's light, in cells if the floor is as wide as the picture
constexpr double kSmallestRadius = 0.0008;
constexpr double kLargestRadius = 0.002;

struct Options {
  CommissionChoice choice;
  StepChoice steps;
  std::string film;
  std::string step;
  std::string from;
  std::vector<std::string> corners;
  bool go = false;
};

FlashSequence sequence_of(const FloorToCommission& floor) {
  return FlashSequence(LampCode(floor.lamps.size(), wiring_tag(floor.loaded.rig)));
}

/// The step that was asked for, or the shortest.
Result<Duration> step_of(const Options& options, Duration shortest) {
  if (options.step.empty()) return shortest;
  const auto given = config::parse_quantity(options.step, config::Dimension::time);
  if (!given.value || *given.value <= 0 || *given.value > 10) {
    return input_error("--step: " + (given.value ? config::in_quotes(options.step) + " is out of range" : given.text) +
                       " (a time, as 400 ms, at most 10 s)");
  }
  if (seconds(*given.value) < shortest) {
    return input_error(
        fmt::format("--step {}: the buses and a film need {:g} ms", options.step, to_seconds(shortest) * 1e3));
  }
  return seconds(*given.value);
}

// ---- playing it

std::string played_text(const Session& session, const Options& options, const FloorToCommission& floor,
                        const FlashSequence& sequence, Duration step, std::size_t silent) {
  const double length_s = sequence.steps() * to_seconds(step);
  if (session.json) {
    return nlohmann::ordered_json{{"lamps", floor.lamps.size()},
                                  {"bits", sequence.code().bits()},
                                  {"step_s", to_seconds(step)},
                                  {"length_s", length_s},
                                  {"unconfirmed", silent}}
        .dump(2);
  }
  return fmt::format(
      "{} lamps have flashed their words of {} bits in {:.1f} s, {:g} ms a step\n"
      "footlight commission gray {} --film FILM{} -o RIG.yaml\n",
      floor.lamps.size(), sequence.code().bits(), length_s, to_seconds(step) * 1e3, options.choice.show,
      options.step.empty() ? "" : " --step \"" + options.step + "\"");
}

int play_gray(Session& session, const Options& options, const FloorToCommission& floor) {
  auto opened = light_floor(session, options.choice, floor.loaded.rig);
  if (!opened) return session.fail(opened.error());
  FloorLights& lights = **opened;
  const FlashSequence sequence = sequence_of(floor);
  const auto step = step_of(options, shortest_step(floor.loaded.rig, lights.drivers()));
  if (!step) return session.fail(step.error());
  const Error interrupted{ErrorKind::interrupted, "interrupted"};
  lights.load(flash_schedule(floor.loaded.rig, floor.lamps, sequence, *step, lamp_white(floor.loaded.rig)));
  if (!lights.settle(kSettle)) return session.fail(interrupted);
  for (const std::string& trouble : lights.troubles()) session.note(trouble);
  const std::size_t silent = lights.unconfirmed();
  if (silent > 0) session.note(fmt::format("{} nodes do not say that they are dark: are they there?", silent));
  if (!options.go && !options.choice.simulated) {
    session.note(fmt::format("film the whole floor, the hall dark, the exposure fixed; {:.0f} s. Enter starts",
                             sequence.steps() * to_seconds(*step)));
    TypedLines typed;
    const auto line = typed.next([&] { return lights.run_until(lights.now() + kLook); });
    if (!line && !session.stopped()) session.note("stdin is closed: it starts at once");
  }
  const Instant begin = lights.now() + *step;
  for (std::size_t part = 1; part < sequence.parts().size(); ++part) {
    const Instant at = begin + sequence.parts()[part].begins * *step;
    lights.light(part, at);
    session.tell("flashing", static_cast<double>(part) / static_cast<double>(sequence.parts().size()));
    if (!lights.run_until(at)) return session.fail(interrupted);
  }
  if (!lights.settle(2 * *step)) return session.fail(interrupted);
  session.clear_line();
  session.print(played_text(session, options, floor, sequence, *step, lights.unconfirmed()));
  if (lights.unconfirmed() == 0) return 0;
  return session.fail(device_error(fmt::format(
      "{} nodes did not confirm what they were told: their lamps may be missing in the film", lights.unconfirmed())));
}

// ---- reading a film of it

Result<FitChoice> fit_choice(const Options& options) {
  FitChoice out;
  for (const Viewpoint from :
       {Viewpoint::audience, Viewpoint::stage_left, Viewpoint::upstage, Viewpoint::stage_right}) {
    if (options.from == to_text(from)) out.from = from;
  }
  if (!options.from.empty() && !out.from) {
    return input_error("--from: " + config::in_quotes(options.from) +
                       " is no side of the stage (audience, stage-left, upstage, stage-right)");
  }
  if (options.corners.empty()) return out;
  const Error wrong =
      input_error("--corners: " + config::in_quotes(fmt::format("{}", fmt::join(options.corners, " "))) +
                  " are not four places in pixels (as 102,655 1180,640 870,90 410,95)");
  if (options.corners.size() != 4) return wrong;
  std::array<Point, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string& text = options.corners[i];
    const char* const end = text.data() + text.size();
    const auto x = std::from_chars(text.data(), end, corners[i].x);
    if (x.ec != std::errc{} || x.ptr == end || *x.ptr != ',') return wrong;
    const auto y = std::from_chars(x.ptr + 1, end, corners[i].y);
    if (y.ec != std::errc{} || y.ptr != end) return wrong;
  }
  out.corners = corners;
  return out;
}

Result<Duration> step_of_simulated(const Options& options, const FloorToCommission& floor) {
  const auto lights = FloorLights::open(floor.loaded.rig, {.simulated = true, .faults = {}, .seed = 1}, nullptr);
  if (!lights) return lights.error();
  return step_of(options, shortest_step(floor.loaded.rig, (*lights)->drivers()));
}

int read_gray(Session& session, const Options& options, const FloorToCommission& floor) {
  const auto choice = fit_choice(options);
  if (!choice) return session.fail(choice.error());
  const auto step = step_of_simulated(options, floor);
  if (!step) return session.fail(step.error());
  const Stage& stage = floor.loaded.show.stage;
  const double cells = std::max(stage.grid.columns(), stage.grid.rows());
  const config::SpotSearch search{std::clamp(kRadiusOfCells / cells, kSmallestRadius, kLargestRadius),
                                  std::min<int>(65'536, 3 * static_cast<int>(floor.lamps.size()) + 256)};
  session.tell("reading the film", 0);
  const auto film = config::decode_lamps(options.film, search, {}, session.stop());
  session.clear_line();
  if (!film) return session.fail(film.error());
  const auto reading = read_flashes(*film, sequence_of(floor), to_seconds(*step), options.film);
  if (!reading) return session.fail(reading.error());
  const auto fit = fit_floor(*reading, floor.lamps, stage, *choice);
  if (!fit) return session.fail(fit.error());
  const SeenPlaces places = places_of(*reading, *fit, floor.lamps.size());
  const CommissionReport report{floor.loaded.rig,
                                stage,
                                floor.lamps,
                                places.cell,
                                compare(floor.loaded.rig, floor.lamps, places.cell, places.unread),
                                options.choice.output};
  if (!options.choice.output.empty()) {
    if (auto written = write_rig(floor, places.cell, options.choice.output); !written) {
      return session.fail(written.error());
    }
  }
  const FilmReport of_film{*film, *reading, *fit, places};
  session.print(session.json ? commission_json(report, &of_film) : commission_text(report, &of_film));
  return 0;
}

int gray(Session& session, const Options& options) {
  if (options.film.empty() && !options.choice.output.empty()) {
    return session.fail(input_error("-o: a rig is written from a film (--film FILM)"));
  }
  const auto floor = read_floor(session, options.choice);
  if (!floor) return session.fail(floor.error());
  return options.film.empty() ? play_gray(session, options, *floor) : read_gray(session, options, *floor);
}

// ---- the command line

using Work = int (*)(Session&, const Options&);

CLI::App* add_work(CLI::App& parent, Session& session, Chosen& chosen, const std::shared_ptr<Options>& options,
                   const char* name, const char* what, Work work) {
  CLI::App* command = parent.add_subcommand(name, what);
  command->add_option("SHOW", options->choice.show, "show file (YAML)")->required();
  command->add_flag("--sim", options->choice.simulated, "on simulated lamps, in virtual time, whatever the URLs say");
  command->add_option("--faults", options->choice.faults, "with --sim: what goes wrong, as loss=5%,dead=1");
  command->add_option("--seed", options->choice.seed, "with --sim: what happens by chance depends on this number");
  command->add_option("--transport-map", options->choice.transports,
                      "YAML file: where buses are here and today, instead of where the rig says");
  session.add_options(*command, true);
  command->callback(
      [&session, &chosen, options, work] { chosen = [&session, options, work] { return work(session, *options); }; });
  return command;
}

}  // namespace

void add_commission_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* parent = program.add_subcommand("commission", "Which lamp is on which cell: by walk, film or wipes");
  parent->require_subcommand(1);
  auto options = std::make_shared<Options>();

  CLI::App* command =
      add_work(*parent, session, chosen, options, "walk", "Light lamp after lamp; somebody says where each is",
               [](Session& s, const Options& o) { return walk_lamps(s, o.choice, o.steps); });
  command->add_option("-o,--output", options->choice.output, "rig file to write; must not be there")->required();
  command->add_option("--order", options->steps.order, "floor: row by row, there and back; bus: along the cables")
      ->check(CLI::IsMember({"floor", "bus"}))
      ->capture_default_str();
  command->add_option("--session", options->steps.session, "file of the answers so far (default: OUTPUT.walk)");
  command->footer(
      "Enter: it shines where it should. A cell, as B4: it shines there. d: dead. b: back. q: stop; every answer is "
      "on\n"
      "the disk before the next lamp is lit, and the same command goes on where it was.\n\n"
      "Example:\n  footlight commission walk my-show/show.yaml -o my-show/rig-2.yaml\n");

  command = add_work(*parent, session, chosen, options, "gray", "Flash every lamp's number; read a film of it", gray);
  command->add_option("--film", options->film, "film of the floor while it flashed: read it");
  command->add_option("-o,--output", options->choice.output, "with --film: rig file to write; must not be there");
  command->add_option("--step", options->step, "time of a step, as 500 ms; the film is read with the same")
      ->default_str("400 ms, more where the buses need it");
  command->add_option("--from", options->from, "where the film was taken: audience, stage-left, upstage, stage-right")
      ->default_str("as the rig tells, else audience");
  command
      ->add_option("--corners", options->corners,
                   "where the corners are in the picture, in pixels: A1, the last cell of row 1, the last of all, the "
                   "last of column A")
      ->expected(1, 8);
  command->add_flag("--go", options->go, "flash at once, without Enter");
  command->footer(
      "Film the whole floor with a telephone that lies or is held still, the hall dark, the exposure fixed, from "
      "before\n"
      "the first flash until after the last one.\n\n"
      "Examples:\n  footlight commission gray show.yaml\n"
      "  footlight commission gray show.yaml --film phone.mp4 -o rig-2.yaml\n");

  command =
      add_work(*parent, session, chosen, options, "wipes", "Light rows, then columns; somebody says if all is whole",
               [](Session& s, const Options& o) { return wipe_floor(s, o.choice, o.steps); });
  command->add_option("--step", options->steps.wipe_step, "time of a row or a column")->capture_default_str();
  command->add_option("--state", options->choice.state, "folder where it is kept that the wipes were whole")
      ->default_str("~/.local/state/footlight");
  command->footer(
      "After every change of the rig. Enter: all of them were whole. a: again. Numbers of rows, letters of columns: "
      "those\n"
      "were not. When all are, it is kept; run, dryrun and devices list tell when the rig has changed since.\n\n"
      "Example:\n  footlight commission wipes my-show/show.yaml\n");
}

}  // namespace footlight::app
