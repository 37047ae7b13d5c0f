// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "app/readiness/probes.hpp"
#include "app/readiness/readiness.hpp"
#include "app/surfaces/run_desk.hpp"
#include "core/clock.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// The desk of a run before its show has the buses: surfaces see what is ready and what is asked, `probe yes` answers,
/// and every other order is refused, since nothing is there yet that could carry it out. Borrows all.
class EarlyDesk {
 public:
  EarlyDesk(const Show& show, const Plan& plan, const Rig& rig, Readiness& readiness, const Clock& clock);

  /// @param surface one that needs no lamps to be worth a look
  void add(Surface& surface);
  /// Lets the surfaces look; to be called every 50 ms or so.
  void look();
  /// From now on until it is answered. @param question in whole words  @param cell where the lamp in question is
  void ask(std::string question, std::string cell);
  /// What somebody has answered since `ask`, and who.
  struct Said {
    ProbeAnswer answer = ProbeAnswer::unclear;
    std::string who;
  };
  [[nodiscard]] const std::optional<Said>& said() const { return said_; }
  /// Nothing is asked any more.
  void asked() { question_.reset(); }
  [[nodiscard]] bool quits() const { return quits_; }
  /// Whether somebody may answer here.
  [[nodiscard]] bool listens() const { return listens_; }

 private:
  Result<std::string> answer(const std::vector<std::string>& words, const Speaker& who);

  RunDesk desk_;
  Readiness& readiness_;
  const Clock& clock_;
  DeskView view_;
  std::optional<ReadinessView::Question> question_;
  std::optional<Said> said_;
  bool quits_ = false;
  bool listens_ = false;
};

}  // namespace footlight::app
