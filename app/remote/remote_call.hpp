// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/live/live_run.hpp"
#include "app/surfaces/surface.hpp"
#include "controller/cue_list.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// What a remote control asks for, whatever language it speaks.
struct RemoteCall {
  enum class Kind : std::uint8_t {
    go,
    hold,
    resume,     ///< goes on after a hold, and never starts a cue
    start_cue,  ///< GO, if `text` is the standby cue
    load_cue,   ///< asks for the way to cue `text`; GO confirms it
    top,
    order,  ///< `text` in the words of the desk
  };
  Kind kind = Kind::go;
  std::string text{};
  friend bool operator==(const RemoteCall&, const RemoteCall&) = default;
};

/// In the words of the desk. People are not lamps: no call starts a cue before which they would have to be elsewhere.
/// @param view the show as it is now  Errors (ErrorKind::input) say what would be right.
[[nodiscard]] Result<std::string> words_of(const RemoteCall& call, const DeskView& view,
                                           const std::vector<controller::CuePlay>& plays);

/// For all to see that an order was not even understood.
[[nodiscard]] RunEvent refusal_of(std::string order, Speaker who, std::string why);

}  // namespace footlight::app
