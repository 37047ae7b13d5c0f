// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/grid_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/check.hpp"

namespace footlight::planner {
namespace {

constexpr int kMostIterations = 400;
constexpr double kResidual = 1e-6;  // px/s of outflow
constexpr double kSteady = 1e-5;    // px/s of change in a step

double sum_of_products(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Value of a staggered raster whose first value lies at `first`.
double between(const Raster<double>& raster, Point at, Point first) {
  return bilinear(raster, {at.x - first.x + 0.5, at.y - first.y + 0.5});
}

constexpr Point kFirstAcross{0, 0.5};
constexpr Point kFirstDown{0.5, 0};

}  // namespace

GridFlow::GridFlow(Raster<Pixel> pixels, Raster<Point> wanted, double reaction_s)
    : pixels_(std::move(pixels)), wanted_(std::move(wanted)), reaction_s_(reaction_s) {
  FL_CHECK(reaction_s_ > 0 && wanted_.width == pixels_.width && wanted_.height == pixels_.height);
  Raster<std::int32_t> number(pixels_.width, pixels_.height, -1);
  for (int y = 0; y < pixels_.height; ++y) {
    for (int x = 0; x < pixels_.width; ++x) {
      const Pixel here = pixel(x, y);
      if (here == Pixel::fluid) {
        number.at(x, y) = static_cast<std::int32_t>(fluid_.size());
        fluid_.push_back({x, y});
      }
      // Among open pixels, too: what flows in has the speed that it is driven with.
      const auto joins = [&](Pixel other) { return here != Pixel::wall && other != Pixel::wall; };
      if (joins(pixel(x - 1, y))) across_.push_back({x, y});
      if (joins(pixel(x, y - 1))) down_.push_back({x, y});
    }
  }
  rows_.resize(fluid_.size());
  for (std::size_t i = 0; i < fluid_.size(); ++i) {
    const auto [x, y] = fluid_[i];
    const Face around[4] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Pixel other = pixel(around[k].x, around[k].y);
      if (other == Pixel::wall) continue;
      rows_[i].diagonal += 1;
      if (other == Pixel::fluid) rows_[i].neighbour[k] = number.at(around[k].x, around[k].y);
    }
  }
}

GridFlow::State GridFlow::begin() const {
  return {Raster<double>(pixels_.width + 1, pixels_.height, 0), Raster<double>(pixels_.width, pixels_.height + 1, 0),
          Raster<double>(pixels_.width, pixels_.height, 0), fluid_.empty()};
}

Point GridFlow::flow(const State& state, Point at) {
  return {between(state.across, at, kFirstAcross), between(state.down, at, kFirstDown)};
}

Point GridFlow::velocity(const State& state, Point at) const {
  const int x = static_cast<int>(std::floor(at.x));
  const int y = static_cast<int>(std::floor(at.y));
  return pixel(x, y) == Pixel::wall ? Point{} : flow(state, at);
}

void GridFlow::step(const State& now, State& next, double step_s) const {
  if (now.steady) return;
  const double take = step_s / reaction_s_;
  for (const auto [x, y] : across_) {
    const Point at{double(x), y + 0.5};
    const double carried = between(now.across, at - step_s * flow(now, at), kFirstAcross);
    const double want = (wanted_.clamped(x - 1, y).x + wanted_.clamped(x, y).x) / 2;
    next.across.at(x, y) = (carried + take * want) / (1 + take);
  }
  for (const auto [x, y] : down_) {
    const Point at{x + 0.5, double(y)};
    const double carried = between(now.down, at - step_s * flow(now, at), kFirstDown);
    const double want = (wanted_.clamped(x, y - 1).y + wanted_.clamped(x, y).y) / 2;
    next.down.at(x, y) = (carried + take * want) / (1 + take);
  }
  project(next, step_s);
  double most = 0;
  for (const auto [x, y] : across_) most = std::max(most, std::abs(next.across.at(x, y) - now.across.at(x, y)));
  for (const auto [x, y] : down_) most = std::max(most, std::abs(next.down.at(x, y) - now.down.at(x, y)));
  next.steady = most < kSteady;
}

double GridFlow::outflow(const State& state, Face at) const {
  return state.across.at(at.x + 1, at.y) - state.across.at(at.x, at.y) + state.down.at(at.x, at.y + 1) -
         state.down.at(at.x, at.y);
}

/// -laplace(p) step = -div u, then u -= step grad p.
void GridFlow::project(State& state, double step_s) const {
  const std::size_t n = fluid_.size();
  std::vector<double> p(n);
  std::vector<double> residual(n);
  const auto laplace = [&](const std::vector<double>& x, std::size_t i) {
    double sum = rows_[i].diagonal * x[i];
    for (const std::int32_t k : rows_[i].neighbour) {
      if (k >= 0) sum -= x[static_cast<std::size_t>(k)];
    }
    return sum;
  };
  for (std::size_t i = 0; i < n; ++i) p[i] = state.pressure.at(fluid_[i].x, fluid_[i].y) * step_s;
  for (std::size_t i = 0; i < n; ++i) {
    // A pixel without an opening keeps what it has: nothing flows there.
    residual[i] = rows_[i].diagonal > 0 ? -outflow(state, fluid_[i]) - laplace(p, i) : 0;
  }
  std::vector<double> way = residual;
  std::vector<double> image(n);
  double square = sum_of_products(residual, residual);
  const double enough = kResidual * kResidual;
  for (int k = 0; k < kMostIterations && square > enough; ++k) {
    for (std::size_t i = 0; i < n; ++i) image[i] = laplace(way, i);
    const double bend = sum_of_products(way, image);
    if (bend <= 0) break;
    const double far = square / bend;
    for (std::size_t i = 0; i < n; ++i) {
      p[i] += far * way[i];
      residual[i] -= far * image[i];
    }
    const double after = sum_of_products(residual, residual);
    for (std::size_t i = 0; i < n; ++i) way[i] = residual[i] + after / square * way[i];
    square = after;
  }
  for (std::size_t i = 0; i < n; ++i) state.pressure.at(fluid_[i].x, fluid_[i].y) = p[i] / step_s;
  const auto pressure = [&](int x, int y) {
    return pixel(x, y) == Pixel::fluid ? state.pressure.at(x, y) * step_s : 0.0;
  };
  for (const auto [x, y] : across_) state.across.at(x, y) -= pressure(x, y) - pressure(x - 1, y);
  for (const auto [x, y] : down_) state.down.at(x, y) -= pressure(x, y) - pressure(x, y - 1);
}

double GridFlow::divergence(const State& state) const {
  double most = 0;
  for (const Face at : fluid_) most = std::max(most, std::abs(outflow(state, at)));
  return most;
}

}  // namespace footlight::planner
