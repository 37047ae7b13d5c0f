// SPDX-License-Identifier: Apache-2.0
#include "app/remote/panel.hpp"

#include <algorithm>
#include <utility>

namespace footlight::app {
namespace {

using Does = config::RemoteButton::Does;
using Outcome = controller::Outcome;
using Phase = controller::Rehearsal::Phase;
using Shows = config::TallyLine::Shows;

/// People are sent walking.
bool sends_off(const RunEvent& answer) {
  for (const Outcome outcome : {Outcome::cue_started, Outcome::goes_on, Outcome::walks_on, Outcome::reset_started}) {
    if (answer.text == controller::to_text(outcome)) return true;
  }
  return false;
}

}  // namespace

Panel::Panel(const config::Remote& remote, Interlocks& interlocks)
    : buttons_(remote.buttons),
      pressed_(remote.buttons.size()),
      lights_(remote.cue_lights.size()),
      interlocks_(interlocks) {
  for (const config::CueLightLines& light : remote.cue_lights) names_.push_back(light.name);
}

void Panel::press(std::size_t button, controller::GoSource source, RunDesk& desk) {
  const config::RemoteButton& it = buttons_.at(button);
  const Speaker who{source, "button " + it.name};
  switch (it.does) {
    case Does::go:
      return desk.say("go", who);
    case Does::order:
      return desk.say(it.order, who);
    case Does::acknowledge:
      for (std::size_t l = 0; l < lights_.size(); ++l) {
        if (!it.cue_light.empty() && it.cue_light != names_[l]) continue;
        if (lights_[l].waits() && lights_[l].acknowledge()) {
          desk.tell({RunEvent::Kind::note, "cue light " + names_[l] + ": standby acknowledged"});
        }
      }
      return;
    case Does::hold:
    case Does::emergency_hold:
      return;  // levels, not presses
  }
}

bool Panel::is_told(std::string_view name) const {
  const auto it = std::ranges::find(buttons_, name, &config::RemoteButton::name);
  return it != buttons_.end() && !it->input.line;
}

bool Panel::holds(std::string_view name) const {
  const auto it = std::ranges::find(buttons_, name, &config::RemoteButton::name);
  return is_told(name) && (it->does == Does::hold || it->does == Does::emergency_hold);
}

bool Panel::tell_button(std::string_view name, bool pressed, Instant now, RunDesk& desk) {
  const auto it = std::ranges::find(buttons_, name, &config::RemoteButton::name);
  if (it == buttons_.end() || it->input.line) return false;
  const auto button = static_cast<std::size_t>(it - buttons_.begin());
  interlocks_.tell_button(button, pressed, now);
  const bool was = pressed_[button];
  pressed_[button] = pressed;
  if (pressed && !was) press(button, controller::GoSource::network, desk);
  return true;
}

Result<std::string> Panel::standby(const std::vector<std::string>& words) {
  if (lights_.empty()) return input_error("standby: there is no cue light");
  if (words.size() == 1 && words[0] == "off") {
    for (CueLight& light : lights_) light.off();
    return std::string("the cue lights are off");
  }
  if (!words.empty()) return input_error("standby: \"standby\" or \"standby off\" is wanted");
  for (CueLight& light : lights_) light.standby(now_);
  return std::string("the cue lights flash");
}

void Panel::look(const DeskView& view, Instant now) {
  show_ = view.show;
  now_ = now;
}

void Panel::told(const RunEvent& event) {
  if (event.kind == RunEvent::Kind::alarm) alarm_ = true;
  if (event.kind != RunEvent::Kind::answer || event.refused) return;
  if (event.order == "ok") {
    alarm_ = false;
    interlocks_.acknowledge();
  }
  if (!sends_off(event)) return;
  for (CueLight& light : lights_) light.go(now_);
}

bool Panel::tally(Shows shows) const {
  switch (shows) {
    case Shows::running:
      return show_.phase == Phase::counts_in || show_.phase == Phase::runs || show_.phase == Phase::resets;
    case Shows::held:
      return show_.phase == Phase::reset_held || (show_.phase == Phase::stands && show_.active >= 0);
    case Shows::alarm:
      return alarm_;
  }
  return false;
}

}  // namespace footlight::app
