// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "controller/crowd.hpp"
#include "core/look.hpp"
#include "core/show.hpp"

namespace footlight::controller {

/// Who has to do with one cell at a moment.
struct CellUse {
  std::optional<PerformerIndex> stands;     ///< stands on it, walking or announced or not
  std::optional<PerformerIndex> walks_to;   ///< walks to it now; the first to arrive
  std::optional<PerformerIndex> announced;  ///< will walk to it at the next move; the first to arrive
  Instant arrives{};                        ///< of `walks_to`
  Instant next_arrives{};                   ///< of `announced`
};

/// What a lamp tells, and to whom. No role: dark.
struct Lamp {
  std::optional<LampRole> role;
  PerformerIndex whose;

  friend bool operator==(const Lamp&, const Lamp&) = default;
};

[[nodiscard]] constexpr bool is_goal(const Lamp& lamp) { return lamp.role && *lamp.role != LampRole::here; }

/// The table of docs/looks.md, "Floor markers".
[[nodiscard]] Lamp lamp_of(const CellUse& use, bool reserve);
/// The table of docs/looks.md, "Wearables". @param reserve whether she stands on a reserve cell
[[nodiscard]] Lamp wearable_of(PerformerIndex performer, const Doing& doing, bool reserve);

/// Everybody's doings seen from the floor. @param uses resized to `cells` and overwritten
/// @param without people who are left out; empty: nobody is
void uses_of(std::span<const Doing> doing, std::size_t cells, std::vector<CellUse>& uses,
             const std::vector<bool>& without = {});

/// A role's look where the show does not choose one.
[[nodiscard]] LookChoice default_choice(LampRole role);

/// Patterns by which neighbours tell their lamps apart. Pattern 0 is the show's own look; bit 0 is another shade of the
/// colour, bit 1 another rhythm of the effect.
inline constexpr int kPatterns = 4;
[[nodiscard]] Look with_pattern(Look look, int pattern);

}  // namespace footlight::controller
