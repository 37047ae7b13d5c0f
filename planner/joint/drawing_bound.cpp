// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/drawing_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "planner/formation/cell_shares.hpp"
#include "planner/formation/placement.hpp"
#include "planner/joint/joint_plan.hpp"
#include "planner/joint/time_flow.hpp"
#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

/// Whole costs for one person where everybody together is worth 1.
constexpr double kUnit = 4000;
/// Beyond this costs could overflow (FlowTask).
constexpr double kMostCost = 900'000;
/// The first round goes through all of them, the others through the last ones.
constexpr std::array kEpsilons{4000, 800, 200, 80, 20};
constexpr std::size_t kEpsilonsLater = 3;
constexpr double kRounding_m = 1e-6;
/// Share of what the plan is worse than the bound that a step is meant to win, and what is left of it after one that
/// won nothing.
constexpr double kFirstStep = 0.5;
constexpr double kShorter = 1.0 / 3;

/// A frame at an instant, and a plane that is nowhere above its figure:
/// constant + per_person * people - per_cover * covered.
struct Look {
  double area = 0;  ///< of the picture, cells
  std::vector<float> rho;
  std::vector<double> most_covered;  ///< by n people on the best cells, for each n
  double per_person = 0;
  double per_cover = 0;
  double constant = 0;
  double people = 0;  ///< where the plane touches the figure
  double covered = 0;

  [[nodiscard]] double iou(double n, double c) const {
    const double either = area + n - c;
    return either > 0 ? 1 - c / either : 0;
  }
};

class Bounder {
 public:
  Bounder(const Plan& plan, SectionIndex section, const Film& film, const Progress& progress)
      : plan_(plan),
        section_(plan.sections[section.at()]),
        film_(film),
        progress_(progress),
        grid_(plan.stage.grid),
        people_(plan.performers.size()),
        unit_(kUnit * static_cast<double>(people_)),
        stands_(static_cast<std::size_t>(grid_.size()), 1),
        drawn_(stands_) {
    for (const CellIndex cell : plan.stage.blocked) stands_[cell.at()] = drawn_[cell.at()] = 0;
    for (const CellIndex cell : section_.reserve) drawn_[cell.at()] = 0;
    for (const Formation& one : plan.formations) {
      if (one.section != section || !one.frame) continue;
      if (formations_.empty() || formations_.back()->time < one.time) formations_.push_back(&one);
    }
  }

