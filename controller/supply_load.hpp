// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/time.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

class CueSchedule;
struct CuePlay;

/// A cue whose looks one supply could not carry as they are.
struct DimmedCue {
  std::optional<std::size_t> cue;  ///< position in cue_plays(); none: the opening
  double factor = 1;               ///< of every brightness, above 0
  double asked_a = 0;              ///< by the looks as the show has them
};

/// What one supply of the rig has to give during a show.
struct SupplyLoad {
  std::size_t supply = 0;  ///< in rig.supplies
  int nodes = 0;
  int lamps = 0;
  double dark_a = 0;        ///< with all lamps dark
  double unguided_a = 0;    ///< while its nodes show what they do by themselves: after power-on, without a controller
  double peak_a = 0;        ///< highest, all effects at their brightest
  std::size_t peak_at = 0;  ///< switch
  double mean_a = 0;        ///< over the show, effects averaged, time at which it waits for GO left out
  std::vector<DimmedCue> dimmed;
};

/// From the supply into a lamp that shows this, at the brightest moment of its effect, in ampere: in proportion to
/// brightness and level of each colour (pulse-width modulation without correction for the eye; with it less).
[[nodiscard]] double lamp_current(const Look& look, const LampCurrents& currents);
/// Share of it that an effect takes on average (docs/wire-protocol.md, section 1).
[[nodiscard]] double mean_share(Effect effect);

/// The schedule as the rig's supplies can carry it, with its loads: looks of a cue that overload a supply are dimmed by
/// one factor, down to a twentieth of full brightness and never dark, where the supply says so. A lamp counts with what
/// its device makes of the look (Driver::shown).
/// Errors (ErrorKind::refused), a line for each supply: what it would have to give, when and for which cue.
/// @param drivers one for each bus
/// Complexity: O(switches x lamps). Without supplies nothing is done.
[[nodiscard]] Result<CueSchedule> within_supplies(CueSchedule schedule, const Rig& rig,
                                                  const std::vector<std::unique_ptr<drivers::Driver>>& drivers,
                                                  std::span<const CuePlay> plays);

/// When a node may be lit first.
struct SwitchOn {
  std::size_t supply = 0;  ///< in rig.supplies
  Duration turn{};         ///< after the controller's start, on all buses together
  Duration stagger{};      ///< from the first light of one node of the supply to that of the next; 0: all at once
};
/// For every node of the rig, in its order.
[[nodiscard]] std::vector<SwitchOn> switch_on_of(const Rig& rig);

}  // namespace footlight::controller
