// SPDX-License-Identifier: Apache-2.0
#include "planner/painted/sodm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/check.hpp"
#include "core/rng.hpp"
#include "planner/motion/neighbours.hpp"

namespace footlight::planner {
namespace {

constexpr double kLearning = 0.5;     // eta at the beginning
constexpr double kFitting = 0.5;      // eta_a
constexpr double kApart = 0.5;        // weight of v_d at the end
constexpr double kLastWidth = 0.5;    // of theta, neurons
constexpr double kNegligible = 1e-3;  // of theta
constexpr int kMostSettling = 500;    // rounds
constexpr double kSettled = 0.01;     // of the spacing
constexpr int kInputsPerNeuron = 20;

class Map {
 public:
  explicit Map(const SodmTask& task)
      : task_(task),
        shape_(*task.shape),
        lattice_(*task.lattice),
        spacing_(ideal_spacing(shape_, lattice_.people())),
        nearest_(nearest_pixels(shape_)) {
    for (std::size_t i = 0; i < shape_.cells.size(); ++i) {
      if (shape_.cells[i] != 0) painted_.push_back(i);
    }
    FL_CHECK(!painted_.empty());
    w_ = spread_over(shape_, lattice_, task.turn);
  }

  std::vector<Point> run() {
    const int inputs = std::max(task_.iterations, kInputsPerNeuron * lattice_.people());
    Rng rng(task_.seed);
    for (int t = 0; t < inputs; ++t) {
      const double time = static_cast<double>(t) / inputs;
      show(input(rng), time);
      const double rising = time;
      if (task_.keep_apart) keep_apart(kApart * rising);
      if (task_.fit_shape) fit_shape(kFitting * rising);
    }
    settle();
    return std::move(w_);
  }

 private:
  [[nodiscard]] Point middle(std::size_t pixel) const {
    const auto width = static_cast<std::size_t>(shape_.width);
    return {static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5};
  }
  /// D(t): anywhere in the shape.
  [[nodiscard]] Point input(Rng& rng) const {
    const Point pixel = middle(painted_[rng.below(painted_.size())]);
    const double x = rng.uniform() - 0.5;
    const double y = rng.uniform() - 0.5;
    return {pixel.x + x, pixel.y + y};
  }

  void show(Point input, double time) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < w_.size(); ++i) {
      const double away = squared_length(w_[i] - input);
      if (away < least) {
        least = away;
        best = i;
      }
    }
    const double first = std::max(lattice_.width(), double(lattice_.rows())) / 2;
    const double width = std::max(kLastWidth, first * std::pow(kLastWidth / std::max(first, kLastWidth), time));
    const double rate = kLearning * (1 - time);
    const double square = 2 * width * width;
    const double reach = -std::log(kNegligible) * square;
    const Point centre = lattice_.places()[best];
    for (std::size_t i = 0; i < w_.size(); ++i) {
      const double away = squared_length(lattice_.places()[i] - centre);
      if (away > reach) continue;
      w_[i] = w_[i] + rate * std::exp(-away / square) * (input - w_[i]);
    }
  }

  /// v_d
  void keep_apart(double weight) {
    near_.sort(w_, spacing_);
    moved_.assign(w_.size(), {});
    for (std::size_t i = 0; i < w_.size(); ++i) {
      near_.visit(w_[i], spacing_, [&](std::uint32_t k, double squared) {
        if (k == i) return;
        const double away = std::sqrt(squared);
        // Two at one point part along the lattice.
        const Point along = away > 0 ? 1 / away * (w_[i] - w_[k]) : apart(i, k);
        moved_[i] = moved_[i] + weight * 0.5 * (spacing_ - away) * along;
      });
    }
    for (std::size_t i = 0; i < w_.size(); ++i) w_[i] = w_[i] + moved_[i];
  }
  [[nodiscard]] Point apart(std::size_t i, std::size_t k) const {
    const Point along = lattice_.places()[i] - lattice_.places()[k];
    return 1 / length(along) * along;
  }

  [[nodiscard]] bool outside(Point p) const {
    return !shape_.contains(p) || shape_.at(static_cast<int>(p.x), static_cast<int>(p.y)) == 0;
  }
  /// N(t): of the shape.
  [[nodiscard]] Point nearest(Point p) const {
    const int x = std::clamp(static_cast<int>(p.x), 0, shape_.width - 1);
    const int y = std::clamp(static_cast<int>(p.y), 0, shape_.height - 1);
    return middle(static_cast<std::size_t>(nearest_.pixel.at(x, y)));
  }
  /// v_a, Eq. 2
  void fit_shape(double weight) {
    for (Point& w : w_) {
      if (outside(w)) w = w + weight * (nearest(w) - w);
    }
  }

