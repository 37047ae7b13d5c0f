// SPDX-License-Identifier: Apache-2.0
//
// footlight_film_table: how many lamps of a floor are read from films of different quality. Prints the table of
// docs/commissioning.md.
#include <cstdio>

#include "app/commission/findings.hpp"
#include "tests/app/commission/filmed_floor.hpp"
#include "tests/support/small_show.hpp"

namespace footlight {
namespace {

struct Level {
  const char* what;
  double noise;
  double light;
  double shake_px;
  double reflection;
};

constexpr Level kLevels[] = {
    {"quiet", 2, 140, 0, 0},
    {"grainy", 8, 140, 0, 0},
    {"held by hand", 4, 140, 8, 0},
    {"glossy floor", 4, 140, 3, 0.5},
    {"weak lamps", 8, 60, 3, 0},
    {"very weak lamps", 8, 40, 3, 0},
    {"as weak as the grain", 10, 30, 3, 0},
};

void measure(const Rig& rig, const Grid& grid) {
  // Every seventh lamp is exchanged with its neighbour, one is dead.
  auto really = tests::cells_of(rig);
  for (std::size_t i = 0; i + 1 < really.size(); i += 7) std::swap(really[i], really[i + 1]);
  const tests::FilmedFloor floor(rig, grid, really, {100});
  for (const Level& level : kLevels) {
    tests::PhoneChoice choice;
    choice.width = 640;
    choice.height = 360;
    choice.fps = 25;
    choice.noise = level.noise;
    choice.light = level.light;
    choice.shake_px = level.shake_px;
    choice.reflection = level.reflection;
    std::size_t right = 0;
    std::size_t wrong = 0;
    double fit = 0;
    if (const auto reading = floor.read(choice)) {
      fit = reading->timing.fit;
      if (const auto view = app::fit_floor(*reading, floor.lamps(), floor.stage(), {})) {
        const auto places = app::places_of(*reading, *view, floor.lamps().size());
        for (std::size_t i = 0; i < really.size(); ++i) {
          if (!places.cell[i]) continue;
          (*places.cell[i] == really[i] && i != 100 ? right : wrong) += 1;
        }
      }
    }
    std::printf("| %s | %g | %g | %g | %g | %.2f | %zu of %zu | %zu |\n", level.what, level.noise, level.light,
                level.shake_px, level.reflection, fit, right, really.size() - 1, wrong);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace footlight

int main() {
  using footlight::BusKind;
  const auto grid = footlight::Grid::make(footlight::GridKind::square, 18, 12, 1).value();
  const auto rig = footlight::tests::lamps_everywhere(grid, {BusKind::can, BusKind::serial}, 115'200, 18);
  std::printf(
      "| film | noise | light | shake px | reflection | fit | lamps in the right place | in a wrong one |\n"
      "|---|---|---|---|---|---|---|---|\n");
  footlight::measure(rig, grid);
  return 0;
}
