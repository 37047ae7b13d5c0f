// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "app/remote/cue_light.hpp"
#include "app/remote/interlocks.hpp"
#include "app/surfaces/run_desk.hpp"
#include "config/remote_file.hpp"

namespace footlight::app {

/// What buttons do and what lamps show, whatever wires them. Borrows the interlocks. One thread.
class Panel {
 public:
  Panel(const config::Remote& remote, Interlocks& interlocks);

  /// A button that is no hold was pressed. @param button of remote.buttons
  void press(std::size_t button, controller::GoSource source, RunDesk& desk);
  /// How a button is, by OSC, under its name. @return whether one is told so
  bool tell_button(std::string_view name, bool pressed, Instant now, RunDesk& desk);
  /// Whether a button of that name is told by OSC; whether it holds while it is pressed.
  [[nodiscard]] bool is_told(std::string_view name) const;
  [[nodiscard]] bool holds(std::string_view name) const;
  /// The order "standby", "standby off".
  Result<std::string> standby(const std::vector<std::string>& words);

  void look(const DeskView& view, Instant now);
  void told(const RunEvent& event);

  [[nodiscard]] CueLight::Lamps cue_light(std::size_t light) { return lights_.at(light).lamps(now_); }
  [[nodiscard]] bool tally(config::TallyLine::Shows shows) const;

 private:
  std::vector<config::RemoteButton> buttons_;
  std::vector<bool> pressed_;  ///< by OSC
  std::vector<std::string> names_;
  std::vector<CueLight> lights_;
  Interlocks& interlocks_;
  ShowState show_;
  Instant now_{};
  bool alarm_ = false;
};

}  // namespace footlight::app
