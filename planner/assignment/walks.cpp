// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/walks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "planner/assignment/kd_order.hpp"

namespace footlight::planner::assignment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kOffLattice = 1e-7;  ///< of a step
constexpr double kMostSteps = 0x1p22;
/// So many people and fewer are matched in a full table: all sums of costs are whole numbers that doubles hold
/// (dense.hpp).
constexpr std::size_t kExactInDoubles = 64;

/// The largest step of which all differences are multiples, found as Euclid does; 0 when all are 0.
class CommonStep {
 public:
  void add(double difference) {
    difference = std::abs(difference);
    if (difference <= tolerance_) return;
    widest_ = std::max(widest_, difference);
    if (step_ > 0 && is_multiple(difference)) return;
    double a = std::max(step_, difference);
    double b = std::min(step_, difference);
    while (b > tolerance_) {
      const double rest = std::abs(a - std::round(a / b) * b);
      a = b;
      b = rest;
    }
    step_ = a;
  }
  explicit CommonStep(double tolerance) : tolerance_(tolerance) {}
  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] bool usable() const { return widest_ < kMostSteps * step_ || widest_ == 0; }

 private:
  [[nodiscard]] bool is_multiple(double difference) const {
    const double steps = difference / step_;
    return std::abs(steps - static_cast<double>(nearest_value(steps))) * step_ <= tolerance_;
  }
  double tolerance_;
  double step_ = 0;
  double widest_ = 0;
};

double widest_coordinate(std::span<const Point> points) {
  double widest = 0;
  for (const Point p : points) widest = std::max({widest, std::abs(p.x), std::abs(p.y)});
  return widest;
}

Point mean(std::span<const Point> points) {
  Point sum;
  for (const Point p : points) sum = sum + p;
  return points.empty() ? sum : (1.0 / static_cast<double>(points.size())) * sum;
}

/// Integer coordinates from `first` on.
bool on_steps(double difference, double step, double& steps) {
  steps = step > 0 ? std::nearbyint(difference / step) : 0;
  return std::abs(difference - steps * step) <= kOffLattice * std::max(step, std::numeric_limits<double>::min());
}

}  // namespace

std::optional<Lattice> find_lattice(std::span<const Point> sources, std::span<const Point> targets) {
  if (sources.empty()) return Lattice{};
  const double tolerance = 64 * std::numeric_limits<double>::epsilon() *
                           std::max({widest_coordinate(sources), widest_coordinate(targets), 1e-300});
  CommonStep along_x(tolerance);
  CommonStep along_y(tolerance);
  for (const auto side : {sources, targets}) {
    for (const Point p : side) {
      along_x.add(p.x - side[0].x);
      along_y.add(p.y - side[0].y);
    }
    if (!along_x.usable() || !along_y.usable()) return std::nullopt;
  }
  Lattice lattice{along_x.step(), along_y.step()};
  double ignored = 0;
  for (const auto side : {sources, targets}) {
    for (const Point p : side) {
      if (!on_steps(p.x - side[0].x, lattice.step_x, ignored)) return std::nullopt;
      if (!on_steps(p.y - side[0].y, lattice.step_y, ignored)) return std::nullopt;
    }
  }
  // Where one side never leaves a line, any step does for the other axis.
  const double widest = std::max(lattice.step_x, lattice.step_y);
  if (lattice.step_x == 0) lattice.step_x = widest > 0 ? widest : 1;
  if (lattice.step_y == 0) lattice.step_y = widest > 0 ? widest : 1;
  const double ratio = lattice.step_x * lattice.step_x / (lattice.step_y * lattice.step_y);
  for (int weight_y = 1; weight_y <= 64; ++weight_y) {
    const double weight_x = std::nearbyint(ratio * weight_y);
    if (weight_x < 1 || weight_x > 64 || std::abs(weight_x / weight_y - ratio) > 4 * kOffLattice * ratio) continue;
    lattice.weight_x = static_cast<int>(weight_x);
    lattice.weight_y = weight_y;
    lattice.unit = lattice.step_x * lattice.step_x / weight_x;
    return lattice;
  }
  return std::nullopt;
}

