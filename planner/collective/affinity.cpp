// SPDX-License-Identifier: Apache-2.0
#include "planner/collective/affinity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/check.hpp"
#include "core/rng.hpp"

namespace footlight::planner::collective {
namespace {

constexpr float kNever = -std::numeric_limits<float>::infinity();
constexpr double kTieBreak = 1e-6;  ///< of the range of similarities

template <class Work>
void for_each_point(std::uint32_t size, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, size, 32), [&](const auto& range) {
    for (std::uint32_t i = range.begin(); i != range.end(); ++i) work(i);
  });
}

/// The messages of one run. Lists of arcs are in the order of the rows; `column_` has the same arcs by their targets.
class Messages {
 public:
  Messages(const SimilarityRows& rows, double damping)
      : rows_(rows),
        damping_(static_cast<float>(damping)),
        similarity_(rows.similarity),
        responsibility_(rows.to.size(), 0),
        availability_(rows.to.size(), 0),
        own_arc_(rows.size()),
        column_first_(rows.size() + 1, 0) {
    index_columns();
    break_ties();
  }

  void pass() {
    for_each_point(rows_.size(), [&](std::uint32_t i) { respond(i); });
    if (all_pairs()) {
      const std::uint32_t blocks = (rows_.size() + kBlock - 1) / kBlock;
      tbb::parallel_for(0U, blocks, [&](std::uint32_t b) { offer_block(b * kBlock); });
    } else {
      for_each_point(rows_.size(), [&](std::uint32_t k) { offer(k); });
    }
  }

  [[nodiscard]] std::vector<char> exemplars() const {
    std::vector<char> out(rows_.size());
    for (std::uint32_t k = 0; k < rows_.size(); ++k) {
      out[k] = responsibility_[own_arc_[k]] + availability_[own_arc_[k]] > 0 ? 1 : 0;
    }
    return out;
  }

 private:
  /// So many columns are gone through together where all pairs are known: their numbers are side by side in each row.
  static constexpr std::uint32_t kBlock = 256;

  [[nodiscard]] bool all_pairs() const { return rows_.to.size() == std::size_t{rows_.size()} * rows_.size(); }

  void index_columns() {
    if (all_pairs()) {
      for (std::uint32_t i = 0; i < rows_.size(); ++i) own_arc_[i] = i * rows_.size() + i;
      return;
    }
    column_.resize(rows_.to.size());
    for (const std::uint32_t k : rows_.to) ++column_first_[k + 1];
    for (std::uint32_t k = 0; k < rows_.size(); ++k) column_first_[k + 1] += column_first_[k];
    std::vector<std::uint32_t> next(column_first_.begin(), column_first_.end() - 1);
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
      bool own = false;
      for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
        column_[next[rows_.to[e]]++] = e;
        if (rows_.to[e] != i) continue;
        own_arc_[i] = e;
        own = true;
      }
      FL_CHECK(own);
    }
  }

  void break_ties() {
    if (similarity_.empty()) return;
    const auto [low, high] = std::minmax_element(similarity_.begin(), similarity_.end());
    const double most = kTieBreak * std::max(1e-3, double{*high} - double{*low});
    for_each_point(rows_.size(), [&](std::uint32_t i) {
      for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
        Rng rng((std::uint64_t{i} << 32U) | rows_.to[e]);
        similarity_[e] -= static_cast<float>(most * rng.uniform());
      }
    });
  }

  void respond(std::uint32_t i) {
    float best = kNever;
    float second = kNever;
    std::uint32_t best_arc = 0;
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) {
      const float both = availability_[e] + similarity_[e];
      if (both > best) {
        second = best;
        best = both;
        best_arc = e;
      } else if (both > second) {
        second = both;
      }
    }
    const auto answer = [&](std::uint32_t e, float other) {
      // Somebody who knows nobody else is an exemplar for certain; finite, so that damping can go on.
      const float fresh = other == kNever ? std::numeric_limits<float>::max() / 4 : similarity_[e] - other;
      return damping_ * responsibility_[e] + (1 - damping_) * fresh;
    };
    const float to_best = answer(best_arc, second);
    for (std::uint32_t e = rows_.first[i]; e < rows_.first[i + 1]; ++e) responsibility_[e] = answer(e, best);
    responsibility_[best_arc] = to_best;
  }

  void offer(std::uint32_t k) {
    double sum = 0;
    for (std::uint32_t c = column_first_[k]; c < column_first_[k + 1]; ++c) {
      const std::uint32_t e = column_[c];
      if (e != own_arc_[k]) sum += std::max(0.0F, responsibility_[e]);
    }
    const double own = responsibility_[own_arc_[k]];
    for (std::uint32_t c = column_first_[k]; c < column_first_[k + 1]; ++c) {
      const std::uint32_t e = column_[c];
      const double fresh =
          e == own_arc_[k] ? sum : std::min(0.0, own + sum - std::max(0.0, double{responsibility_[e]}));
      availability_[e] = damping_ * availability_[e] + (1 - damping_) * static_cast<float>(fresh);
    }
  }

  /// The same for some columns of all pairs, row by row, with the same sums.
  void offer_block(std::uint32_t first) {
    const std::uint32_t size = rows_.size();
    const std::uint32_t count = std::min(kBlock, size - first);
    std::array<double, kBlock> sum{};
    std::array<double, kBlock> own{};
    for (std::uint32_t i = 0; i < size; ++i) {
      const float* row = responsibility_.data() + std::size_t{i} * size + first;
      if (i >= first && i < first + count) {
        own[i - first] = row[i - first];
        for (std::uint32_t c = 0; c < count; ++c) sum[c] += i == first + c ? 0.0 : double{std::max(0.0F, row[c])};
        continue;
      }
      for (std::uint32_t c = 0; c < count; ++c) sum[c] += double{std::max(0.0F, row[c])};
    }
    for (std::uint32_t i = 0; i < size; ++i) {
      const float* row = responsibility_.data() + std::size_t{i} * size + first;
      float* offered = availability_.data() + std::size_t{i} * size + first;
      const float before = i >= first && i < first + count ? offered[i - first] : 0;
      for (std::uint32_t c = 0; c < count; ++c) {
        const double fresh = std::min(0.0, own[c] + sum[c] - double{std::max(0.0F, row[c])});
        offered[c] = damping_ * offered[c] + (1 - damping_) * static_cast<float>(fresh);
      }
      if (i < first || i >= first + count) continue;
      offered[i - first] = damping_ * before + (1 - damping_) * static_cast<float>(sum[i - first]);
    }
  }

  const SimilarityRows& rows_;
  float damping_;
  std::vector<float> similarity_, responsibility_, availability_;
  std::vector<std::uint32_t> own_arc_, column_first_, column_;
};

