// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/commission/floor_lights.hpp"
#include "app/commission/lamps.hpp"
#include "app/session.hpp"
#include "config/show_file.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// What all ways of commissioning are told.
struct CommissionChoice {
  std::string show;
  std::string output;      ///< rig file to write; empty: none
  std::string transports;  ///< transport map; empty: where the rig says
  bool simulated = false;
  std::string faults;  ///< of the simulated nodes
  std::uint64_t seed = 1;
  std::string state;  ///< folder; empty: the usual one
};

/// A show's floor that is being commissioned.
struct FloorToCommission {
  config::LoadedShow loaded;
  std::vector<FloorLamp> lamps;  ///< of loaded.rig
};

/// Errors: whatever the files have wrong; a rig without lamps on the floor, or with more than words tell apart; an
/// output that is there already or cannot come to be there.
[[nodiscard]] Result<FloorToCommission> read_floor(Session& session, const CommissionChoice& choice);

/// Opens the buses and tells which nodes do not answer. Errors: ports that cannot be opened; buses without a wire.
[[nodiscard]] Result<std::unique_ptr<FloorLights>> light_floor(Session& session, const CommissionChoice& choice,
                                                               const Rig& rig);

/// Writes the rig with lamps where they were seen, and reads it again: what is there loads.
/// @param seen for each lamp
[[nodiscard]] Status<> write_rig(const FloorToCommission& floor, const std::vector<std::optional<CellIndex>>& seen,
                                 const std::string& output);

}  // namespace footlight::app
