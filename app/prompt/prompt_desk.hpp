// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live/live_run.hpp"
#include "app/prompt/orders.hpp"
#include "app/prompt/raw_terminal.hpp"
#include "app/prompt/state_text.hpp"
#include "app/session.hpp"
#include "app/standard_input.hpp"

namespace footlight::app {

/// The stage manager's place: keys of a terminal, or lines of another program; what happens, in words or as lines of
/// JSON. HOLD is no emergency stop, and says so.
class PromptDesk {
 public:
  /// Borrows all. @param json every line on stdout is a JSON document  @param listens reads stdin
  PromptDesk(Session& session, const Show& show, const Plan& plan, bool json, bool listens);

  /// Everything that has been said since the last time, and tells what has changed.
  DeskWishes look(const DeskView& view);
  void answered(const Answer& answer);
  /// A line of the run's course.
  void tell(std::string_view what, const std::string& line);
  /// Until somebody says something, at most so long.
  void wait(Duration most) const { input_.wait(most); }

 private:
  void read();
  void take_line(const std::string& line);
  void take_key(char key);
  void type(char key);
  void ask(std::string prefix);
  void order(controller::Command::Kind kind, int percent = 100);
  void refuse(const std::string& why);
  void show_state(const DeskView& view);

  Session& session_;
  Orders orders_;
  StateText text_;
  bool json_;
  StandardInput input_;
  bool keys_;  ///< of a terminal
  std::optional<RawTerminal> terminal_;
  std::optional<std::string> prompt_;
  std::string typed_;
  bool quit_asked_ = false;
  DeskWishes wishes_;
  DeskView seen_{};
  std::string told_;  ///< the last state, without what runs
  Instant told_at_ = Instant::min();
  std::string refused_;  ///< stays in the line for a moment
  Instant refused_until_ = Instant::min();
};

}  // namespace footlight::app
