// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/result.hpp"
#include "core/show.hpp"
#include "core/time.hpp"

namespace footlight::config {

struct NetworkPlace {
  std::string address;  ///< IPv4 or IPv6, as numbers
  std::uint16_t port = 0;
  friend bool operator==(const NetworkPlace&, const NetworkPlace&) = default;
};

struct OscRemote {
  NetworkPlace listen;
  std::vector<std::string> from;  ///< addresses that are heard
  std::string token_file;         ///< resolved; empty: none, which only loopback may
  std::uint16_t reply_port = 0;   ///< 0: where the message came from
  std::vector<NetworkPlace> state;
  double rate_hz = 10;
};

struct MidiRemote {
  struct Macro {
    int number = 0;  ///< 0..127
    std::string order;
  };
  std::string port;
  int device = 0;  ///< 0..111; all-call is always heard
  int format = 1;  ///< command format; "all types" is always heard
  std::vector<Macro> macros;
};

struct GpioPlace {
  enum class Pull : std::uint8_t { none, up, down };
  std::string chip;
  unsigned offset = 0;
  bool active_low = false;
  Pull pull = Pull::none;
};

/// A wired input, or one that is told by OSC.
struct RemoteInput {
  std::optional<GpioPlace> line;  ///< nothing: by OSC
  Duration lost_after{};          ///< by OSC: silence after which nobody knows how it is; zero: never
};

struct RemoteButton {
  enum class Does : std::uint8_t { go, hold, emergency_hold, acknowledge, order };
  std::string name;
  Does does = Does::go;
  std::string order{};      ///< of Does::order
  std::string cue_light{};  ///< of Does::acknowledge; empty: all
  RemoteInput input{};
};

struct RemoteGate {
  std::size_t gate = 0;  ///< of the show
  RemoteInput input{};
};

struct CueLightLines {
  std::string name;
  GpioPlace red;
  GpioPlace green;
};

struct TallyLine {
  enum class Shows : std::uint8_t { running, held, alarm };
  Shows shows = Shows::running;
  GpioPlace line;
};

/// From where a show is led besides the desk, and what it tells back.
struct Remote {
  std::optional<OscRemote> osc;
  std::optional<MidiRemote> midi;
  std::vector<RemoteButton> buttons;
  std::vector<RemoteGate> gates;
  std::vector<CueLightLines> cue_lights;
  std::vector<TallyLine> tallies;
};

/// Reads the file of `footlight run --remote` (docs/remote.md). Every error of it in one run, positioned: an OSC door
/// that is open to others without a list of them and a token, a line that is used twice, a gate that the show does not
/// have.
[[nodiscard]] Result<Remote, Diagnostics> read_remote(const std::filesystem::path& file, const Show& show);

[[nodiscard]] std::string remote_schema();

}  // namespace footlight::config
