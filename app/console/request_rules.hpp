// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/console/access.hpp"

namespace footlight::app {

/// The other end of a connection.
struct Caller {
  std::string from;  ///< its address
  /// On this machine, but not known to be of the program's own user, or root.
  bool stranger = false;
};

/// What a request asks for, as far as it decides what may be answered. Nothing here owns its text.
struct AskedFor {
  enum class Method : std::uint8_t { get, post, other };
  Method method = Method::get;
  std::string_view target;  ///< as on the request line: "/api/looks/3.bin"
  std::string_view host;
  int hosts = 1;  ///< Host lines
  std::string_view origin;
  int origins = 0;
  std::string_view authorization;
  std::string_view content_type;
  std::string_view footlight;  ///< X-Footlight
  bool upgrade = false;        ///< to a WebSocket
  bool stranger = false;       ///< Caller::stranger
  /// The numeric address at which it has arrived, and its port as browsers add it (":8440", nothing for 80): no name
  /// that a stranger owns leads browsers to say this.
  std::string_view local{};
  std::string_view local_port{};
};

enum class Route : std::uint8_t { page, show, plan, looks, way, pair, socket };

/// What is answered.
struct Verdict {
  int status = 200;  ///< of HTTP; from 400 on the request is refused
  std::string why;   ///< it is refused, and what would be right
  Route route = Route::page;
  std::size_t number = 0;  ///< switch of `looks`
};

/// What the console was told about who may speak to it.
struct ConsoleRules {
  AllowedHosts hosts;
  std::vector<std::string> local_names{};  ///< that mean the address itself, with its port: "localhost"
  bool needs_token = false;
  std::string token;                           ///< the admin's
  Role most = Role::admin;                     ///< that anybody may be
  std::string host_option = "--console-host";  ///< adds to `hosts`; for messages
};

/// The role of a token: the admin's own, or one that a code was good for; without a token the admin where none is
/// needed, but for strangers.
[[nodiscard]] std::optional<Role> role_of(const ConsoleRules& rules, const Pairing& pairing, std::string_view token,
                                          bool stranger);

/// Every rule of docs/console.md that a request can break before its body is read. Pure; O(length of the request).
[[nodiscard]] Verdict judge(const AskedFor& asked, const ConsoleRules& rules, const Pairing& pairing);

}  // namespace footlight::app
