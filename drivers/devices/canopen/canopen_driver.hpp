// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "drivers/devices/canopen/canopen_frames.hpp"
#include "drivers/devices/canopen/module_setup.hpp"
#include "drivers/devices/canopen/sdo_client.hpp"
#include "drivers/driver.hpp"
#include "drivers/leading.hpp"

namespace footlight::drivers {

/// CANopen markers (docs/wire-protocol.md, section 3): RPDOs preload, SYNC latches, TPDO1 tells what is shown.
///
/// An RPDO has no receipt: `preloaded` says that all frames of the preload have left the port, `showing` alone is
/// proof. A SYNC asks every node at once; `ask` sends one with the last sequence, which changes no lamp, and is busy
/// between a preload and its latch, where it would be the latch. Nodes that boot or that wait in pre-operational are
/// started by the driver itself. A node is `missed` when it leaves a SYNC unanswered and for each 2.5 s of its silence.
///
/// A bus of output modules (CiA 401) is another matter: each module is configured by SDO (ModuleSetup) before it is
/// started, and again after it has booted; until then its preloads are `rejected` for later, and for ever once it has
/// refused an object (complaints()). RPDO1 preloads and SYNC latches as well, but nothing proves what is shown.
///
/// A driver that leads says its epoch before its first frame, once a second, when it was away for a while and when it
/// hears an older one. CAN frames do not say whose they are, but everybody hears everybody: a driver that hears a newer
/// epoch, or a node's refusal, sends nothing more for as long as a fence stands, not even what waits in its outbox.
///
/// A bus on which nothing leaves is down (CanState::stalled and beyond; the event's detail is the state). Then nothing
/// but heartbeats is put on it, to find out when it is back: what stands in a queue for so long comes too late, and of
/// a heartbeat that does no harm.
class CanopenDriver final : public Driver {
 public:
  /// @param port borrowed for the life of the driver
  /// @param modules absent: our own markers  @param leadership borrowed; null: it leads without an epoch
  CanopenDriver(CanPort& port, const std::vector<NodeAddress>& nodes, const std::optional<OutputModule>& modules = {},
                Leadership* leadership = nullptr);

  [[nodiscard]] std::string_view language() const override { return "canopen"; }
  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] std::string assumption() const override;
  [[nodiscard]] std::vector<std::string> complaints() const override;
  [[nodiscard]] Look shown(const Look& look) const override;
  [[nodiscard]] Look unguided() const override;
  [[nodiscard]] Duration preload_time(int channels) const override;
  /// One node's TPDO: a single SYNC asks all of them.
  [[nodiscard]] Duration status_time() const override;
  [[nodiscard]] Duration latch_time() const override;
  [[nodiscard]] Duration heartbeat_time() const override;
  [[nodiscard]] Duration node_heartbeats_time() const override;
  [[nodiscard]] Duration upload_time() const override;
  [[nodiscard]] bool ready() const override;

  SendStatus start(Instant now) override;
  SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                     Instant now) override;
  SendStatus latch(Sequence sequence, Instant now) override;
  SendStatus heartbeat(Duration show_time, Instant now) override;
  SendStatus ask(const NodeAddress& node, Instant now) override;
  SendStatus upload_look(LookIndex index, const Look& look, Instant now) override;

  SendStatus tell_plan(std::uint32_t check, Instant now) override;
  /// By SDO, beside whatever else the bus has to do.
  SendStatus ask_kept(const NodeAddress& node, Instant now) override;
  [[nodiscard]] Duration kept_time() const override;

  // By SDO; every step of it may take 50 ms, and until then nothing else is accepted.
  [[nodiscard]] std::string_view refusal(Task task) const override;
  SendStatus probe(std::uint16_t address, unsigned round, Instant now) override;
  SendStatus identify(std::uint16_t address, bool on, Instant now) override;
  SendStatus ask_health(std::uint16_t address, Instant now) override;
  SendStatus ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) override;

  Instant step(Instant now, EventSink& events) override;

 private:
  /// One object that is read or written.
  struct Transfer {
    canopen::ObjectPlace place;
    std::vector<std::uint8_t> written{};  ///< empty: read
  };
  /// Objects of one node, one after the other.
  struct Service {
    ServiceAnswer answer;
    std::vector<Transfer> transfers;
    std::size_t next = 0;
    Instant deadline;
    std::optional<NodeIndex> of_show{};  ///< asked by the show: told as an event, and nothing waits for it
  };
  struct NodeState {
    NodeAddress address;
    Instant heard;                       ///< last frame, or when we began to listen
    bool operational = false;            ///< as far as it has told
    bool start_due = false;              ///< NMT start is to be sent
    bool awaits_status = false;          ///< owes a TPDO for the last SYNC
    std::optional<std::uint16_t> boots;  ///< since its last boot-up message
  };
  struct Preload {
    NodeIndex node;
    Sequence sequence = 0;
    std::uint64_t last_frame = 0;  ///< count of frames handed to the port, with its own last one
  };

  void hear_lead(std::uint32_t epoch, Instant now);
  void fall_silent(Instant now);
  void set_up_on(Instant now, EventSink& events);
  /// Of one node's answer, or of any frame of its length.
  [[nodiscard]] Duration frame_time() const { return port_.wire_time(canopen::status_pdo_shape()); }
  [[nodiscard]] bool down() const { return port_.state() >= CanState::stalled; }
  SendStatus hand_over(const CanFrame& frame);
  SendStatus send_sync(Sequence sequence, Instant now);
  void pump();
  void hear(const CanFrame& frame, Instant now, EventSink& events);
  void hear_status(NodeState& node, const canopen::StatusPdo& status, EventSink& events);
  void hear_heartbeat(NodeState& node, std::uint8_t state, EventSink& events);
  void tell_preloads(EventSink& events);
  void tell_bus(Instant now, EventSink& events);
  Instant tell_missed(Instant now, EventSink& events);
  SendStatus serve(Task task, std::uint16_t address, std::vector<Transfer> transfers, Instant now);
  static void tell(const Service& service, EventSink& events);
  void ask_next_object(Service& service, Instant now);
  void hear_sdo(const CanFrame& frame, Instant now);
  void serve_on(Instant now, EventSink& events);
  [[nodiscard]] NodeState* find(std::uint8_t address);

  CanPort& port_;
  Leadership* leadership_;  ///< null: it leads without an epoch
  unsigned beats_since_lead_ = 0;
  bool lead_due_ = false;          ///< before anything else
  Instant stepped_at_ = kNever;    ///< last; kNever: not yet
  Instant silent_until_ = kStart;  ///< another controller leads
  bool silent_ = false;
  std::vector<NodeState> nodes_;
  std::array<std::int16_t, 128> by_address_{};  ///< -1: not ours
  std::deque<CanFrame> outbox_;                 ///< accepted by us, not yet by the port
  std::optional<Preload> leaving_;              ///< the preload whose frames stand in the outbox
  std::deque<Preload> on_the_way_;              ///< handed to the port, perhaps not yet on the wire
  std::uint64_t handed_over_ = 0;
  canopen::SdoClient sdo_;
  std::optional<Service> service_;
  std::optional<canopen::ModuleSetup> setup_;  ///< of output modules
  std::array<bool, 256> lit_{};                ///< looks that light an output
  std::vector<DeviceEvent> told_later_;        ///< in the next step
  Sequence last_sequence_ = 0;
  bool started_ = false;
  bool unlatched_ = false;  ///< a preload has been sent since the last SYNC
  bool down_told_ = false;
  Instant status_deadline_ = kNever;
};

}  // namespace footlight::drivers
