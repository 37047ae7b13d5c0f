// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "core/rig.hpp"
#include "drivers/devices/modbus/marker_registers.hpp"
#include "drivers/driver.hpp"
#include "drivers/leading.hpp"

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
/// no broadcast gets everything node by node.
///
/// Exceptions: 1-3, 7, 8 are `rejected`, never to be sent again; 4 is tried once more first; 5 and 6 are `rejected`
/// until later; 10 and 11 are a gateway's word for `missed`. An answer of another unit, function or length is `missed`.
///
/// Late answers. RTU has nothing to tell them by, so an answer that comes after its time-out would be taken for the
/// answer to the next request, and every later one with it. Therefore
/// - after a time-out or garbage no unit is asked until the line has been quiet for 20 ms (broadcasts go out, for the
///   moment does not wait), and what nobody waits for is thrown away before each request;
/// - a question for the status is of 6 registers, and as long as one of them is open, of another length: a late answer
///   is one of the wrong length. 5 and 4 registers say as much; 3, 2 and 1 only that the node has come to this
///   question, which is then asked in full. A node that leaves all six open is not asked for a second;
/// - from a node that owes an answer a preload's receipt is not believed: its status is read back, and `preloaded` is
///   told when that carries the preload's sequence.
/// Devices answer in order, so a right status ends the doubt. Assumed is: no answer is a second late after a second of
/// silence. A profile without preload sequence or status has only the quiet time: there an answer that is more than
/// that late is assumed not to happen.
class ModbusDriver final : public Driver {
 public:
  /// @param port borrowed for the life of the driver; it gives up on silent devices itself (Outcome::timeout)
  /// @param leadership borrowed; null: it leads without an epoch
  ModbusDriver(ModbusPort& port, ModbusProfile profile, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte,
               Leadership* leadership = nullptr);

  [[nodiscard]] std::string_view language() const override { return "modbus"; }
  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] std::string assumption() const override;
  [[nodiscard]] Look shown(const Look& look) const override { return modbus::nearest_look(profile_, look); }
  [[nodiscard]] Look unguided() const override;
  [[nodiscard]] Duration preload_time(int channels) const override;
  [[nodiscard]] Duration status_time() const override;
  /// Until the last node has it; without a latch register every node's preload.
  [[nodiscard]] Duration latch_time() const override;
  [[nodiscard]] Duration heartbeat_time() const override;
  [[nodiscard]] Duration upload_time() const override;
  [[nodiscard]] bool ready() const override;

  void take_plan(std::uint8_t plan_byte) override;
  SendStatus start(Instant now) override;
  SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                     Instant now) override;
  SendStatus latch(Sequence sequence, Instant now) override;
  SendStatus heartbeat(Duration show_time, Instant now) override;
  SendStatus ask(const NodeAddress& node, Instant now) override;
  SendStatus upload_look(LookIndex index, const Look& look, Instant now) override;
  SendStatus tell_plan(std::uint32_t check, Instant now) override;
  SendStatus ask_kept(const NodeAddress& node, Instant now) override;
  [[nodiscard]] Duration kept_time() const override;
  [[nodiscard]] std::string_view refusal(Task task) const override;
  SendStatus probe(std::uint16_t address, unsigned round, Instant now) override;
  SendStatus identify(std::uint16_t address, bool on, Instant now) override;
  SendStatus set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                         Instant now) override;
  SendStatus ask_health(std::uint16_t address, Instant now) override;
  SendStatus ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) override;
  Instant step(Instant now, EventSink& events) override;

 private:
  enum class Purpose { preload, read_back, latch, late_write, heartbeat, status, looks, look, kept, service };
  struct Job {
    Purpose purpose = Purpose::status;
    NodeIndex node;  ///< of a request to one unit
    Sequence sequence = 0;
    ModbusRequest request;
    bool retried = false;
    bool last = true;  ///< of the requests of its operation to this node
  };
  /// What is known of a node that can be asked for its status.
  struct Known {
    std::optional<std::uint16_t> boots;
    std::uint8_t open = 0;  ///< bit n: a question of n registers has not been answered
    Instant asked_at;       ///< the last question
    bool owes = false;      ///< an answer that may still come, to whatever request
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
  void finish(const Job& job, const ModbusReply& reply, Instant now, EventSink& events);
  void refuse(const Job& job, std::uint8_t code, EventSink& events);
  void receipt(const Job& job, Instant now, EventSink& events);
  void take_status(const Job& job, const ModbusReply& reply, Instant now, EventSink& events);
  void ask_on(const Job& job, Purpose purpose, Instant now, EventSink& events);
  void tell_looks(const Job& job, const ModbusReply& reply, EventSink& events);
  void tell_bus(EventSink& events);
  void take_kept(const Job& job, const ModbusReply& reply, bool same, Instant now, EventSink& events);
  void begin_quiet(Instant now);
  void end_quiet(Instant now);
  /// Of a length that no open question has; nothing when all are open.
  std::optional<ModbusRequest> question(NodeIndex node, std::uint8_t unit, Instant now);

  ModbusPort& port_;
  ModbusProfile profile_;
  std::vector<NodeAddress> nodes_;
  Leadership* leadership_;  ///< null: it leads without an epoch
  unsigned beats_since_lead_ = 0;
  bool lead_due_ = false;                ///< before anything else: nodes do not know the plan byte yet
  std::atomic<std::uint8_t> plan_byte_;  ///< budgets are asked by other threads, too
  std::map<NodeIndex, Known> known_;
  std::map<NodeIndex, Kept> kept_;        ///< profiles without a latch
  std::map<NodeIndex, Written> pending_;  ///< preloaded, not latched: values read back
  std::map<NodeIndex, Written> written_;  ///< latched: what a reading should give
  std::array<Look, 256> looks_;           ///< as uploaded
  std::vector<DeviceEvent> due_;          ///< told by the next step
  std::optional<ServiceAnswer> service_;  ///< a technician's request under way
  std::optional<Job> under_way_;
  std::deque<Job> jobs_;  ///< the rest of an operation, a second try, a read-back
  bool paused_ = false;   ///< the device wants time after a write
  Instant pause_until_{};
  Instant expected_ = kNever;  ///< when the reply should be there
  bool quiet_ = false;         ///< no unit is asked
  Instant quiet_until_{};
  int quiet_rounds_ = 0;  ///< in which something was still heard
  bool down_ = false;
  bool down_told_ = false;
};

}  // namespace footlight::drivers
