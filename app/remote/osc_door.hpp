// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/remote/osc_packet.hpp"
#include "config/remote_file.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Who may say something by OSC, which has no identity of its own: addresses on a list, and a token, which a client
/// says once (`/connect TOKEN`, forgotten after a minute of silence) or as the last argument of every message.
///
/// It keeps strangers and accidents out, not somebody who can read the network: the token goes over it in clear, and an
/// address can be forged. Pure. One thread.
class OscDoor {
 public:
  /// @param token empty: none is wanted
  OscDoor(std::vector<std::string> from, std::string token) : from_(std::move(from)), token_(std::move(token)) {}

  /// Before anything is read of what it sent.
  [[nodiscard]] bool knows(std::string_view address) const;
  /// @return whether the token is right
  bool connect(const config::NetworkPlace& client, std::string_view token, Instant now);
  /// Whether it may say this; takes the token off its arguments.
  bool lets_in(const config::NetworkPlace& client, OscMessage& message, Instant now);

  static constexpr Duration kForgotten = milliseconds(60'000);
  static constexpr std::size_t kMostClients = 64;

 private:
  [[nodiscard]] bool is_token(std::string_view said) const;

  std::vector<std::string> from_;
  std::string token_;
  std::map<std::pair<std::string, std::uint16_t>, Instant> heard_;  ///< clients that have said the token
};

/// The secret of a token file. Errors (ErrorKind::input): not readable, readable by others, too short.
[[nodiscard]] Result<std::string> read_osc_token(const std::string& file);

}  // namespace footlight::app
