// SPDX-License-Identifier: Apache-2.0
#include "app/remote/interlocks.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace footlight::app {
namespace {

using controller::Bars;
using Does = config::RemoteButton::Does;

std::string_view word_of(GateView::State state) {
  switch (state) {
    case GateView::State::closed:
      return "closed";
    case GateView::State::open:
      return "open";
    case GateView::State::lost:
      return "lost, nobody knows";
    case GateView::State::by_word:
      return "closed by the operator's word";
  }
  return "";
}

}  // namespace

Interlocks::Interlocks(const std::vector<std::string>& gates, const config::Remote& remote, Instant now) {
  FL_CHECK(gates.size() <= kMostGates);
  const auto input = [&](const config::RemoteInput& from) {
    return Input{from.lost_after, !from.line.has_value(), now, true};
  };
  for (const std::string& name : gates) gates_.push_back({name, false, {}, false, false});
  for (const config::RemoteGate& one : remote.gates) {
    gate_inputs_.push_back(one.gate);
    Gate& gate = gates_.at(one.gate);
    gate.has_input = true;
    gate.input = input(one.input);
  }
  for (const config::RemoteButton& one : remote.buttons) {
    Button button{one.name,
                  one.does == Does::hold || one.does == Does::emergency_hold,
                  one.does == Does::emergency_hold,
                  input(one.input),
                  false,
                  false};
    button.input.lost = false;
    buttons_.push_back(std::move(button));
  }
}

void Interlocks::hear(Gate& gate, bool closed, Instant now) {
  const auto before = state_of(gate);
  gate.input.told = now;
  gate.input.lost = false;
  gate.closed = closed;
  const auto after = state_of(gate);
  if (after == before || gate.by_word) return;
  if (closed) return note(gate.name + ": closed");
  if (before == GateView::State::lost) return note(gate.name + ": open");  // it was no better before
  alarm(gate.name + ": open");
}

void Interlocks::hear(Button& button, bool pressed, Instant now) {
  button.input.told = now;
  if (std::exchange(button.input.lost, false)) note("button " + button.name + ": heard again");
  if (!button.holds || std::exchange(button.pressed, pressed) == pressed) return;
  if (!pressed) return note("button " + button.name + ": out");
  button.latched = button.emergency;
  alarm((button.emergency ? "EMERGENCY HOLD by button " : "HOLD by button ") + button.name +
        ". HOLD changes lamps and stops no machine");
}

void Interlocks::tell_gate(std::size_t index, bool closed, Instant now) {
  hear(gates_.at(gate_inputs_.at(index)), closed, now);
}

void Interlocks::tell_button(std::size_t index, bool pressed, Instant now) { hear(buttons_.at(index), pressed, now); }

void Interlocks::lose_gate(std::size_t index, const std::string& why) {
  Gate& gate = gates_.at(gate_inputs_.at(index));
  if (std::exchange(gate.input.lost, true)) return;
  alarm(gate.name + ": lost: " + why);
}

void Interlocks::lose_button(std::size_t index, const std::string& why) {
  Button& button = buttons_.at(index);
  if (std::exchange(button.input.lost, true)) return;
  alarm("button " + button.name + ": lost: " + why + (button.holds ? ". It holds nothing any more" : ""));
}

bool Interlocks::tell_gate(std::string_view name, bool closed, Instant now) {
  for (Gate& gate : gates_) {
    if (gate.name != name || !gate.has_input || !gate.input.by_osc) continue;
    hear(gate, closed, now);
    return true;
  }
  return false;
}

bool Interlocks::is_told(std::string_view name) const {
  return std::ranges::any_of(
      gates_, [&](const Gate& gate) { return gate.name == name && gate.has_input && gate.input.by_osc; });
}

Result<std::string> Interlocks::by_word(std::string_view name, bool closed) {
  std::string all;
  for (Gate& gate : gates_) {
    all += (all.empty() ? "" : ", ") + gate.name;
    if (gate.name != name) continue;
    gate.by_word = closed;
    return gate.name + ": " + std::string(word_of(state_of(gate)));
  }
  if (gates_.empty()) return input_error("gate: the show has none");
  return input_error("gate: no gate \"" + std::string(name) + "\" (there are " + all + ")");
}

void Interlocks::take_up_emergency_hold() {
  taken_up_ = true;
  alarm("EMERGENCY HOLD from before this program was begun again. HOLD changes lamps and stops no machine");
}

void Interlocks::acknowledge() {
  taken_up_ = false;
  for (Button& button : buttons_) {
    if (!button.pressed) button.latched = false;
  }
}

void Interlocks::step(Instant now) {
  const auto silent = [&](const Input& input) {
    return input.by_osc && input.lost_after > Duration{} && now - input.told > input.lost_after;
  };
  for (std::size_t g = 0; g < gate_inputs_.size(); ++g) {
    if (silent(gates_[gate_inputs_[g]].input)) lose_gate(g, "nothing is heard of it");
  }
  for (std::size_t b = 0; b < buttons_.size(); ++b) {
    if (silent(buttons_[b].input)) lose_button(b, "nothing is heard of it");
  }
}

GateView::State Interlocks::state_of(const Gate& gate) {
  if (gate.by_word) return GateView::State::by_word;
  if (!gate.has_input || gate.input.lost) return GateView::State::lost;
  return gate.closed ? GateView::State::closed : GateView::State::open;
}

Bars Interlocks::bars() const {
  Bars bars = 0;
  for (std::size_t g = 0; g < gates_.size(); ++g) {
    const auto state = state_of(gates_[g]);
    if (state == GateView::State::open || state == GateView::State::lost) bars |= Bars{1} << g;
  }
  for (const Button& button : buttons_) {
    if (button.latched) bars |= controller::kEmergencyHold;
    if (button.pressed) bars |= controller::kHoldPressed;
  }
  if (taken_up_) bars |= controller::kEmergencyHold;
  return bars;
}

std::vector<std::string> Interlocks::text_of(Bars bars) const {
  std::vector<std::string> texts;
  for (std::size_t g = 0; g < gates_.size(); ++g) {
    if (((bars >> g) & 1U) != 0) texts.push_back(gates_[g].name + ": " + std::string(word_of(state_of(gates_[g]))));
  }
  if (taken_up_ && (bars & controller::kEmergencyHold) != 0) {
    texts.emplace_back("emergency hold from before this program was begun again");
  }
  for (const Button& button : buttons_) {
    if (button.latched && (bars & controller::kEmergencyHold) != 0) {
      texts.push_back("emergency hold by button " + button.name + (button.pressed ? ", which is still in" : ""));
    } else if (button.pressed && (bars & controller::kHoldPressed) != 0) {
      texts.push_back("button " + button.name + " is pressed");
    }
  }
  return texts;
}

std::vector<GateView> Interlocks::gates() const {
  std::vector<GateView> out;
  for (const Gate& gate : gates_) out.push_back({gate.name, state_of(gate)});
  return out;
}

}  // namespace footlight::app
