// SPDX-License-Identifier: Apache-2.0
#include "planner/joint/level.hpp"

#include <algorithm>
#include <cmath>

#include "planner/parallel.hpp"

namespace footlight::planner {
namespace {

constexpr double kRounding_m = 1e-9;
/// Nobody goes further than so many blocks in one interval, whatever the limit is.
constexpr double kFarthestBlocks = 6;
/// What walking one pitch in an interval costs, squared for more, where being in the picture meanwhile is worth one.
constexpr double kWalkCost = 0.1;
/// What being on a cell of a formation that the director gave is worth.
constexpr double kKeyWorth = 200;

std::int32_t whole(double cost) { return static_cast<std::int32_t>(std::clamp(std::round(cost), -1e6, 1e6)); }

}  // namespace

Level::Level(const JointTask& task, const std::vector<Look>& looks, const CellFlags& reserve, int factor,
             std::size_t stride, double worth)
    : task_(task),
      looks_(looks),
      worth_(kWorth * worth),
      blocks_(*task.ways, reserve, factor),
      at_(every(stride)),
      views_(views()),
      flow_(network()),
      solver_(flow_) {
  if (factor == 1) return;
  for (const Look& look : looks_) rho_.push_back(blocks_.mean(look.rho));
}

std::vector<std::size_t> Level::every(std::size_t stride) const {
  const std::size_t last = task_.instants.size() - 1;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < last; k += stride) at.push_back(k);
  if (at.size() > 1 && 2 * (last - at.back()) < stride) at.pop_back();
  at.push_back(last);
  return at;
}

std::vector<std::vector<Level::View>> Level::views() const {
  std::vector<std::vector<View>> views(at_.size() - 1);
  std::size_t k = 0;
  for (std::size_t n = 0; n < looks_.size(); ++n) {
    while (k + 1 < views.size() && looks_[n].at >= instant(k + 1)) ++k;
    const double share = to_seconds(looks_[n].at - instant(k)) / to_seconds(instant(k + 1) - instant(k));
    views[k].push_back({n, std::clamp(share, 0.0, 1.0)});
  }
  return views;
}

FlowTask Level::network() {
  FlowTask flow;
  flow.cells = blocks_.size();
  const double people = static_cast<double>(task_.people) / blocks_.cells_each();
  flow.people = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(people)));
  if (blocks_.factor() == 1) flow.start = task_.first;
  for (std::size_t k = 0; k + 1 < at_.size(); ++k) {
    const double longest_m = task_.speed_mps * to_seconds(instant(k + 1) - instant(k)) - kRounding_m;
    const double reach_m =
        std::clamp(longest_m, 0.0, kFarthestBlocks * blocks_.factor() * task_.ways->grid().pitch_m());
    const auto [known, is_new] = reach_.try_emplace(std::llround(reach_m * 1e6));
    if (is_new) known->second = blocks_.reach(reach_m);
    flow.intervals.push_back({&known->second, {}});
  }
  flow.stand.resize(flow.cells * at_.size());
  return flow;
}

void Level::weigh() {
  for_each_index(at_.size(), "joint", {}, [&](std::size_t k) { weigh(k); });
}

/// What it costs to be on each block at an instant, from the frames around it: a frame between two instants sees
/// everybody partly where she was and partly where she will be.
void Level::weigh(std::size_t k) {
  const std::size_t cells = blocks_.size();
  std::vector<double> gain(cells, 0.0);
  const auto add = [&](const View& view, double share) {
    const Look& look = looks_[view.look];
    const std::vector<float>& picture = rho(view.look);
    const double alpha = worth_ * share * look.stands * look.weight.alpha;
    const double beta = worth_ * share * look.stands * look.weight.beta;
    for (std::size_t c = 0; c < cells; ++c) gain[c] += blocks_.waits(c) ? 0 : alpha * picture[c] - beta;
  };
  if (k < views_.size()) {
    for (const View& view : views_[k]) add(view, 1 - view.share);
    weigh_walks(k);
  }
  if (k > 0) {
    for (const View& view : views_[k - 1]) add(view, view.share);
  }
  add_given(k, gain);
  for (std::size_t c = 0; c < cells; ++c) flow_.stand[k * cells + c] = whole(-gain[c]);
}

