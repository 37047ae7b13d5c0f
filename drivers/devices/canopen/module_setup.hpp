// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/rig.hpp"
#include "drivers/devices/canopen/sdo_client.hpp"
#include "drivers/driver.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers::canopen {

/// One object that is written, or read and compared.
struct SetupStep {
  ObjectPlace place;
  std::uint32_t value = 0;
  int bytes = 1;                    ///< of a write; 0: read and compare
  std::uint32_t mask = 0xFFFFFFFF;  ///< bits that have to be equal when read

  [[nodiscard]] bool reads() const { return bytes == 0; }
};

/// What a module of digital outputs is told before the show (docs/wire-protocol.md, section 3), in the order of CiA
/// 301, 7.5.2.36 and 7.5.2.38: the RPDO is made invalid, its mapping cleared, written, counted, and the RPDO made valid
/// again; then safe state, heartbeats and what the profile adds. All of it is read back in the end. Pure.
[[nodiscard]] std::vector<SetupStep> setup_steps(const OutputModule& module, std::uint8_t node);

/// In words, for the codes of CiA 301, 7.2.4.3.17: "the object cannot be mapped to the PDO".
[[nodiscard]] std::string abort_meaning(std::uint32_t code);

/// RPDO1: the outputs of all channels, eight a byte, channel 0 in the lowest bit of the first.
/// @param lit one a channel, at most module.outputs
[[nodiscard]] CanFrame outputs(const OutputModule& module, std::uint8_t node, const std::vector<bool>& lit);

/// Configures the modules of one bus by SDO, one transfer at a time. Holds no port: it says what to send and is told
/// what came.
class ModuleSetup {
 public:
  ModuleSetup(OutputModule module, const std::vector<NodeAddress>& nodes);

  [[nodiscard]] const OutputModule& module() const { return module_; }
  /// The node has to be set up, again if it was. A transfer with it that is under way counts for nothing.
  void want(std::uint8_t node, Instant now);
  [[nodiscard]] bool is_set_up(std::uint8_t node) const { return nodes_[position(node)].state == State::done; }
  /// It has refused something, and will refuse it again.
  [[nodiscard]] bool refuses(std::uint8_t node) const { return nodes_[position(node)].state == State::refused; }
  [[nodiscard]] bool under_way() const { return current_ >= 0; }

  void hear(const CanFrame& frame, Instant now);
  /// What has become of a node in this step; 0: nothing has happened.
  struct Outcome {
    std::uint8_t done = 0;     ///< may be started
    std::uint8_t silent = 0;   ///< has not answered; is asked again a second later
    std::uint8_t refused = 0;  ///< see complaints()
  };
  /// @param may_begin false: no node is begun with now  @param outbox takes what is to be sent
  Outcome step(Instant now, bool may_begin, std::deque<CanFrame>& outbox);
  /// The bus is gone: what was under way is begun anew.
  void abandon(Instant now);
  /// When to step next; kNever: only when something arrives.
  [[nodiscard]] Instant next() const;

  /// Nodes that cannot be used, a sentence each, in the order of the bus.
  [[nodiscard]] std::vector<std::string> complaints() const;

 private:
  enum class State { idle, wanted, done, refused };
  struct Node {
    std::uint8_t address = 0;
    State state = State::idle;
    Instant from;  ///< not before
    std::string complaint;
  };

  /// In nodes_. The address is one of the bus.
  [[nodiscard]] std::size_t position(std::uint8_t address) const;
  void ask(Instant now, std::deque<CanFrame>& outbox);
  [[nodiscard]] std::string refusal_of_step() const;

  OutputModule module_;
  std::vector<Node> nodes_;
  std::ptrdiff_t current_ = -1;  ///< position of the node under way
  std::vector<SetupStep> steps_;
  std::size_t step_ = 0;
  SdoClient sdo_;
  Instant deadline_ = kNever;
};

}  // namespace footlight::drivers::canopen
