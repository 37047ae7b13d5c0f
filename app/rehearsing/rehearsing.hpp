// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/freeze_report.hpp"
#include "app/freeze_watch.hpp"
#include "app/rehearsing/mute_orders.hpp"
#include "app/rehearsing/pace_orders.hpp"
#include "app/rehearsing/rehearsal_log.hpp"
#include "app/surfaces/run_desk.hpp"
#include "controller/tempo_limit.hpp"
#include "core/clock.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace CLI {
class App;
}

namespace footlight::app {

struct RehearsingOptions {
  std::string report;  ///< file of the rehearsal's report; empty: in the state folder alone
  void add_options(CLI::App& command);
};

/// What a rehearsal has besides the show: notes and its report, solo and mute, tapped tempo, standby, whether a freeze
/// is safe. Facts and orders of one desk.
class Rehearsing final : private Surface {
 public:
  /// Borrows all. @param state folder, is there
  Rehearsing(const Show& show, const Plan& plan, RunDesk& desk, const std::filesystem::path& state,
             RehearsingOptions options);

  void set_limits(std::vector<controller::TempoLimit> limits) { limits_ = std::move(limits); }
  /// Writes the report. @param live null: the run was interrupted  @return what could not be written, a line each
  [[nodiscard]] std::vector<std::string> finish(const LiveReport* live);

 private:
  void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
  void plan_taken() override {
    freeze_.plan_taken(waits_of(plays_));
    limits_.clear();
  }
  [[nodiscard]] bool listens() const override { return false; }

  const Show& show_;
  std::filesystem::path state_;
  RehearsingOptions options_;
  SteadyClock clock_;
  const std::vector<controller::CuePlay>& plays_;  ///< of the desk
  std::vector<controller::TempoLimit> limits_;
  FreezeWatch freeze_;
  RehearsalLog log_;
  MuteOrders mutes_;
  PaceOrders pace_;
};

}  // namespace footlight::app
