// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "core/rig.hpp"
#include "drivers/devices/modbus/marker_registers.hpp"
#include "drivers/driver.hpp"

namespace footlight::drivers {

/// Modbus markers (docs/wire-protocol.md, section 4) by a device profile, RTU or TCP.
///
/// One request at a time. Latch, heartbeat and look table are broadcasts (unit 0); over TCP, which has none, the port
/// sends them to each node in turn.
/// What a profile lacks: without a latch register the looks are kept here and written, node by node, when the latch
/// of their sequence comes; without a heartbeat register there is no lease and `heartbeat` does nothing; without a
/// status register `ask` reads the looks back where the profile says that they can be read (their values fit or do not;
/// no sequence tells an old answer from a new one), and tells nothing where they cannot; without a look table
/// `upload_look` sends nothing, and a device with numbers of its own is told the nearest of them. A device that knows
/// no broadcast gets everything node by node. Exceptions 1-3, 5, 6
/// and above are `rejected` with their code (whether to wait and try again is the bus loop's affair); 4 is tried once
/// more first. An answer of another unit, function or length is `missed`.
class ModbusDriver final : public Driver {
 public:
  /// @param port borrowed for the life of the driver; it gives up on silent devices itself (Outcome::timeout)
  ModbusDriver(ModbusPort& port, ModbusProfile profile, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte);

  [[nodiscard]] std::string_view language() const override { return "modbus"; }
  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] std::string assumption() const override;
  [[nodiscard]] Duration preload_time(int channels) const override;
  [[nodiscard]] Duration status_time() const override;
  /// Until the last node has it; without a latch register every node's preload.
  [[nodiscard]] Duration latch_time() const override;
  [[nodiscard]] Duration heartbeat_time() const override;
  [[nodiscard]] Duration upload_time() const override;
  [[nodiscard]] bool ready() const override;

  SendStatus start(Instant now) override;
  SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                     Instant now) override;
  SendStatus latch(Sequence sequence, Instant now) override;
  SendStatus heartbeat(Duration show_time, Instant now) override;
  SendStatus ask(const NodeAddress& node, Instant now) override;
  SendStatus upload_look(LookIndex index, const Look& look, Instant now) override;
  [[nodiscard]] std::string_view refusal(Task task) const override;
  SendStatus probe(std::uint16_t address, unsigned round, Instant now) override;
  SendStatus identify(std::uint16_t address, bool on, Instant now) override;
  SendStatus set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                         Instant now) override;
  SendStatus ask_health(std::uint16_t address, Instant now) override;
  Instant step(Instant now, EventSink& events) override;

 private:
  enum class Purpose { preload, latch, late_write, heartbeat, status, looks, look, service };
  struct Job {
    Purpose purpose = Purpose::status;
    NodeIndex node;  ///< of a request to one unit
    Sequence sequence = 0;
    ModbusRequest request;
    bool retried = false;
    bool last = true;  ///< of the requests of its operation to this node
  };
  /// What has been written to a node that is read back by its values.
  struct Written {
    Sequence sequence = 0;
    std::vector<LookIndex> looks;
  };
  /// Looks that a device without a latch gets when the latch comes.
  struct Kept {
    NodeAddress node;
    Sequence sequence = 0;
    std::vector<LookIndex> looks;
  };

  [[nodiscard]] std::vector<LookIndex> values_of(std::span<const LookIndex> looks) const;
  [[nodiscard]] Duration time_of(const modbus::Requests& requests) const;
  /// Jobs of one broadcast: to all at once, or to one node after the other.
  [[nodiscard]] std::vector<Job> to_all(Purpose purpose, Sequence sequence,
                                        const std::function<modbus::Requests(std::uint8_t unit)>& make) const;
  static void append(std::vector<Job>& jobs, Purpose purpose, NodeIndex node, Sequence sequence,
                     modbus::Requests requests);
  void drop_rest_of(const Job& job);
  SendStatus serve(Task task, std::uint16_t address, modbus::Requests requests, Instant now);
  void finish_service(const Job& job, const ModbusReply& reply, EventSink& events);
  void take_service(const Job& job, const ModbusReply& reply);
  SendStatus run(std::vector<Job> jobs, Instant now);
  SendStatus submit(const Job& job, Instant now);
  void submit_next(Instant now, EventSink& events);
  void finish(const Job& job, const ModbusReply& reply, EventSink& events);
  void tell_status(const Job& job, const ModbusReply& reply, EventSink& events);
  void tell_looks(const Job& job, const ModbusReply& reply, EventSink& events);
  void tell_bus(EventSink& events);

  ModbusPort& port_;
  ModbusProfile profile_;
  std::vector<NodeAddress> nodes_;
  std::uint8_t plan_byte_;
  std::map<NodeIndex, std::optional<std::uint16_t>> boots_;  ///< last known
  std::map<NodeIndex, Kept> kept_;                           ///< profiles without a latch
  std::map<NodeIndex, Written> pending_;                     ///< preloaded, not latched: values read back
  std::map<NodeIndex, Written> written_;                     ///< latched: what a reading should give
  std::array<Look, 256> looks_;                              ///< as uploaded
  std::vector<DeviceEvent> due_;                             ///< told by the next step
  std::optional<ServiceAnswer> service_;                     ///< a technician's request under way
  std::optional<Job> under_way_;
  std::deque<Job> jobs_;  ///< late writes, a second try
  bool paused_ = false;   ///< the device wants time after a write
  Instant pause_until_{};
  Instant expected_ = kNever;  ///< when the reply should be there
  bool down_ = false;
  bool down_told_ = false;
};

}  // namespace footlight::drivers
