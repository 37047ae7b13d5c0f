// SPDX-License-Identifier: Apache-2.0
#include "app/commission_steps.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commission/findings.hpp"
#include "app/commission/flash_sequence.hpp"
#include "app/commission/walk.hpp"
#include "app/commission/wipe_record.hpp"
#include "app/commission_report.hpp"
#include "app/state_folder.hpp"
#include "app/typed_lines.hpp"
#include "app/walk_file.hpp"
#include "config/nearest.hpp"
#include "config/quantity.hpp"

namespace footlight::app {
namespace {

constexpr Duration kSettle = milliseconds(30'000);
constexpr Duration kLampSettles = milliseconds(2000);
constexpr Duration kLook = milliseconds(50);
constexpr std::size_t kLampsOfASchedule = 256;  // the table of a schedule has a row of all lamps for each

/// Waits for a line and keeps the lamps alight meanwhile; virtual time stands.
std::optional<std::string> next_line(TypedLines& typed, Session& session, FloorLights& lights) {
  return typed.next([&] {
    if (lights.simulated() == nullptr) return lights.run_until(lights.now() + kLook);
    std::this_thread::sleep_for(kLook);
    return !session.stopped();
  });
}

/// Lamps of a walk, one alight at a time.
class WalkLights {
 public:
  WalkLights(FloorLights& lights, const Rig& rig, const Walk& walk) : lights_(lights), rig_(rig), walk_(walk) {}

  /// @return false when it was told to stop
  bool light(std::size_t position) {
    if (!loaded_ || position < first_ || position >= first_ + kLampsOfASchedule) {
      first_ = position / kLampsOfASchedule * kLampsOfASchedule;
      loaded_ = true;
      std::vector<LitLamps> switches(1);  // dark
      const std::size_t end = std::min(first_ + kLampsOfASchedule, walk_.order().size());
      for (std::size_t i = first_; i < end; ++i) switches.push_back({{}, {walk_.order()[i]}});
      lights_.load(lit_schedule(rig_, walk_.lamps(), lamp_white(rig_), switches));
      if (!lights_.settle(kSettle)) return false;
    }
    lights_.light(1 + position - first_, lights_.now() + lights_.notice());
    return lights_.run_until(lights_.now() + lights_.notice()) && lights_.settle(kLampSettles);
  }
  bool dark() {
    lights_.light(0, lights_.now() + lights_.notice());
    return lights_.run_until(lights_.now() + lights_.notice()) && lights_.settle(kLampSettles);
  }

 private:
  FloorLights& lights_;
  const Rig& rig_;
  const Walk& walk_;
  std::size_t first_ = 0;
  bool loaded_ = false;
};

/// Asks until the last lamp has its answer. @return true: it has; false: enough for now
Result<bool> ask_all(Session& session, Walk& walk, WalkFile& file, FloorLights& lights, WalkLights& lamps) {
  TypedLines typed;
  const Error interrupted{ErrorKind::interrupted, "interrupted"};
  while (!walk.finished()) {
    if (!lamps.light(walk.position())) return interrupted;
    while (true) {
      if (session.json) {
        session.note(walk.question());
      } else {
        session.print_now(walk.question());
      }
      const auto line = next_line(typed, session, lights);
      if (!line) return session.stopped() ? Result<bool>(interrupted) : Result<bool>(false);
      const auto said = walk.answer(*line);
      if (!said) {
        session.note(said.error().message);
        continue;
      }
      if (*said == Walk::Said::quit) return false;
      if (auto kept = file.add(walk.last_line()); !kept) return kept.error();
      break;
    }
  }
  return true;
}

/// "3, C" as row 3 and column C; nothing where it is neither.
std::optional<std::vector<std::string>> lines_of(const std::string& answer, const Grid& grid, bool rows) {
  std::vector<std::string> out;
  std::string text = answer;
  std::ranges::replace(text, ',', ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto cell = parse_cell(rows ? "A" + word : word + "1");
    if (!cell || !grid.contains(*cell)) return std::nullopt;
    const std::string name = cell_name(*cell);
    out.push_back(rows ? name.substr(1) : name.substr(0, name.size() - 1));
  }
  return out.empty() ? std::nullopt : std::optional(out);
}

/// One round of rows or of columns.
class Wipe {
 public:
  Wipe(const FloorToCommission& floor, bool rows) : floor_(floor), rows_(rows) {
    const Grid& grid = floor.loaded.show.stage.grid;
    lines_.resize(static_cast<std::size_t>(rows ? grid.rows() : grid.columns()));
    for (std::size_t i = 0; i < floor.lamps.size(); ++i) {
      if (!floor.lamps[i].cell) continue;
      const Cell cell = grid.cell(*floor.lamps[i].cell);
      lines_[static_cast<std::size_t>(rows ? cell.row : cell.column)].push_back(i);
    }
  }
  [[nodiscard]] const char* what() const { return rows_ ? "rows" : "columns"; }
  [[nodiscard]] std::size_t lines() const { return lines_.size(); }

  /// @return false when it was told to stop
  bool play(Session& session, FloorLights& lights, Duration step) const {
    std::vector<LitLamps> switches(1);
    for (const auto& line : lines_) switches.push_back({{}, line});
    lights.load(lit_schedule(floor_.loaded.rig, floor_.lamps, lamp_white(floor_.loaded.rig), switches));
    if (!lights.settle(kSettle)) return false;
    Instant at = lights.now() + step;
    for (std::size_t k = 1; k <= lines_.size() + 1; ++k, at += step) {
      lights.light(k <= lines_.size() ? k : 0, at);
      session.tell(what(), static_cast<double>(k) / static_cast<double>(lines_.size() + 1));
      if (!lights.run_until(at)) return false;
    }
    return lights.settle(step);
  }

  /// Asks until everybody is content, or knows which are not whole. @return nothing when there is nobody to ask
  std::optional<std::vector<std::string>> ask(Session& session, TypedLines& typed, FloorLights& lights,
                                              Duration step) const {
    while (true) {
      if (!play(session, lights, step)) return std::nullopt;
      session.clear_line();
      session.note(fmt::format("were all {} {} whole? Enter: yes; a: again; {}: these were not", lines_.size(), what(),
                               rows_ ? "numbers of rows" : "letters of columns"));
      while (true) {
        const auto line = next_line(typed, session, lights);
        if (!line) return std::nullopt;
        if (line->empty() || *line == "y") return std::vector<std::string>{};
        if (*line == "a") break;
        if (auto named = lines_of(*line, floor_.loaded.show.stage.grid, rows_)) return named;
        session.note(config::in_quotes(*line) +
                     (rows_ ? " are no rows of this stage (as 3 7)" : " are no columns of this stage (as C AA)"));
      }
    }
  }

 private:
  const FloorToCommission& floor_;
  bool rows_;
  std::vector<std::vector<std::size_t>> lines_;
};

Result<Duration> wipe_step(const StepChoice& steps, const Rig& rig, const FloorLights& lights) {
  const auto given = config::parse_quantity(steps.wipe_step, config::Dimension::time);
  if (!given.value || *given.value <= 0 || *given.value > 60) {
    return input_error(
        "--step: " + (given.value ? config::in_quotes(steps.wipe_step) + " is out of range" : given.text) +
        " (a time, as 700 ms, at most 60 s)");
  }
  const Duration shortest = shortest_step(rig, lights.drivers());
  return std::max(seconds(*given.value), shortest);
}

}  // namespace

int walk_lamps(Session& session, const CommissionChoice& choice, const StepChoice& steps) {
  const auto floor = read_floor(session, choice);
  if (!floor) return session.fail(floor.error());
  const Rig& rig = floor->loaded.rig;
  const Stage& stage = floor->loaded.show.stage;
  Walk walk(rig, stage, floor->lamps, steps.order == "bus" ? WalkOrder::bus : WalkOrder::floor);
  const std::string name = steps.session.empty() ? choice.output + ".walk" : steps.session;
  auto lights = light_floor(session, choice, rig);
  if (!lights) return session.fail(lights.error());
  WalkFile file;
  if (auto opened = file.open(name); !opened) return session.fail(opened.error());
  if (file.text().empty()) {
    if (auto begun = file.add(walk.head()); !begun) return session.fail(begun.error());
  } else {
    if (auto taken = walk.take_up(file.text(), name); !taken) return session.fail(taken.error());
    session.note(fmt::format("goes on after {} of {} lamps ({})", walk.position(), walk.order().size(), name));
  }
  if (!walk.finished()) {
    WalkLights lamps(**lights, rig, walk);
    const auto done = ask_all(session, walk, file, **lights, lamps);
    if (!done) return session.fail(done.error());
    (void)lamps.dark();
    if (!*done) {
      session.note(fmt::format("{} of {} lamps have their answers, in {}: the same command goes on", walk.position(),
                               walk.order().size(), name));
      return 0;
    }
  }
  if (auto written = write_rig(*floor, walk.seen(), choice.output); !written) return session.fail(written.error());
  const auto seen = walk.seen();
  const CommissionReport report{rig, stage, floor->lamps, seen, compare(rig, floor->lamps, seen), choice.output};
  session.print(session.json ? commission_json(report, nullptr) : commission_text(report, nullptr));
  return 0;
}

int wipe_floor(Session& session, const CommissionChoice& choice, const StepChoice& steps) {
  const auto floor = read_floor(session, choice);
  if (!floor) return session.fail(floor.error());
  auto lights = light_floor(session, choice, floor->loaded.rig);
  if (!lights) return session.fail(lights.error());
  const auto step = wipe_step(steps, floor->loaded.rig, **lights);
  if (!step) return session.fail(step.error());
  TypedLines typed;
  nlohmann::ordered_json wrong{{"rows", nlohmann::ordered_json::array()}, {"columns", nlohmann::ordered_json::array()}};
  std::vector<std::string> told;
  for (const bool rows : {true, false}) {
    const Wipe wipe(*floor, rows);
    const auto named = wipe.ask(session, typed, **lights, *step);
    if (!named && session.stopped()) return session.fail(Error{ErrorKind::interrupted, "interrupted"});
    if (!named) return session.fail(input_error("stdin is closed: nobody says whether the floor was whole"));
    for (const std::string& line : *named) {
      wrong[wipe.what()].push_back(line);
      told.push_back((rows ? "row " : "column ") + line);
    }
  }
  const bool kept = told.empty() && !choice.simulated;
  if (kept) {
    auto recorded = record_wipe(state_folder(choice.state), choice.show, floor->loaded.rig);
    if (!recorded) return session.fail(recorded.error());
  }
  if (session.json) {
    wrong["whole"] = told.empty();
    wrong["kept"] = kept;
    session.print(wrong.dump(2));
  } else if (told.empty()) {
    session.print(kept ? "all rows and columns are whole; kept with the rig as it is"
                       : "all rows and columns are whole; not kept, for the lamps were simulated");
  }
  if (told.empty()) return 0;
  return session.fail(device_error(
      fmt::format("not whole: {} (footlight commission gray or walk finds which lamps)", fmt::join(told, ", "))));
}

}  // namespace footlight::app
