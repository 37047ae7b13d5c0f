// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/live/live_run.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// What a run may do.
enum class Scope : std::uint8_t {
  none,         ///< nothing is opened: the checks alone
  rehearsal,    ///< GO is there from the beginning; what is not ready is shown
  live,         ///< GO is refused until every stage is done and somebody has armed it
  lights_only,  ///< nobody is on the stage: as rehearsal, and places are nobody's concern
};
[[nodiscard]] std::string_view to_text(Scope scope);

/// What a show needs before its GO is armed, in this order. Pure; no clock, no thread.
///
/// Each stage is told by facts, again and again. An error keeps GO from being armed until it is mended or somebody
/// overrides it, which makes it a warning and is told with the name of who did; two devices at one address cannot be
/// overridden. Once armed GO stays armed: nothing of this stops a show.
class Readiness {
 public:
  enum class Stage : std::uint8_t { show, plan, buses, roll_call, plan_on_nodes, probes, looks, time };
  static constexpr std::size_t kStages = 8;
  static constexpr std::size_t kLongestOutlives = 8192;
  enum class State : std::uint8_t { off, next, waiting, success, skipped, warning, error };
  struct Report {
    std::string_view name;
    State state = State::off;
    std::string text;
    bool overridden = false;
  };

  explicit Readiness(Scope scope);

  /// A fact. @param state off, waiting, success, skipped, warning or error  @param lock it stays for the whole run, and
  /// nobody overrides it
  void tell(Stage stage, State state, std::string text, bool lock = false);
  /// "roll-call". Errors: no such stage; nothing to override; a lock.
  Result<std::string> override_stage(std::string_view name, std::string_view who);
  /// Errors: what is not done, all of it; a scope without GO.
  Result<std::string> arm();
  Result<std::string> disarm();

  /// What another program has to know that takes this run up, as text: whether GO is armed, what somebody has said of
  /// the probe lamps, what is locked and what is overridden. At most kLongestOutlives bytes.
  [[nodiscard]] std::string outlives() const;
  /// Goes on as the run that said so, in this scope; before anything else is told. Who stood armed stands armed, nobody
  /// else does: where the text is not one, or of a run in another scope, nobody has looked at the probe lamps.
  void take_up(std::string_view outlives);

  [[nodiscard]] Scope scope() const { return scope_; }
  [[nodiscard]] bool armed() const { return armed_; }
  /// Whether GO has to be refused now.
  [[nodiscard]] bool refuses_go() const;
  [[nodiscard]] std::vector<Report> report() const;
  /// Why GO is refused: "roll-call: 3 of 96 nodes silent"; empty when it is not.
  [[nodiscard]] std::vector<std::string> against() const;

 private:
  struct Fact {
    State state = State::off;
    std::string text;
    bool lock = false;
    std::string overridden_by;
    std::string overridden;  ///< this text; another error is another decision
  };
  [[nodiscard]] State state_of(const Fact& fact) const;
  [[nodiscard]] bool locked() const;

  Scope scope_;
  std::array<Fact, kStages> facts_;
  bool armed_ = false;
};

[[nodiscard]] std::string_view to_text(Readiness::Stage stage);
[[nodiscard]] std::string_view to_text(Readiness::State state);

/// All stages, for people; as a JSON object.
[[nodiscard]] std::string stages_text(const Readiness& readiness);
[[nodiscard]] std::string stages_json(const Readiness& readiness);

/// "left-3, left-4 and 2 more nodes"
[[nodiscard]] std::string names_text(const std::vector<std::string>& nodes);
/// "12 of 3,290 markers silent: left-3, left-4 and 2 more nodes". @param silent names of nodes
[[nodiscard]] std::string silence_text(std::size_t silent_markers, std::size_t markers,
                                       const std::vector<std::string>& silent);

/// "this bus cannot be fenced: front-dmx (nothing there refuses another controller)"; empty where all can.
[[nodiscard]] std::string unfenced_text(const std::vector<Bus>& buses);

}  // namespace footlight::app