Walks::Walks(std::span<const Point> sources, std::span<const Point> targets, WalkCost metric, double longest_m)
    : metric_(metric), source_points_(sources), target_points_(targets), longest_m_(longest_m) {
  sources_.original = kd_order(sources);
  targets_.original = kd_order(targets);
  const std::size_t size = sources.size();
  std::optional<Lattice> lattice;
  if (metric == WalkCost::squared) lattice = find_lattice(sources, targets);
  const Point source_mean = mean(sources);
  const Point target_mean = mean(targets);
  Point source_zero = source_mean;
  Point target_zero = target_mean;
  double step_x = 1;
  double step_y = 1;
  if (lattice) {  // a mean is no lattice point: the zero becomes the one next to it
    step_x = lattice->step_x;
    step_y = lattice->step_y;
    const auto nearest = [&](Point from, Point to) {
      return Point{from.x + std::nearbyint((to.x - from.x) / step_x) * step_x,
                   from.y + std::nearbyint((to.y - from.y) / step_y) * step_y};
    };
    if (size > 0) source_zero = nearest(sources[0], source_mean);
    // A longest walk is about the places themselves: then the targets move by less than a step.
    if (size > 0) target_zero = nearest(targets[0], longest_m < kInfinity ? source_zero : target_mean);
    weight_x_ = lattice->weight_x;
    weight_y_ = lattice->weight_y;
    unit_ = lattice->unit;
    on_lattice_ = true;
  } else if (metric == WalkCost::euclidean || longest_m < kInfinity) {
    source_zero = target_zero = 0.5 * (source_mean + target_mean);
  }
  shift_ = source_zero - target_zero;
  const auto place = [&](Side& side, std::span<const Point> points, Point zero) {
    side.x.resize(size);
    side.y.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      const Point p = points[side.original[i]] - zero;
      side.x[i] = lattice ? std::nearbyint(p.x / step_x) : p.x;
      side.y[i] = lattice ? std::nearbyint(p.y / step_y) : p.y;
    }
  };
  place(sources_, sources, source_zero);
  place(targets_, targets, target_zero);
  double widest = 0;
  for (const Side* side : {&sources_, &targets_}) {
    for (std::size_t i = 0; i < size; ++i) {
      widest = std::max({widest, std::abs(side->x[i]), std::abs(side->y[i])});
    }
  }
  if (!lattice) {
    const double longest = metric == WalkCost::squared ? 8 * widest * widest : 3 * widest;
    const int size_bits = static_cast<int>(std::bit_width(size));
    const int bits = std::min({46, 58 - size_bits, size <= kExactInDoubles ? 49 - size_bits : 46});
    scale_ = std::ldexp(1.0, std::clamp(bits - (longest > 0 ? std::ilogb(longest) + 1 : 0), -60, 60));
    unit_ = 1 / scale_;
  }
  const double to_search_x = std::sqrt(weight_x_);
  const double to_search_y = std::sqrt(weight_y_);
  for (Side* side : {&sources_, &targets_}) {
    side->search_x.resize(size);
    side->search_y.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      side->search_x[i] = static_cast<float>(side->x[i] * to_search_x);
      side->search_y[i] = static_cast<float>(side->y[i] * to_search_y);
    }
  }
  reach_ = longest_m < kInfinity
               ? static_cast<float>((longest_m + length(shift_)) / (lattice ? std::sqrt(lattice->unit) : 1.0))
               : std::numeric_limits<float>::infinity();
  measure_spacing();
}

Value Walks::to_value(double squared) const {
  if (metric_ == WalkCost::squared) return nearest_value(squared * scale_);
  return nearest_value(std::sqrt(squared) * scale_);
}

bool Walks::limited() const { return longest_m_ < kInfinity; }

bool Walks::allowed(std::uint32_t source, std::uint32_t target) const {
  if (source_points_.empty()) {
    const float dx = sources_.search_x[source] - targets_.search_x[target];
    const float dy = sources_.search_y[source] - targets_.search_y[target];
    return dx * dx + dy * dy <= reach_ * reach_;
  }
  return distance(source_points_[sources_.original[source]], target_points_[targets_.original[target]]) <= longest_m_;
}

/// The median extent of the runs of sixteen targets, taken as 4 x 4 points or, when flat, as a line of them.
void Walks::measure_spacing() {
  std::vector<float> spacings;
  for (std::size_t begin = 0; begin + 16 <= targets_.x.size(); begin += 16) {
    const auto [low_x, high_x] = std::ranges::minmax(std::span(targets_.search_x).subspan(begin, 16));
    const auto [low_y, high_y] = std::ranges::minmax(std::span(targets_.search_y).subspan(begin, 16));
    const float wide = high_x - low_x;
    const float high = high_y - low_y;
    spacings.push_back(std::max(std::sqrt(wide * high) / 3, std::max(wide, high) / 15));
  }
  if (spacings.empty()) return;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::ranges::nth_element(spacings, middle);
  const double spacing = metric_ == WalkCost::squared ? static_cast<double>(*middle) * *middle : *middle;
  spacing_ = std::max<Value>(1, nearest_value(spacing * scale_));
}

Walks Walks::unlimited() const {
  Walks out = *this;
  out.longest_m_ = std::numeric_limits<double>::infinity();
  out.reach_ = std::numeric_limits<float>::infinity();
  return out;
}

Walks Walks::fours() const {
  Walks coarse;
  coarse.metric_ = metric_;
  coarse.longest_m_ = longest_m_;
  const double spacing = static_cast<double>(spacing_) / scale_;
  coarse.reach_ = reach_ + static_cast<float>(0.5 * (metric_ == WalkCost::squared ? std::sqrt(spacing) : spacing));
  coarse.weight_x_ = weight_x_;
  coarse.weight_y_ = weight_y_;
  coarse.scale_ = scale_;
  coarse.unit_ = unit_;
  for (auto [from, to] : {std::pair{&sources_, &coarse.sources_}, std::pair{&targets_, &coarse.targets_}}) {
    for (std::size_t i = 0; i + 3 < from->x.size(); i += 4) {
      const auto mean_of = [i](const auto& v) { return (v[i] + v[i + 1] + v[i + 2] + v[i + 3]) / 4; };
      to->x.push_back(mean_of(from->x));
      to->y.push_back(mean_of(from->y));
      to->search_x.push_back(mean_of(from->search_x));
      to->search_y.push_back(mean_of(from->search_y));
    }
  }
  coarse.spacing_ = metric_ == WalkCost::squared ? 4 * spacing_ : 2 * spacing_;
  return coarse;
}

}  // namespace footlight::planner::assignment
