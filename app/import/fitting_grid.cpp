// SPDX-License-Identifier: Apache-2.0
#include "app/import/fitting_grid.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

namespace footlight::app {
namespace {

constexpr double kExact_m = 1e-6;  // what other programs' sums of doubles are off
constexpr int kMargin = 2;         // cells

/// The largest number of which all are multiples, to kExact_m; 0 when it is smaller than kFinestPitch_m.
double common_measure(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double out = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    double a = values[i] - values[i - 1];
    if (a <= 2 * kExact_m) continue;
    double b = out;
    while (b > 2 * kExact_m) {
      double rest = std::fmod(a, b);
      if (b - rest <= 2 * kExact_m) rest = 0;
      a = b;
      b = rest;
    }
    out = a;
    if (out < kFinestPitch_m) return 0;
  }
  // As somebody would have written it: sums of doubles do not come back exactly.
  return std::round(out * 1e6) / 1e6;
}

double off(double value, double phase, double pitch) {
  const double rest = value - phase;
  return std::abs(rest - std::round(rest / pitch) * pitch);
}

struct Axis {
  double low = 0;
  double high = 0;
  std::vector<double> values;
};

Axis axis_of(const std::vector<ImportedPlace>& places, double Point::*coordinate) {
  Axis out;
  for (const ImportedPlace& place : places) out.values.push_back(place.at.*coordinate);
  std::sort(out.values.begin(), out.values.end());
  out.values.erase(std::unique(out.values.begin(), out.values.end()), out.values.end());
  out.low = out.values.front();
  out.high = out.values.back();
  return out;
}

double worst(const Axis& axis, double phase, double pitch) {
  double out = 0;
  for (const double value : axis.values) out = std::max(out, off(value, phase, pitch));
  return out;
}

/// Where the middles of cells lie: x at whole (phase 0) or half pitches, y at half ones.
struct Fit {
  double pitch_m = 0;
  double x_phase = 0;
  double x_shift = 0;
  double y_shift = 0;
  double worst_m = 0;
};

/// The best of what needs no shift, but by whole pitches where people stand in front of the stage's edge.
Fit unshifted(const Axis& x, const Axis& y, double pitch) {
  Fit out{pitch, 0, 0, 0, 0};
  const double whole = worst(x, 0, pitch);
  const double half = worst(x, pitch / 2, pitch);
  out.x_phase = half < whole ? pitch / 2 : 0;
  out.worst_m = std::max(std::min(whole, half), worst(y, pitch / 2, pitch));
  if (y.low < 0) out.y_shift = std::ceil(-y.low / pitch) * pitch;
  return out;
}

/// Shifted so that the first places are cells.
Fit shifted(const Axis& x, const Axis& y, double pitch) {
  const double x_rest = x.low - std::round(x.low / pitch) * pitch;
  const bool nearer_half = std::abs(x_rest) > pitch / 4;
  Fit out{pitch, nearer_half ? pitch / 2 : 0, 0, 0, 0};
  out.x_shift = nearer_half ? std::copysign(pitch / 2, x_rest) - x_rest : -x_rest;
  if (std::abs(out.x_shift) <= kRounding_m) out.x_shift = 0;
  out.y_shift = pitch / 2 - (y.low - std::floor(y.low / pitch) * pitch);
  if (y.low + out.y_shift < pitch / 2 - kRounding_m)
    out.y_shift += std::ceil((pitch / 2 - kRounding_m - y.low - out.y_shift) / pitch) * pitch;
  out.worst_m = std::max(worst(x, out.x_phase - out.x_shift, pitch), worst(y, pitch / 2 - out.y_shift, pitch));
  return out;
}

std::vector<double> pitches(const Axis& x, const Axis& y, const GridChoice& choice) {
  if (choice.pitch_m) return {*choice.pitch_m};
  std::vector<double> out;
  std::vector<double> gaps{0};
  for (const Axis* axis : {&x, &y}) {
    for (std::size_t i = 1; i < axis->values.size(); ++i)
      gaps.push_back(gaps.back() + axis->values[i] - axis->values[i - 1]);
  }
  const double common = common_measure(std::move(gaps));
  for (int k = 1; common > 0 && common / k >= kFinestPitch_m && k <= 8; ++k) {
    if (common / k <= choice.coarsest_m + kExact_m) out.push_back(std::round(common / k * 1e6) / 1e6);
  }
  // Of files with rounded numbers; 22.5 inches and parts of it are the steps of drill.
  for (const double usual : {1.0, 0.5715, 0.5, 0.28575, 0.25, 0.142875, 0.1}) {
    if (usual <= choice.coarsest_m) out.push_back(usual);
  }
  return out;
}

Result<FittingGrid> made(const Fit& fit, const Axis& x, const Axis& y, double tolerance_m) {
  const double p = fit.pitch_m;
  const double reach = std::max(std::abs(x.low + fit.x_shift), std::abs(x.high + fit.x_shift)) / p;
  const bool odd = fit.x_phase == 0;
  // Columns at -m .. m (odd), or at -m + 1/2 .. m - 1/2 (even).
  const double m = odd ? std::round(reach) + kMargin : std::round(reach + 0.5) + kMargin;
  const double columns = odd ? 2 * m + 1 : 2 * m;
  const double rows = std::floor((y.high + fit.y_shift) / p + 1e-9) + 1 + kMargin;
  if (columns > 4096 || rows > 4096 || columns * rows > 4e6) {
    return input_error(
        fmt::format("the places need a grid of {:.0f} x {:.0f} cells of {:g} m (at most 4096 x 4096 and "
                    "4000000 in all; a larger --pitch with --snap)",
                    columns, rows, p));
  }
  auto grid = Grid::make(GridKind::square, static_cast<int>(columns), std::max(1, static_cast<int>(rows)), p);
  if (!grid) return grid.error();
  return FittingGrid{*grid, {fit.x_shift, fit.y_shift}, tolerance_m};
}

Error no_cell(const Imported& imported, const FittingGrid& grid, const ImportedPlace& place) {
  const double off_m = grid.off_m(place.at);
  const Diagnostic wrong{
      Severity::error, imported.position(place), "",
      fmt::format("x {:g} m, y {:g} m is no middle of a cell: {} is {:.3f} m away on a grid of {:g} m", place.at.x,
                  place.at.y, grid.grid.name(grid.cell(place.at)), off_m, grid.grid.pitch_m()),
      fmt::format("another --pitch, or --snap '{:.2f} m' to move people that far",
                  std::ceil(off_m * 100 - 1e-6) / 100)};
  return input_error(to_text(wrong));
}

/// The place that is farthest from a cell.
const ImportedPlace& farthest(const FittingGrid& grid, const std::vector<ImportedPlace>& places) {
  return *std::max_element(places.begin(), places.end(), [&](const ImportedPlace& a, const ImportedPlace& b) {
    return grid.off_m(a.at) < grid.off_m(b.at);
  });
}

}  // namespace

