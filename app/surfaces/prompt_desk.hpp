// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session.hpp"
#include "app/standard_input.hpp"
#include "app/surfaces/raw_terminal.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/state_text.hpp"
#include "app/surfaces/surface.hpp"

namespace footlight::app {

/// The stage manager's place: keys of a terminal, or lines of another program; what happens, in words or as lines of
/// JSON. HOLD is no emergency stop, and says so.
class PromptDesk final : public Surface {
 public:
  /// Borrows all. @param json every line on stdout is a JSON document  @param listens reads stdin
  PromptDesk(Session& session, const Show& show, const Plan& plan, RunDesk& desk, bool json, bool listens);

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override;
  [[nodiscard]] int file() const override { return input_.file(); }
  [[nodiscard]] bool listens() const override { return !input_.closed(); }

 private:
  [[nodiscard]] static std::string without_arrows(const std::string& keys);
  void read();
  void take_line(const std::string& line);
  void take_key(char key);
  void type(char key);
  void ask(std::string prefix);
  void change_tempo(int by_percent);
  void answered(const RunEvent& answer);
  void refuse(const std::string& why);
  void print(const std::string& line);
  void show_state(const DeskView& view);
  void tell_lost();

  Session& session_;
  RunDesk& desk_;
  StateText text_;
  bool json_;
  StandardInput input_;
  bool keys_;  ///< of a terminal
  std::optional<RawTerminal> terminal_;
  std::optional<std::string> prompt_;
  std::string typed_;
  Speaker me_;
  bool quit_asked_ = false;
  DeskView seen_{};
  std::string told_;  ///< the last state, without what runs
  Instant told_at_ = Instant::min();
  std::string refused_;  ///< stays in the line for a moment
  Instant refused_until_ = Instant::min();
};

}  // namespace footlight::app
