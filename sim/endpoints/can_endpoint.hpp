// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/file_descriptor.hpp"
#include "core/result.hpp"
#include "drivers/transport.hpp"
#include "sim/endpoints/endpoint.hpp"

namespace footlight::sim {

/// The nodes of a CAN bus on a SocketCAN interface: a virtual one, or one with a real controller at the other end.
class CanEndpoint final : public Endpoint {
 public:
  /// @param socket raw and non-blocking, bound to `interface`
  CanEndpoint(FileDescriptor socket, std::string interface, drivers::CanPort& bus)
      : socket_(std::move(socket)), interface_(std::move(interface)), bus_(bus) {}
  /// Errors: ErrorKind::device, with what the machine said.
  static Result<std::unique_ptr<CanEndpoint>> open(const std::string& interface, drivers::CanPort& bus);

  [[nodiscard]] std::string url() const override { return "can://" + interface_; }
  void add_handles(std::vector<pollfd>& files) const override;
  Instant step(Instant now) override;
  [[nodiscard]] bool used() const override { return used_; }

 private:
  void listen();

  FileDescriptor socket_;
  std::string interface_;
  drivers::CanPort& bus_;
  std::deque<drivers::CanFrame> heard_;  ///< not yet taken by the bus
  std::deque<drivers::CanFrame> said_;   ///< not yet taken by the interface
  bool used_ = false;
};

}  // namespace footlight::sim
