// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/endpoints/endpoint.hpp"
#include "sim/endpoints/pseudo_terminal.hpp"
#include "sim/endpoints/rtu_framing.hpp"
#include "sim/modbus_line.hpp"

namespace footlight::sim {

/// A Footlight serial bus, or a DMX widget, on a pseudo-terminal.
class SerialEndpoint final : public Endpoint {
 public:
  SerialEndpoint(PseudoTerminal terminal, drivers::ByteStream& bus, std::string scheme = "serial")
      : terminal_(std::move(terminal)), bus_(bus), scheme_(std::move(scheme)) {}
  [[nodiscard]] std::string url() const override { return scheme_ + "://" + terminal_.link().string(); }
  void add_handles(std::vector<pollfd>& files) const override;
  Instant step(Instant now) override;
  [[nodiscard]] bool used() const override { return used_; }

 private:
  static constexpr std::size_t kPiece = 1024;  ///< less than the bus's buffer
  PseudoTerminal terminal_;
  drivers::ByteStream& bus_;
  std::string scheme_;
  std::array<std::uint8_t, kPiece> waiting_{};  ///< read and not yet taken by the bus
  std::size_t waiting_size_ = 0;
  bool used_ = false;
};

/// A Modbus RTU line on a pseudo-terminal.
class RtuEndpoint final : public Endpoint {
 public:
  RtuEndpoint(PseudoTerminal terminal, ModbusLine& bus) : terminal_(std::move(terminal)), bus_(bus) {}
  [[nodiscard]] std::string url() const override { return "rtu://" + terminal_.link().string(); }
  void add_handles(std::vector<pollfd>& files) const override;
  Instant step(Instant now) override;
  [[nodiscard]] bool used() const override { return used_; }

 private:
  PseudoTerminal terminal_;
  ModbusLine& bus_;
  RtuFraming framing_;
  bool used_ = false;
};

}  // namespace footlight::sim
