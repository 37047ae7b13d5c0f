// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/audit_log.hpp"
#include "app/console/order_box.hpp"
#include "app/console/peer_owner.hpp"
#include "app/console/request_rules.hpp"
#include "app/console/room.hpp"
#include "app/live/node_board.hpp"
#include "app/surfaces/surface.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"

namespace footlight::app {

class ServerWorks;

/// The console's HTTP and WebSocket server (docs/console.md): one thread of ordinary priority that owns all of its
/// connections. Members are for the calling thread of the run; each hands over and returns.
class ConsoleServer {
 public:
  static constexpr std::size_t kMostConnections = 128;
  static constexpr std::size_t kMostOfOneAddress = 32;  ///< that is not loopback

  struct Settings {
    std::string address = "127.0.0.1";  ///< numeric
    std::uint16_t port = 0;             ///< 0: any that is free
    ConsoleRules rules{};
    Room::About about{};
    const NodeBoard* nodes = nullptr;  ///< borrowed; null: nothing is known of nodes
    std::function<std::optional<uid_t>(int)> owner_of = owner_of_peer;
    // Times that tests make shorter.
    Duration headers_within = milliseconds(5000);
    Duration body_within = milliseconds(10'000);
    Duration silent_for = milliseconds(30'000);  ///< a WebSocket that does not even answer pings
  };

  /// Listens from here on. Borrows all but the settings. @param audit null: nothing is written
  /// Errors (ErrorKind::input): the address is not one of this machine, or somebody else listens there.
  [[nodiscard]] static Result<std::unique_ptr<ConsoleServer>> open(Settings settings, OrderBox& orders, AuditLog* audit,
                                                                   const Clock& clock);
  /// Tells everybody that the run has ended, and waits a moment for them to hear it.
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// @param show, plan the documents of this epoch
  void take_show(std::uint32_t epoch, const std::string& plan_hash, Letter show, Letter plan);
  /// @param way null: there is none
  void take_way(Letter way);
  void state(std::string json, std::string cue);
  void health(std::string json);
  void untold(std::string json);
  void told(const RunEvent& event);

  /// Switches whose looks somebody asks for.
  [[nodiscard]] std::vector<std::size_t> looks_wanted();
  /// @param looks null: there is no such switch
  void take_looks(std::size_t k, Letter looks);

 private:
  explicit ConsoleServer(std::unique_ptr<ServerWorks> works);
  std::unique_ptr<ServerWorks> works_;
};

}  // namespace footlight::app