float similarity_in(const SimilarityRows& rows, std::uint32_t i, std::uint32_t k) {
  const auto begin = rows.to.begin() + rows.first[i];
  const auto end = rows.to.begin() + rows.first[i + 1];
  const auto at = std::lower_bound(begin, end, k);
  if (at == end || *at != k) return kNever;
  return rows.similarity[static_cast<std::size_t>(at - rows.to.begin())];
}

/// Everybody takes the most similar exemplar; the lower one among equals.
std::vector<std::uint32_t> assigned(const SimilarityRows& rows, const std::vector<char>& exemplar) {
  std::vector<std::uint32_t> out(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    out[i] = i;
    if (exemplar[i] != 0) continue;
    float best = kNever;
    for (std::uint32_t e = rows.first[i]; e < rows.first[i + 1]; ++e) {
      if (exemplar[rows.to[e]] == 0 || rows.similarity[e] <= best) continue;
      best = rows.similarity[e];
      out[i] = rows.to[e];
    }
  }
  return out;
}

/// Each cluster's member whom the others know and are most similar to.
std::vector<char> refined(const SimilarityRows& rows, const std::vector<std::uint32_t>& exemplar_of) {
  std::vector<std::vector<std::uint32_t>> members(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) members[exemplar_of[i]].push_back(i);
  std::vector<char> out(rows.size(), 0);
  for_each_point(rows.size(), [&](std::uint32_t cluster) {
    double best = -std::numeric_limits<double>::infinity();
    std::uint32_t who = cluster;
    for (const std::uint32_t k : members[cluster]) {
      double sum = 0;
      for (const std::uint32_t i : members[cluster]) sum += i == k ? 0.0 : double{similarity_in(rows, i, k)};
      if (sum > best) {
        best = sum;
        who = k;
      }
    }
    if (!members[cluster].empty()) out[who] = 1;
  });
  return out;
}

double median_of(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

}  // namespace

std::size_t Clusters::count() const {
  std::size_t out = 0;
  for (std::uint32_t i = 0; i < exemplar_of.size(); ++i) out += exemplar_of[i] == i ? 1 : 0;
  return out;
}

Clusters affinity_propagation(const SimilarityRows& rows, const AffinityOptions& options,
                              const std::atomic<bool>* stop) {
  Clusters out;
  Messages messages(rows, options.damping);
  std::vector<char> exemplars(rows.size(), 0);
  int stable = 0;
  while (out.rounds < options.most_rounds && !out.converged) {
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) break;
    messages.pass();
    ++out.rounds;
    auto now = messages.exemplars();
    const bool any = std::find(now.begin(), now.end(), 1) != now.end();
    stable = any && now == exemplars ? stable + 1 : 0;
    out.converged = stable >= options.stable_rounds;
    exemplars = std::move(now);
  }
  out.exemplar_of = assigned(rows, refined(rows, assigned(rows, exemplars)));
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    out.net_similarity += double{similarity_in(rows, i, out.exemplar_of[i])};
  }
  return out;
}

double similarity(Point from_i, Point from_j, Point to_i, Point to_j) {
  const auto manhattan = [](Point a, Point b) { return std::abs(a.x - b.x) + std::abs(a.y - b.y); };
  const double change = manhattan(from_i, from_j) - manhattan(to_i, to_j);
  return -change * change;
}

SimilarityRows all_similarities(std::span<const Point> from, std::span<const Point> to) {
  FL_CHECK(from.size() == to.size());
  const auto size = static_cast<std::uint32_t>(from.size());
  SimilarityRows rows;
  rows.to.reserve(from.size() * from.size());
  rows.similarity.reserve(from.size() * from.size());
  std::vector<float> different;
  different.reserve(from.size() * from.size() / 2);
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t k = 0; k < size; ++k) {
      const auto value = static_cast<float>(similarity(from[i], from[k], to[i], to[k]));
      rows.add(k, value);
      if (k > i) different.push_back(value);
    }
    rows.close_row();
  }
  const auto preference = static_cast<float>(median_of(std::move(different)));
  for (std::uint32_t i = 0; i < size; ++i) rows.similarity[rows.first[i] + i] = preference;
  return rows;
}

}  // namespace footlight::planner::collective