  std::optional<DrawingBound> run(int rounds) {
    if (people_ == 0 || formations_.size() < 2 || !can_plan_jointly(grid_, formations_.size())) return std::nullopt;
    if (!look()) return std::nullopt;
    DrawingBound out{formations_.size(), 0, 0, 0};
    const auto frames = static_cast<double>(formations_.size());
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      out.of_plan += of_plan(k) / frames;
      out.nobody_walks += of_single(looks_[k]) / frames;
    }
    make_network();
    const auto least = climb(rounds, out.of_plan * frames);
    if (!least) return std::nullopt;
    out.least = std::max(out.nobody_walks, *least / frames);
    return out;
  }

 private:
  bool look() {
    looks_.resize(formations_.size());
    const StageToFrame& map = section_.film->stage_to_frame;
    const double cell_px = grid_.cell_area_m2() * std::abs(map[0] * map[4] - map[1] * map[3]);
    return for_each_index(looks_.size(), "bound", {{}, progress_.stop}, [&](std::size_t k) {
      Look& one = looks_[k];
      const Mask& picture = film_.frames[static_cast<std::size_t>(*formations_[k]->frame - film_.first_frame)];
      const auto shares = cell_shares(picture, grid_, map);
      one.area = static_cast<double>(picture_area(picture)) / cell_px;
      one.rho.assign(shares.size(), 0.0F);
      std::vector<float> sorted;
      for (std::size_t c = 0; c < shares.size(); ++c) {
        if (drawn_[c] == 0) continue;
        one.rho[c] = static_cast<float>(shares[c]);
        sorted.push_back(one.rho[c]);
      }
      std::sort(sorted.begin(), sorted.end(), std::greater<>());
      one.most_covered.push_back(0);
      for (std::size_t n = 0; n < std::min(sorted.size(), people_); ++n) {
        one.most_covered.push_back(one.most_covered.back() + static_cast<double>(sorted[n]));
      }
      lay(one);
    });
  }

  /// People whom the reserve cannot hold.
  [[nodiscard]] std::size_t least_people() const { return people_ - std::min(people_, section_.reserve.size()); }

  [[nodiscard]] std::pair<double, double> drawn_by(const Look& one, const std::vector<CellIndex>& at) const {
    double people = 0;
    double covered = 0;
    for (const CellIndex cell : at) {
      people += drawn_[cell.at()];
      covered += static_cast<double>(one.rho[cell.at()]);
    }
    return {people, covered};
  }
  [[nodiscard]] double of_plan(std::size_t k) const {
    const auto [people, covered] = drawn_by(looks_[k], formations_[k]->cells);
    return looks_[k].iou(people, covered);
  }
  [[nodiscard]] double of_single(const Look& one) const {
    double least = 1;
    for (std::size_t n = least_people(); n < one.most_covered.size(); ++n) {
      least = std::min(least, one.iou(static_cast<double>(n), one.most_covered[n]));
    }
    return least;
  }

  /// A plane to begin with.
  void lay(Look& one) const {
    const auto all = static_cast<double>(people_);
    one.per_cover = 1 / std::max(all, one.area);
    one.per_person = all > one.area ? one.per_cover : 0;
    settle(one);
  }

  /// Moves the plane up to where it touches the figure. With a number of people the figure less the plane is concave in
  /// what they cover: it is least where they cover nothing or all they can.
  void settle(Look& one) const {
    const double most = kMostCost / 2 / unit_;
    one.per_person = std::clamp(one.per_person, -most, most);
    one.per_cover = std::clamp(one.per_cover, 0.0, most);
    one.constant = std::numeric_limits<double>::infinity();
    for (std::size_t n = least_people(); n < one.most_covered.size(); ++n) {
      for (const double covered : {0.0, one.most_covered[n]}) {
        const auto people = static_cast<double>(n);
        const double above = one.iou(people, covered) - one.per_person * people + one.per_cover * covered;
        if (above >= one.constant) continue;
        one.constant = above;
        one.people = people;
        one.covered = covered;
      }
    }
  }

  void make_network() {
    flow_.cells = static_cast<std::size_t>(grid_.size());
    flow_.people = people_;
    for (std::size_t k = 0; k + 1 < formations_.size(); ++k) {
      const double time_s = to_seconds(formations_[k + 1]->time - formations_[k]->time);
      const auto reach_um = static_cast<long long>(std::ceil(1e6 * (section_.max_speed_mps * time_s + kRounding_m)));
      const auto [known, is_new] = reaches_.try_emplace(reach_um);
      if (is_new) known->second = reach(1e-6 * static_cast<double>(reach_um));
      flow_.intervals.push_back({&known->second, {}});
    }
    flow_.stand.resize(flow_.cells * formations_.size());
  }

  /// Whoever keeps the limit of speed is within it, whatever is between.
  [[nodiscard]] Reach reach(double reach_m) const {
    Reach out;
    out.first.push_back(0);
    for (std::size_t c = 0; c < stands_.size(); ++c) {
      if (stands_[c] != 0) {
        for (const CellIndex to : grid_.within(grid_.centre(CellIndex::of(c)), reach_m)) {
          if (stands_[to.at()] != 0) out.to.push_back(to.value());
        }
      }
      out.first.push_back(static_cast<std::uint32_t>(out.to.size()));
    }
    out.kind.assign(out.to.size(), 0);
    return out;
  }

  /// Whole costs, none above what it stands for.
  void price() {
    for_each_index(looks_.size(), "bound", {}, [&](std::size_t k) {
      const Look& one = looks_[k];
      for (std::size_t c = 0; c < flow_.cells; ++c) {
        const double cost = drawn_[c] != 0 ? one.per_person - one.per_cover * static_cast<double>(one.rho[c]) : 0;
        flow_.stand[k * flow_.cells + c] = static_cast<std::int32_t>(std::floor(unit_ * cost));
      }
    });
  }

  /// Subgradient steps, each from the best planes so far. @return the largest bound of the sum over all frames
  std::optional<double> climb(int rounds, double of_plan) {
    TimeFlowSolver solver(flow_);
    std::vector<Look> kept = looks_;
    TimeFlow from;
    double best = -std::numeric_limits<double>::infinity();
    double share = kFirstStep;
    for (int round = 0; round < rounds; ++round) {
      progress_.tell("bound", static_cast<double>(round) / rounds);
      price();
      const std::span<const int> all(kEpsilons);
      for (const int epsilon : round == 0 ? all : all.last(kEpsilonsLater)) {
        if (!solver.refine(epsilon, {{}, progress_.stop})) return std::nullopt;
      }
      TimeFlow found = solver.result();
      double bound = static_cast<double>(found.bound) / unit_;
      for (const Look& one : looks_) bound += one.constant;
      if (bound > best) {
        best = bound;
        kept = looks_;
        from = std::move(found);
      } else {
        looks_ = kept;
        share *= kShorter;
      }
      step(from, share * (of_plan - best));
    }
    progress_.tell("bound", 1);
    return best;
  }

  /// Tilts the planes so that they touch the figures where the flow is, by as much as would win so much if nothing else
  /// changed.
  void step(const TimeFlow& flow, double win) {
    double square = 0;
    std::vector<std::pair<double, double>> slope;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const auto [people, covered] = drawn_by(looks_[k], flow.at[k]);
      slope.emplace_back(people - looks_[k].people, looks_[k].covered - covered);
      square += slope.back().first * slope.back().first + slope.back().second * slope.back().second;
    }
    if (square <= 0) return;
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      looks_[k].per_person += win / square * slope[k].first;
      looks_[k].per_cover += win / square * slope[k].second;
      settle(looks_[k]);
    }
  }

  const Plan& plan_;
  const PlanSection& section_;
  const Film& film_;
  const Progress& progress_;
  const Grid& grid_;
  std::size_t people_;
  double unit_;
  CellFlags stands_;
  CellFlags drawn_;  ///< cells on which people are part of the picture
  std::vector<const Formation*> formations_;
  std::vector<Look> looks_;
  std::map<long long, Reach> reaches_;  ///< by length, micrometres
  FlowTask flow_;
};

}  // namespace

std::optional<DrawingBound> bound_drawing(const Plan& plan, SectionIndex section, const Film& film, int rounds,
                                          const Progress& progress) {
  if (!plan.sections[section.at()].film || film.frames.empty()) return std::nullopt;
  return Bounder(plan, section, film, progress).run(rounds);
}

}  // namespace footlight::planner
