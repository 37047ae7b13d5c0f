// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/file_descriptor.hpp"
#include "core/result.hpp"
#include "sim/endpoints/endpoint.hpp"
#include "sim/modbus_line.hpp"

namespace footlight::sim {

/// A Modbus TCP bus on a port of the loopback address, as a gateway with all its nodes.
class TcpEndpoint final : public Endpoint {
 public:
  static constexpr std::size_t kMostClients = 32;

  /// @param port 0: any that is free. Errors: ErrorKind::input, with what the machine said.
  static Result<std::unique_ptr<TcpEndpoint>> open(int port, ModbusLine& bus);

  [[nodiscard]] std::string url() const override { return "tcp://127.0.0.1:" + std::to_string(port_); }
  void add_handles(std::vector<pollfd>& files) const override;
  Instant step(Instant now) override;
  [[nodiscard]] bool used() const override { return used_; }

 private:
  struct Client {
    FileDescriptor socket;
    std::vector<std::uint8_t> heard;
  };

  TcpEndpoint(FileDescriptor listener, int port, ModbusLine& bus)
      : listener_(std::move(listener)), port_(port), bus_(bus) {}
  void welcome();
  /// @return false when the client has gone, or speaks something else
  bool listen_to(int number, Client& client);

  FileDescriptor listener_;
  int port_;
  ModbusLine& bus_;
  std::map<int, Client> clients_;  ///< by a number that is never used again
  int next_client_ = 0;
  bool used_ = false;
};

}  // namespace footlight::sim
