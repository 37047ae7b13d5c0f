// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/check.hpp"
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
  NodeIndex node;             ///< in the rig
  std::uint16_t address = 1;  ///< DMX: the first slot, 1..512; elsewhere as the bus has them, at most 254
  std::uint8_t channels = 32;

  /// The address where it is one byte of a frame.
  [[nodiscard]] std::uint8_t unit() const { return static_cast<std::uint8_t>(address); }
};

/// What a node keeps over power-off of the plan that it was told of last, and of the patch that it was commissioned
/// with (core/rig.hpp, patch_check); 0: none.
struct KeptChecks {
  std::uint32_t plan = 0;
  std::uint32_t patch = 0;

  friend bool operator==(const KeptChecks&, const KeptChecks&) = default;
};

/// What has become of one node or of the bus, as told by the wire.
struct DeviceEvent {
  enum class Kind {
    preloaded,  ///< the node has taken the preload `sequence`; CANopen has no receipt: it has left for the wire
    showing,    ///< the node shows `crc` since latch `sequence`; `state` and `boots` are set
    booted,     ///< the node has restarted and shows NO-GUIDANCE
    missed,     ///< no answer in time, or a wrong one
    fenced,     ///< the node follows another controller, or has not heard that this one leads; LEAD goes with the next
                ///< heartbeat
    rejected,   ///< the device refused (Modbus exception, EMCY); `detail` is its code
    content,    ///< a wearable has taken the content of channel `detail` for latch `sequence`
    keeps,      ///< the node keeps `kept`
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
  KeptChecks kept{};
};

/// What a technician may ask of a device.
enum class Task : std::uint8_t { probe, identify, set_address, health, clock, patch };

[[nodiscard]] std::string_view to_text(Task task);

/// Who a device says that it is.
struct Identity {
  std::optional<std::uint32_t> unique_id;  ///< of the piece, from its maker
  std::string model;                       ///< as it says itself; may be empty
  int firmware = 0;                        ///< 0: not told
  int channels = 0;                        ///< 0: not told

  friend bool operator==(const Identity&, const Identity&) = default;
};

/// One thing that a device tells of its state: "battery", 87, "%".
struct HealthValue {
  std::string name;
  double value = 0;
  std::string unit;
};

/// What has come of a task. An operation is over when the driver is ready again: one probe may find several devices.
struct ServiceAnswer {
  enum class Kind {
    found,    ///< probe: a device is here; `identity`
    garbled,  ///< bytes that no single device sends: several at once, or a bad line
    silent,   ///< nobody has answered in time
    done,     ///< the device has said that it has done it; health: `health`
    refused,  ///< the device answers that it will not; `detail` is its code
  };
  Task task = Task::probe;
  Kind kind = Kind::silent;
  std::uint16_t address = 0;
  int detail = 0;
  Identity identity;
  std::vector<HealthValue> health;
  KeptChecks kept{};  ///< patch
};

/// What a wearable tells its wearer besides its look: where the next walk leads, and when it begins.
struct WearableContent {
  bool walks = false;          ///< false: nothing is ahead, the rest means nothing
  std::uint8_t direction = 0;  ///< 256ths of a turn, clockwise as the performer sees it who faces the audience: 0 is
                               ///< downstage (ahead), 64 stage right, 128 upstage
  std::uint16_t distance_cm = 0;
  std::uint32_t starts_ms = 0;  ///< show time, modulo 2^32: counts down to it
  std::uint16_t count_ms = 0;   ///< length of a count then

  friend bool operator==(const WearableContent&, const WearableContent&) = default;
};

/// Takes events in the order in which the wire told them. Called inside `Driver::step`.
class EventSink {
 public:
  virtual ~EventSink() = default;
  virtual void on_event(const DeviceEvent& event) = 0;
  virtual void on_answer(const ServiceAnswer& /*answer*/) {}
};

/// What a language can prove. A promise holds where the capability exists; elsewhere the marker is shown as unverified.
struct Capabilities {
  bool readback = true;      ///< shown looks can be read back
  bool lease = true;         ///< goes to NO-GUIDANCE by itself when the controller is silent
  bool proves_looks = true;  ///< what is read back carries the latch's sequence: no late answer can pass for a new one
  bool sequenced_latch = true;  ///< a latch takes only the preload of its own sequence (not CANopen)
  bool pushes_status = false;   ///< status comes by itself after each latch (CANopen TPDO)
  int looks = 254;              ///< entries that the device's look table has besides dark
  bool contents = false;        ///< wearables show direction, distance and count-down
  bool keeps_time = false;      ///< nodes follow the show's time
  bool keeps_checks = false;    ///< nodes keep checks of plan and patch
};

/// A marker language on one bus: encodes what the bus loop wants into frames, decodes what comes back. Owned and called
/// by one thread. Never blocks in simulation; holds no time of its own.
class Driver {
 public:
  virtual ~Driver() = default;

