// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/commission/film_reading.hpp"
#include "app/commission/flash_sequence.hpp"
#include "app/commission/floor_fit.hpp"
#include "app/commission/floor_lights.hpp"
#include "app/commission/lamps.hpp"
#include "tests/support/phone.hpp"

namespace footlight::tests {

/// When each lamp shone, as the simulated nodes had it.
class Shining {
 public:
  explicit Shining(std::size_t lamps) : changes_(lamps) {}
  void note(std::size_t lamp, double at_s, bool lit) {
    auto& changes = changes_[lamp];
    if ((changes.empty() ? false : changes.back().second) != lit) changes.emplace_back(at_s, lit);
  }
  [[nodiscard]] double at(std::size_t lamp, double at_s) const {
    const auto& changes = changes_[lamp];
    const auto after = std::ranges::upper_bound(changes, at_s, {}, &std::pair<double, bool>::first);
    return after != changes.begin() && std::prev(after)->second ? 1 : 0;
  }

 private:
  std::vector<std::vector<std::pair<double, bool>>> changes_;
};

/// A floor that flashes its lamps: the real drivers on simulated buses in virtual time decide what each lamp shows.
class FilmedFloor {
 public:
  /// @param rig what the rig file says  @param really where the lamps are, by lamp; dead ones shine nowhere
  FilmedFloor(const Rig& rig, const Grid& grid, std::vector<CellIndex> really, std::set<std::size_t> dead = {})
      : rig_(rig),
        grid_(grid),
        lamps_(app::lamps_of(rig)),
        really_(std::move(really)),
        dead_(std::move(dead)),
        sequence_(app::LampCode(lamps_.size(), app::wiring_tag(rig))),
        shining_(lamps_.size()) {
    play();
  }

  [[nodiscard]] const std::vector<app::FloorLamp>& lamps() const { return lamps_; }
  [[nodiscard]] const app::FlashSequence& sequence() const { return sequence_; }
  [[nodiscard]] double step_s() const { return to_seconds(step_); }
  [[nodiscard]] double length_s() const { return step_s() * sequence_.steps(); }
  [[nodiscard]] double lit(std::size_t lamp, double at_s) const {
    return dead_.contains(lamp) ? 0 : shining_.at(lamp, at_s);
  }
  [[nodiscard]] config::LampFilm film(const PhoneChoice& choice, double radius_px = 1.3) const {
    Phone phone(choice, grid_, really_);
    return phone.spots(
        length_s(), [this](std::size_t lamp, double at_s) { return lit(lamp, at_s); }, radius_px);
  }
  [[nodiscard]] Result<app::FilmReading> read(const PhoneChoice& choice, double radius_px = 1.3) const {
    return app::read_flashes(film(choice, radius_px), sequence_, step_s(), "film.mp4");
  }
  [[nodiscard]] Stage stage() const {
    Stage out;
    out.grid = grid_;
    return out;
  }
  [[nodiscard]] const std::vector<CellIndex>& really() const { return really_; }
  [[nodiscard]] const std::set<std::size_t>& dead() const { return dead_; }

 private:
  void play() {
    auto opened = app::FloorLights::open(rig_, {.simulated = true, .faults = {}, .seed = 1}, nullptr);
    ASSERT_TRUE(opened) << opened.error().message;
    app::FloorLights& lights = **opened;
    step_ = app::shortest_step(rig_, lights.drivers());
    lights.load(app::flash_schedule(rig_, lamps_, sequence_, step_, app::lamp_white(rig_)));
    ASSERT_TRUE(lights.settle(seconds(20)));
    const Instant begin = lights.now() + step_;
    const auto look = [&](Instant now) {
      for (std::size_t i = 0; i < lamps_.size(); ++i) {
        const auto [node, channel] = lamps_[i].place;
        shining_.note(i, to_seconds(now - begin),
                      lights.simulated()->lamp(node, channel).brightness > 0 &&
                          lights.simulated()->lamp(node, channel).colour.red > 0);
      }
    };
    for (std::size_t part = 1; part < sequence_.parts().size(); ++part) {
      const Instant at = begin + sequence_.parts()[part].begins * step_;
      lights.light(part, at);
      for (Instant t = lights.now(); t < at; t += milliseconds(5)) {
        ASSERT_TRUE(lights.run_until(std::min(at, t + milliseconds(5))));
        look(lights.now());
      }
    }
  }

  Rig rig_;
  Grid grid_;
  std::vector<app::FloorLamp> lamps_;
  std::vector<CellIndex> really_;
  std::set<std::size_t> dead_;
  app::FlashSequence sequence_;
  Duration step_{};
  Shining shining_;
};

/// Cells of the rig, by lamp.
inline std::vector<CellIndex> cells_of(const Rig& rig) {
  std::vector<CellIndex> out;
  for (const app::FloorLamp& lamp : app::lamps_of(rig)) out.push_back(lamp.cell.value());
  return out;
}

}  // namespace footlight::tests
