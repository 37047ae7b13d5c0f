// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/plan.hpp"
#include "core/show.hpp"
#include "planner/schedule/ways.hpp"

namespace footlight::planner {

/// How far apart people have to be because of their own radii, and what walks are planned with for that.
class WidePeople {
 public:
  /// @param show must outlive it
  explicit WidePeople(const Show& show);

  /// Nobody is wider.
  [[nodiscard]] double widest_m() const;
  /// No two people need more than this because of their radii.
  [[nodiscard]] double widest_two_m() const;
  /// What everybody's walks are planned for. Neighbours who stand still are a pitch apart: more cannot be planned for,
  /// and the judge has the last word.
  [[nodiscard]] double clearance_m() const { return clearance_m_; }
  /// Wide people keep the others' distance by their own radii: what walks keep by themselves can be asked of
  /// everybody, more is asked of those alone who need it.
  [[nodiscard]] bool pair_by_pair() const { return pair_by_pair_; }
  /// Why no plan can be valid; nothing when cells are far enough apart.
  [[nodiscard]] std::optional<std::string> too_wide() const;
  void note(Plan& plan) const;

 private:
  [[nodiscard]] std::string widest_two() const;

  const Show& show_;
  double clearance_m_;
  bool pair_by_pair_ = false;
  std::optional<PerformerIndex> widest_;
  std::optional<PerformerIndex> second_;
};

/// Where the show's people can stand and walk: off what is blocked by half of the clearance, or the widest's radius.
[[nodiscard]] Ways ways_of(const Show& show, const WidePeople& wide);

}  // namespace footlight::planner
