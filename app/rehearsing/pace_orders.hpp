// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/rehearsing/tap_tempo.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/surface.hpp"
#include "core/clock.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// "tap" (a tempo, by tapping it) and "standby 12", "standby up", "standby down" (which cue GO starts next).
class PaceOrders final : public Surface {
 public:
  /// Borrows both.
  PaceOrders(const Show& show, const Clock& clock) : show_(show), clock_(clock) {}

  void add_to(RunDesk& desk);
  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] bool listens() const override { return false; }

 private:
  Result<std::string> tap(const Speaker& who);
  Result<std::string> standby(const std::vector<std::string>& words, const Speaker& who);

  const Show& show_;
  const Clock& clock_;
  TapTempo taps_;
  RunDesk* desk_ = nullptr;
  ShowState seen_{};
};

}  // namespace footlight::app