/// A walk costs its squared length, and to or from the reserve that one is seen outside of the picture.
void Level::weigh_walks(std::size_t k) {
  double out = 0;
  double in = 0;
  for (const View& view : views_[k]) {
    const Look& look = looks_[view.look];
    out += worth_ * (1 - view.share) * look.stands * look.weight.beta;
    in += worth_ * view.share * look.stands * look.weight.beta;
  }
  // Twice the time, half the haste.
  const auto intervals = static_cast<double>(at_[k + 1] - at_[k]);
  const std::vector<double>& squares = blocks_.squares();
  for (std::size_t index = 0; index < squares.size(); ++index) {
    const double walk = kWorth * kWalkCost * task_.effort * squares[index] / intervals;
    auto* cost = flow_.intervals[k].cost.data() + kBorders * index;
    cost[kWithin] = whole(walk);
    cost[kOut] = whole(walk + out);
    cost[kIn] = whole(walk + in);
  }
}

/// The director's formations; where people stand at the beginning holds by itself where a block is a cell.
void Level::add_given(std::size_t k, std::vector<double>& gain) const {
  const auto add = [&](const std::vector<CellIndex>& cells) {
    for (const CellIndex cell : cells) {
      gain[blocks_.block_of(cell.at())] += kWorth * kKeyWorth / blocks_.cells_each();
    }
  };
  if (!task_.given.empty()) add(task_.given[at_[k]]);
  if (k == 0 && blocks_.factor() > 1) add(task_.first);
}

double Level::judge(const TimeFlow& flow, const std::function<void(std::size_t, double, double)>& tell) const {
  double loss = 0;
  const double each = blocks_.cells_each();
  for (std::size_t k = 0; k < views_.size(); ++k) {
    for (const View& view : views_[k]) {
      const Look& look = looks_[view.look];
      const std::vector<float>& picture = rho(view.look);
      double people = 0;
      double covered = 0;
      for (std::size_t i = 0; i < flow_.people; ++i) {
        const std::size_t from = flow.at[k][i].at();
        const std::size_t to = flow.at[k + 1][i].at();
        if (blocks_.waits(from) && blocks_.waits(to)) continue;
        people += each;
        covered += each * ((1 - view.share) * picture[from] + view.share * picture[to]);
      }
      const double either = look.area + people - covered;
      if (people > 0) loss += look.stands * (1 - covered / people);
      if (either > 0) loss += look.stands * kIouWeight * (1 - covered / either);
      tell(view.look, people, covered);
    }
  }
  return loss;
}

std::vector<std::vector<float>> Level::prices_at_cells() const {
  const std::vector<std::int32_t> prices = solver_.prices();
  std::vector<std::vector<float>> out(at_.size());
  for_each_index(at_.size(), "joint", {}, [&](std::size_t k) {
    const auto* of_blocks = prices.data() + k * blocks_.size();
    out[k] = blocks_.at_cells({of_blocks, of_blocks + blocks_.size()});
  });
  return out;
}

/// A price is for the time until the next instant: where instants are closer it is less.
void Level::start_like(const Level& coarser) {
  const auto known = coarser.prices_at_cells();
  const std::size_t cells = blocks_.size();
  std::vector<std::int32_t> prices(cells * at_.size());
  for_each_index(at_.size(), "joint", {}, [&](std::size_t k) {
    std::size_t j = 0;
    while (j + 2 < coarser.at_.size() && coarser.at_[j + 1] <= at_[k]) ++j;
    const auto interval = static_cast<double>(coarser.at_[j + 1] - coarser.at_[j]);
    const std::size_t onward = std::min(k, at_.size() - 2);
    const double less = static_cast<double>(at_[onward + 1] - at_[onward]) / interval;
    const double part = static_cast<double>(at_[k] - coarser.at_[j]) / interval;
    const auto before = static_cast<float>(less * (1 - part));
    const auto after = static_cast<float>(less * part);
    std::vector<float> mixed(known[j].size());
    for (std::size_t c = 0; c < mixed.size(); ++c) mixed[c] = before * known[j][c] + after * known[j + 1][c];
    const std::vector<float> mean = blocks_.mean(mixed);
    for (std::size_t c = 0; c < cells; ++c) prices[k * cells + c] = static_cast<std::int32_t>(std::lround(mean[c]));
  });
  solver_.start_from(prices);
}

}  // namespace footlight::planner