  [[nodiscard]] virtual std::string_view language() const = 0;
  [[nodiscard]] virtual Capabilities capabilities() const = 0;

  /// What is taken for granted of devices that prove nothing, for people; empty where `proves_looks`.
  [[nodiscard]] virtual std::string assumption() const { return {}; }

  /// Why nodes of this bus cannot be used, as they have said themselves: a sentence each, for people.
  [[nodiscard]] virtual std::vector<std::string> complaints() const { return {}; }

  /// What a lamp of this bus really shows for a look: a device of few colours has the nearest one.
  [[nodiscard]] virtual Look shown(const Look& look) const { return look; }
  /// What it shows by itself: after power-on, and when the controller has fallen silent.
  [[nodiscard]] virtual Look unguided() const { return no_guidance_look(); }

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

  /// From now on frames carry the plan byte of another plan. Only while `ready`: what is under way is the old plan's.
  virtual void take_plan(std::uint8_t /*plan_byte*/) {}

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

  // For wearables: only where the capability is given.
  /// Content of one channel from latch `sequence` on; told by `content`.
  virtual SendStatus send_content(const NodeAddress& /*node*/, int /*channel*/, Sequence /*sequence*/,
                                  const WearableContent& /*content*/, Instant /*now*/) {
    FL_CHECK(false && "a language with contents");
  }
  [[nodiscard]] virtual Duration content_time() const { return {}; }
  /// Show time at `now`, and how fast it goes (1: as the clock; 0: it stands), to all nodes.
  virtual SendStatus sync_time(Duration /*show_time*/, double /*rate*/, Instant /*now*/) {
    FL_CHECK(false && "a language that keeps time");
  }
  [[nodiscard]] virtual Duration sync_time_time() const { return {}; }

  // Checks: only where the capability is given.
  /// Tells all nodes which plan they are led by; nobody answers. Takes as long as an upload.
  virtual SendStatus tell_plan(std::uint32_t /*check*/, Instant /*now*/) {
    FL_CHECK(false && "a language whose nodes keep checks");
  }
  /// Told by `keeps`. A node that does not answer is not missed for it: it may not know the question.
  virtual SendStatus ask_kept(const NodeAddress& /*node*/, Instant /*now*/) {
    FL_CHECK(false && "a language whose nodes keep checks");
  }
  [[nodiscard]] virtual Duration kept_time() const { return {}; }

  // For technicians: an address need not be in the rig. What comes of it is told by `EventSink::on_answer`.
  /// Why this language, or the profile of its devices, cannot do that; empty: it can. To ask all the same is a
  /// programmer error.
  [[nodiscard]] virtual std::string_view refusal(Task task) const;
  /// Who is at this address? @param round answers of devices that share an address come in another order each round
  virtual SendStatus probe(std::uint16_t /*address*/, unsigned /*round*/, Instant /*now*/) {
    FL_CHECK(false && "a language that can probe");
  }
  virtual SendStatus identify(std::uint16_t /*address*/, bool /*on*/, Instant /*now*/) {
    FL_CHECK(false && "a language that can identify");
  }
  /// @param unique_id only the device of this id, which tells devices apart that share an address
  virtual SendStatus set_address(std::uint16_t /*from*/, std::optional<std::uint32_t> /*unique_id*/,
                                 std::uint16_t /*to*/, Instant /*now*/) {
    FL_CHECK(false && "a language that can set addresses");
  }
  virtual SendStatus ask_health(std::uint16_t /*address*/, Instant /*now*/) {
    FL_CHECK(false && "a language that can tell health");
  }
  /// What does it keep? @param patch is written first
  virtual SendStatus ask_patch(std::uint16_t /*address*/, std::optional<std::uint32_t> /*patch*/, Instant /*now*/) {
    FL_CHECK(false && "a language whose nodes keep checks");
  }
  /// How far is its clock from the time that `sync_time` has told last? Told as health.
  virtual SendStatus ask_clock(std::uint16_t /*address*/, Instant /*now*/) {
    FL_CHECK(false && "a language whose nodes have clocks");
  }

  /// Takes what has arrived, gives up what has waited too long.
  /// @return when to call again even if nothing arrives; kNever when nothing is awaited
  virtual Instant step(Instant now, EventSink& events) = 0;
};

}  // namespace footlight::drivers