Result<FittingGrid> fitting_grid(const Imported& imported, const std::vector<ImportedPlace>& places,
                                 const GridChoice& choice) {
  FL_CHECK(!places.empty());
  const double tolerance_m = std::max(choice.snap_m, kRounding_m);
  if (choice.grid) {
    const FittingGrid given{*choice.grid, {}, tolerance_m};
    const ImportedPlace& worst_place = farthest(given, places);
    if (given.off_m(worst_place.at) > tolerance_m) return no_cell(imported, given, worst_place);
    return given;
  }
  const Axis x = axis_of(places, &Point::x);
  const Axis y = axis_of(places, &Point::y);
  const std::vector<double> candidates = pitches(x, y, choice);
  for (const bool shift : {false, true}) {
    for (const double pitch : candidates) {
      const Fit fit = shift ? shifted(x, y, pitch) : unshifted(x, y, pitch);
      if (fit.worst_m <= kRounding_m) return made(fit, x, y, tolerance_m);
    }
  }
  // Nothing fits: people are moved, or it is told who would have to be.
  auto nearest = made(unshifted(x, y, candidates.front()), x, y, tolerance_m);
  if (!nearest) return nearest.error();
  const ImportedPlace& worst_place = farthest(*nearest, places);
  if (nearest->off_m(worst_place.at) > tolerance_m) return no_cell(imported, *nearest, worst_place);
  return nearest;
}

Result<OnCells> cells_of(const Imported& imported, const FittingGrid& grid) {
  OnCells out;
  Diagnostics wrong;
  for (std::size_t f = 0; f < imported.formations.size(); ++f) {
    const ImportedFormation& formation = imported.formations[f];
    std::unordered_map<std::uint32_t, std::size_t> who;
    std::vector<CellIndex>& cells = out.cells.emplace_back();
    for (std::size_t p = 0; p < formation.places.size(); ++p) {
      const ImportedPlace& place = formation.places[p];
      const CellIndex cell = grid.cell(place.at);
      const double off_m = grid.off_m(place.at);
      if (off_m > grid.tolerance_m) return no_cell(imported, grid, place);
      if (off_m > kRounding_m) ++out.moved;
      if (off_m > std::max(kExact_m, out.largest_move_m)) {
        out.largest_move_m = off_m;
        out.farthest_formation = f;
        out.farthest_person = p;
      }
      const auto [other, is_free] = who.emplace(cell.value(), p);
      if (!is_free) {
        const Position first = imported.position(formation.places[other->second]);
        wrong.error(
            imported.position(place), "",
            fmt::format("performers {} and {} both stand on {} in {} (count {:g})", imported.people[other->second].name,
                        imported.people[p].name, grid.grid.name(cell), formation.name, formation.count),
            fmt::format("the first in {}:{}; one person on each cell", first.file, first.line));
      }
      cells.push_back(cell);
    }
  }
  if (!wrong.has_errors()) return out;
  return first_errors(wrong);
}

}  // namespace footlight::app
