// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/index.hpp"
#include "core/look.hpp"
#include "core/time.hpp"
#include "drivers/transport.hpp"

namespace footlight::drivers {

/// Latch sequence on every wire: 1..240, wrapping; 0 means none (docs/wire-protocol.md, section 1).
using Sequence = std::uint8_t;
inline constexpr Sequence kLastSequence = 240;

/// CRC-16/CCITT-FALSE: what nodes return of the looks they show.
[[nodiscard]] std::uint16_t looks_crc(std::span<const LookIndex> looks);

/// The controller renews the markers' lease this often (docs/wire-protocol.md).
inline constexpr Duration kHeartbeatPeriod = milliseconds(250);

/// A node as its bus knows it.
struct NodeAddress {
  NodeIndex node;  ///< in the rig
  std::uint8_t address = 1;
  std::uint8_t channels = 32;
};

/// What has become of one node or of the bus, as told by the wire.
struct DeviceEvent {
  enum class Kind {
    preloaded,  ///< the node has taken the preload `sequence`; CANopen has no receipt: it has left for the wire
    showing,    ///< the node shows `crc` since latch `sequence`; `state` and `boots` are set
    booted,     ///< the node has restarted and shows NO-GUIDANCE
    missed,     ///< no answer in time, or a wrong one
    rejected,   ///< the device refused (Modbus exception, EMCY); `detail` is its code
    bus_down,   ///< on CAN `detail` is the CanState
    bus_up,
  };
  /// When a request that was refused may be sent again.
  enum class Again : std::uint8_t {
    soon,   ///< like one that was missed
    later,  ///< the device is busy: after a while, and a longer one each time
    never,  ///< the same will be refused again
  };
  Kind kind = Kind::missed;
  NodeIndex node;
  Sequence sequence = 0;
  std::uint16_t crc = 0;
  std::uint8_t state = 0;
  std::uint16_t boots = 0;
  std::uint16_t detail = 0;
  Again again = Again::soon;
};

/// Takes events in the order in which the wire told them. Called inside `Driver::step`.
class EventSink {
 public:
  virtual ~EventSink() = default;
  virtual void on_event(const DeviceEvent& event) = 0;
};

/// What a language can prove. A promise holds where the capability exists; elsewhere the marker is shown as unverified.
struct Capabilities {
  bool readback = true;         ///< shown looks can be read back
  bool lease = true;            ///< goes to NO-GUIDANCE by itself when the controller is silent
  bool sequenced_latch = true;  ///< a latch takes only the preload of its own sequence (not CANopen)
  bool pushes_status = false;   ///< status comes by itself after each latch (CANopen TPDO)
};

/// A marker language on one bus: encodes what the bus loop wants into frames, decodes what comes back. Owned and called
/// by one thread. Never blocks in simulation; holds no time of its own.
class Driver {
 public:
  virtual ~Driver() = default;

  [[nodiscard]] virtual std::string_view language() const = 0;
  [[nodiscard]] virtual Capabilities capabilities() const = 0;

  /// Budget on the wire, receipts, silences and turnarounds included, without faults. Pure.
  [[nodiscard]] virtual Duration preload_time(int channels) const = 0;
  /// One node's; the answers to a latch (`pushes_status`) take as much each.
  [[nodiscard]] virtual Duration status_time() const = 0;
  /// From handing over a latch on an idle bus until its last bit is on the wire.
  [[nodiscard]] virtual Duration latch_time() const = 0;
  [[nodiscard]] virtual Duration heartbeat_time() const = 0;  ///< 0 where there is no lease
  /// Heartbeats that the nodes send by themselves in one kHeartbeatPeriod.
  [[nodiscard]] virtual Duration node_heartbeats_time() const { return {}; }
  [[nodiscard]] virtual Duration upload_time() const = 0;  ///< one look; 0 where the device has no look table

  /// True when another operation would be accepted now.
  [[nodiscard]] virtual bool ready() const = 0;

  // Operations: accepted means under way; what comes of it is told by events of the following steps. Step once after
  // each, which tells when to step next.
  virtual SendStatus start(Instant now) = 0;  ///< wakes the nodes of the bus (CANopen NMT start; nothing elsewhere)
  /// @param looks as many as the node has channels
  virtual SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                             Instant now) = 0;
  virtual SendStatus latch(Sequence sequence, Instant now) = 0;
  virtual SendStatus heartbeat(Duration show_time, Instant now) = 0;
  /// Asks for a node's status. On CANopen busy between a preload and its latch: the SYNC that asks would be the latch.
  virtual SendStatus ask(const NodeAddress& node, Instant now) = 0;
  virtual SendStatus upload_look(LookIndex index, const Look& look, Instant now) = 0;

  /// Takes what has arrived, gives up what has waited too long.
  /// @return when to call again even if nothing arrives; kNever when nothing is awaited
  virtual Instant step(Instant now, EventSink& events) = 0;
};

}  // namespace footlight::drivers
