// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace footlight::app {

/// Where the show is, as the desk says it (docs/console.md, "The WebSocket": state).
struct DeskWord {
  enum class Phase : std::uint8_t { stands, counts_in, runs, resets, reset_held, finished };
  struct Loop {
    double from_s = 0;
    double to_s = 0;
    friend bool operator==(const Loop&, const Loop&) = default;
  };
  Phase phase = Phase::stands;
  double position_s = 0;
  double rate = 0;                  ///< seconds of the show in a second
  std::optional<double> goes_in_s;  ///< of the count-in
  std::string cue;                  ///< number; empty: none runs
  std::string standby;
  int tempo_percent = 100;
  bool holds_at_end = false;
  std::optional<Loop> loop;
  bool way = false;                 ///< there is a reset move, ready or under way
  std::optional<Loop> way_between;  ///< of the show
  std::optional<double> way_s;      ///< how far it is
  friend bool operator==(const DeskWord&, const DeskWord&) = default;
};

[[nodiscard]] std::string_view to_text(DeskWord::Phase phase);

/// One message of the desk, as far as whoever only looks needs it.
struct DeskMessage {
  struct Welcome {
    std::string plan;
    std::string run;
  };
  std::optional<Welcome> welcome;
  std::optional<DeskWord> state;
  bool epoch = false;               ///< a changed plan was taken
  std::optional<std::string> plan;  ///< the hash of its show
};

/// What is not understood is nothing: newer desks say more. Never throws, whatever comes.
[[nodiscard]] DeskMessage desk_message_from(std::string_view text);

}  // namespace footlight::app
