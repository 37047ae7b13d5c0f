// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "app/remote/osc_packet.hpp"
#include "app/remote/remote_call.hpp"

namespace footlight::app {

/// A button or gate that is told by OSC.
struct OscInput {
  bool gate = false;
  std::string name;
  bool on = false;  ///< pressed, closed
  friend bool operator==(const OscInput&, const OscInput&) = default;
};

/// What an OSC message asks for.
struct OscAsked {
  enum class Kind : std::uint8_t {
    call,     ///< for the desk
    input,    ///< how a button or gate is
    connect,  ///< `call.text` is the token
    state,    ///< to be told the state once
    nothing,  ///< a button of a control surface that was let go: 0 as the only argument; or a sign of life
    unknown,  ///< `why` says what would be right
  };
  Kind kind = Kind::unknown;
  RemoteCall call{};
  OscInput input{};
  std::string why{};
};

/// /go /stop /pause /resume /panic /standby /cue/{number}/start /cue/{number}/load /connect /thump
/// /footlight/order s, /footlight/button s i, /footlight/gate s i, /footlight/state. Pure.
[[nodiscard]] OscAsked asked_by(const OscMessage& message);

}  // namespace footlight::app
