// SPDX-License-Identifier: Apache-2.0
#include "app/remote/panel_surface.hpp"

#include <utility>

#include <sys/epoll.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

using Does = config::RemoteButton::Does;
using drivers::GpioSettings;
using Event = drivers::PushButton::Event;

constexpr Duration kAgain = milliseconds(1000);

GpioSettings input_settings(const config::GpioPlace& place) {
  GpioSettings settings;
  settings.direction = GpioSettings::Direction::input;
  settings.active_low = place.active_low;
  settings.bias = place.pull == config::GpioPlace::Pull::up     ? GpioSettings::Bias::pull_up
                  : place.pull == config::GpioPlace::Pull::down ? GpioSettings::Bias::pull_down
                                                                : GpioSettings::Bias::as_is;
  return settings;
}

}  // namespace

PanelSurface::PanelSurface(Interlocks& interlocks, Panel& panel, const Clock& clock, bool listens, OpenLine open_line)
    : interlocks_(interlocks),
      panel_(panel),
      clock_(clock),
      listens_(listens),
      open_line_(std::move(open_line)),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  FL_CHECK(epoll_.get() >= 0);
}

Result<std::unique_ptr<PanelSurface>> PanelSurface::open(const config::Remote& remote, Interlocks& interlocks,
                                                         Panel& panel, const Clock& clock, bool listens,
                                                         OpenLine open_line) {
  std::unique_ptr<PanelSurface> surface(new PanelSurface(interlocks, panel, clock, listens, std::move(open_line)));
  surface->add_inputs(remote);
  surface->add_lamps(remote);
  std::string refused;
  const auto note = [&](const Status<>& opened) {
    if (!opened) refused += (refused.empty() ? "" : "\n") + opened.error().message;
  };
  for (Input& input : surface->inputs_) note(surface->open(input));
  for (Lamp& lamp : surface->lamps_) note(surface->open(lamp));
  if (!refused.empty()) return device_error(refused);
  return surface;
}

void PanelSurface::add_inputs(const config::Remote& remote) {
  for (std::size_t b = 0; b < remote.buttons.size(); ++b) {
    const config::RemoteButton& button = remote.buttons[b];
    if (!button.input.line) continue;
    const bool holds = button.does == Does::hold || button.does == Does::emergency_hold;
    inputs_.push_back({*button.input.line, false, b, holds, button.name});
  }
  for (std::size_t g = 0; g < remote.gates.size(); ++g) {
    if (remote.gates[g].input.line) inputs_.push_back({*remote.gates[g].input.line, true, g, true, ""});
  }
}

void PanelSurface::add_lamps(const config::Remote& remote) {
  for (std::size_t l = 0; l < remote.cue_lights.size(); ++l) {
    lamps_.push_back({remote.cue_lights[l].red, [this, l] { return panel_.cue_light(l).red; }});
    lamps_.push_back({remote.cue_lights[l].green, [this, l] { return panel_.cue_light(l).green; }});
  }
  for (const config::TallyLine& tally : remote.tallies) {
    lamps_.push_back({tally.line, [this, shows = tally.shows] { return panel_.tally(shows); }});
  }
}

Status<> PanelSurface::open(Input& input) {
  auto line = open_line_(input.place, input_settings(input.place));
  if (!line) return std::move(line).error();
  if (input.holds) {
    // A gate is open until its contact says otherwise; a hold button is out.
    input.level.emplace(std::move(line).value(), !input.gate, false);
  } else {
    input.button.emplace(std::move(line).value());
  }
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  const int file = input.holds ? input.level->poll_handle() : input.button->poll_handle();
  (void)::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, file, &wanted);  // else it is polled
  return Done{};
}

Status<> PanelSurface::open(Lamp& lamp) {
  GpioSettings settings;
  settings.active_low = lamp.place.active_low;
  auto line = open_line_(lamp.place, settings);
  if (!line) return std::move(line).error();
  lamp.line = std::move(line).value();
  lamp.shown.reset();
  return Done{};
}

void PanelSurface::look(const DeskView& view, RunDesk& desk) {
  const Instant now = clock_.now();
  panel_.look(view, now);
  for (Input& input : inputs_) read(input, now, desk);
  interlocks_.step(now);
  const controller::Bars bars = interlocks_.bars();
  desk.bar(controller::kHolding, false);
  desk.bar(bars, true);
  for (const Interlocks::News& news : interlocks_.news()) {
    desk.tell({news.alarm ? RunEvent::Kind::alarm : RunEvent::Kind::note, news.text});
  }
  for (Lamp& lamp : lamps_) show(lamp, now, desk);
}

void PanelSurface::read(Input& input, Instant now, RunDesk& desk) {
  if (!input.level && !input.button) {
    if (now < input.again_at) return;
    input.again_at = now + kAgain;
    if (!open(input)) return;
  }
  if (input.holds) return read_level(input, now);
  read_presses(input, now, desk);
}

void PanelSurface::read_level(Input& input, Instant now) {
  const auto level = input.level->step(now);
  if (!level) return lose(input, now, level.error().message);
  if (input.gate) return interlocks_.tell_gate(input.index, *level, now);
  interlocks_.tell_button(input.index, *level, now);
}

void PanelSurface::read_presses(Input& input, Instant now, RunDesk& desk) {
  while (true) {
    const auto event = input.button->step(now);
    if (!event) return lose(input, now, event.error().message);
    switch (event.value()) {
      case Event::none:
        return interlocks_.tell_button(input.index, false, now);
      case Event::pressed:
        panel_.press(input.index, controller::GoSource::button, desk);
        break;
      case Event::stuck:
        desk.tell({RunEvent::Kind::alarm, "button " + input.name +
                                              " has been pressed for more than 5 s and is switched off until it has "
                                              "been out for as long; the others count"});
        break;
      case Event::freed:
        desk.tell({RunEvent::Kind::note, "button " + input.name + " counts again"});
        break;
    }
  }
}

void PanelSurface::lose(Input& input, Instant now, const std::string& why) {
  input.level.reset();
  input.button.reset();
  input.again_at = now + kAgain;
  if (input.gate) return interlocks_.lose_gate(input.index, why);
  interlocks_.lose_button(input.index, why);
}

void PanelSurface::show(Lamp& lamp, Instant now, RunDesk& desk) {
  if (!lamp.line) {
    if (now < lamp.again_at) return;
    lamp.again_at = now + kAgain;
    if (!open(lamp)) return;
    lamp.told = false;
  }
  const bool lit = lamp.lit();
  if (lamp.shown == lit) return;
  const auto set = lamp.line->set(lit);
  if (set) {
    lamp.shown = lit;
    return;
  }
  lamp.line.reset();
  lamp.again_at = now + kAgain;
  if (!std::exchange(lamp.told, true)) desk.tell({RunEvent::Kind::alarm, "lamp: " + set.error().message});
}

}  // namespace footlight::app
