// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "app/load.hpp"
#include "app/readiness/early_desk.hpp"
#include "app/readiness/readiness.hpp"
#include "app/session.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

struct ReadyOptions {
  Scope scope = Scope::rehearsal;

  void add_options(CLI::App& command);
};

struct BusesToAsk {
  const Rig& wires;  ///< with its real URLs
  /// Of the run that is taken up, as Readiness::outlives: nobody has time to look at lamps. None: a run of its own.
  std::optional<std::string> outlived{};
};

/// What has to be done before a show has the buses for itself, where the scope lets it have them: all buses are asked
/// at once who is there, by unique id where their devices have one; two devices at one address lock GO. Where the scope
/// is live, three lamps are lit one after the other, each alone, until somebody has confirmed them on stdin, or at
/// `desk`. Not where a run is taken up. Tells `readiness`. Errors: a bus that cannot be opened or asked, where the
/// scope is live; interrupted, also when somebody ends the run at the desk.
[[nodiscard]] Status<> preflight(Session& session, const BusesToAsk& buses, const Show& show, Readiness& readiness,
                                 EarlyDesk& desk);

}  // namespace footlight::app