  void settle() {
    std::vector<Point> before;
    for (int round = 0; round < kMostSettling && (task_.keep_apart || task_.fit_shape); ++round) {
      before = w_;
      if (task_.keep_apart) keep_apart(kApart);
      if (task_.fit_shape) fit_shape(1);
      double most = 0;
      for (std::size_t i = 0; i < w_.size(); ++i) most = std::max(most, squared_length(w_[i] - before[i]));
      if (std::sqrt(most) < kSettled * spacing_) break;
    }
  }

  const SodmTask& task_;
  const PixelSet& shape_;
  const Lattice& lattice_;
  double spacing_;
  NearestPixels nearest_;
  std::vector<std::size_t> painted_;
  std::vector<Point> w_;
  std::vector<Point> moved_;
  Neighbours near_;
};

}  // namespace

Lattice::Lattice(int people, double aspect) {
  FL_CHECK(people > 0 && aspect > 0);
  rows_ = std::clamp(static_cast<int>(std::lround(std::sqrt(people / aspect))), 1, people);
  width_ = static_cast<double>(people) / rows_;
  std::vector<int> begin;
  for (int r = 0; r <= rows_; ++r) {
    begin.push_back(static_cast<int>(static_cast<long>(r) * people / rows_));
  }
  for (int r = 0; r < rows_; ++r) {
    const int many = begin[static_cast<std::size_t>(r) + 1] - begin[static_cast<std::size_t>(r)];
    for (int c = 0; c < many; ++c) at_.push_back({(c + 0.5) * width_ / many, r + 0.5});
  }
  for (int r = 0; r < rows_; ++r) {
    const int first = begin[static_cast<std::size_t>(r)];
    const int last = begin[static_cast<std::size_t>(r) + 1];
    for (int i = first; i < last; ++i) {
      if (i + 1 < last) neighbours_.emplace_back(i, i + 1);
      if (r + 1 == rows_) continue;
      const int below = begin[static_cast<std::size_t>(r) + 2] - last;
      const double x = at_[static_cast<std::size_t>(i)].x;
      const int column = std::clamp(static_cast<int>(x / width_ * below), 0, below - 1);
      neighbours_.emplace_back(i, last + column);
    }
  }
}

double ideal_spacing(const PixelSet& shape, int people) {
  const double area = static_cast<double>(count(shape));
  return std::sqrt(2 / std::numbers::sqrt3 * area / people);
}

std::vector<Point> spread_over(const PixelSet& shape, const Lattice& lattice, LatticeTurn turn) {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{0, 0};
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      if (shape.at(x, y) == 0) continue;
      low = {std::min(low.x, double(x)), std::min(low.y, double(y))};
      high = {std::max(high.x, x + 1.0), std::max(high.y, y + 1.0)};
    }
  }
  std::vector<Point> out;
  for (const Point at : lattice.places()) {
    double u = at.x / lattice.width();
    double v = at.y / lattice.rows();
    if (turn.transposed) std::swap(u, v);
    if (turn.mirrored_x) u = 1 - u;
    if (turn.mirrored_y) v = 1 - v;
    out.push_back({low.x + u * (high.x - low.x), low.y + v * (high.y - low.y)});
  }
  return out;
}

std::vector<Point> sodm(const SodmTask& task) { return Map(task).run(); }

MapQuality quality(const PixelSet& shape, const Lattice& lattice, const std::vector<Point>& places) {
  MapQuality out;
  const double spacing = ideal_spacing(shape, lattice.people());
  double kept = 0;
  for (const auto& [a, b] : lattice.neighbours()) {
    const double away = distance(places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)]);
    kept += away <= 1.5 * spacing ? 1 : 0;
  }
  out.neighbours_kept = lattice.neighbours().empty() ? 1 : kept / static_cast<double>(lattice.neighbours().size());
  double least = std::numeric_limits<double>::infinity();
  double inside = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Point p = places[i];
    const bool in = shape.contains(p) && shape.at(static_cast<int>(p.x), static_cast<int>(p.y)) != 0;
    inside += in ? 1 : 0;
    for (std::size_t k = 0; k < i; ++k) least = std::min(least, squared_length(p - places[k]));
  }
  out.separation = places.size() < 2 ? 1 : std::sqrt(least) / spacing;
  out.inside = inside / static_cast<double>(places.size());
  // A triangular lattice leaves nothing farther than this from its points.
  const double reach = spacing / std::numbers::sqrt3;
  double covered = 0;
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      if (shape.at(x, y) == 0) continue;
      const Point p{x + 0.5, y + 0.5};
      const bool near =
          std::any_of(places.begin(), places.end(), [&](Point q) { return squared_length(p - q) <= reach * reach; });
      covered += near ? 1 : 0;
    }
  }
  out.coverage = covered / static_cast<double>(count(shape));
  return out;
}

}  // namespace footlight::planner
