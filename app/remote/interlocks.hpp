// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/live/live_run.hpp"
#include "config/remote_file.hpp"
#include "controller/bars.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// What stands against walking: gates of the show and hold buttons, however they are told.
///
/// A gate counts as closed when its input says so; an input that is gone, or silent for longer than it may be, is lost,
/// which is as good as open. Any change for the worse counts at once. A gate can be answered for by the operator's
/// word, until somebody takes that back. An emergency hold stays until it is acknowledged with its button out. Pure:
/// time comes in. One thread.
class Interlocks {
 public:
  /// What somebody has to be told.
  struct News {
    bool alarm = false;
    std::string text;
  };

  /// @param gates names, of the show  @param remote which inputs there are
  Interlocks(const std::vector<std::string>& gates, const config::Remote& remote, Instant now);

  // What inputs say. @param index into remote.gates or remote.buttons
  void tell_gate(std::size_t index, bool closed, Instant now);
  void lose_gate(std::size_t index, const std::string& why);
  void tell_button(std::size_t index, bool pressed, Instant now);
  void lose_button(std::size_t index, const std::string& why);
  /// By OSC, under its name. @return whether there is such a one that is told by OSC
  bool tell_gate(std::string_view name, bool closed, Instant now);
  [[nodiscard]] bool is_told(std::string_view gate) const;

  /// The operator answers for a gate, or no more. Errors say which gates there are.
  Result<std::string> by_word(std::string_view gate, bool closed);
  /// Another program led, and nobody had acknowledged an emergency hold: it stays here, too.
  void take_up_emergency_hold();
  /// Emergency holds whose buttons are out are over.
  void acknowledge();
  /// Nobody has acknowledged it yet.
  [[nodiscard]] bool emergency_hold() const { return (bars() & controller::kEmergencyHold) != 0; }
  /// What has been silent for too long is lost.
  void step(Instant now);

  [[nodiscard]] controller::Bars bars() const;
  /// For people: "trap closed: open". @param bars those to name
  [[nodiscard]] std::vector<std::string> text_of(controller::Bars bars) const;
  [[nodiscard]] std::vector<GateView> gates() const;
  /// Since the last call.
  [[nodiscard]] std::vector<News> news() { return std::exchange(news_, {}); }

 private:
  struct Input {
    Duration lost_after{};
    bool by_osc = false;
    Instant told{};
    bool lost = false;
  };
  struct Gate {
    std::string name;
    bool has_input = false;
    Input input;
    bool closed = false;
    bool by_word = false;
  };
  struct Button {
    std::string name;
    bool holds = false;  ///< else nothing of ours
    bool emergency = false;
    Input input;
    bool pressed = false;
    bool latched = false;
  };
  void hear(Gate& gate, bool closed, Instant now);
  void hear(Button& button, bool pressed, Instant now);
  [[nodiscard]] static GateView::State state_of(const Gate& gate);
  void alarm(std::string text) { news_.push_back({true, std::move(text)}); }
  void note(std::string text) { news_.push_back({false, std::move(text)}); }

  std::vector<Gate> gates_;               ///< of the show
  std::vector<std::size_t> gate_inputs_;  ///< of remote.gates: which of them
  std::vector<Button> buttons_;
  bool taken_up_ = false;  ///< an emergency hold, and nobody knows whose
  std::vector<News> news_;
};

}  // namespace footlight::app
