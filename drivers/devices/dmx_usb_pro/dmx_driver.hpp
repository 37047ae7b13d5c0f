// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/rig.hpp"
#include "drivers/devices/dmx_usb_pro/dmx_frames.hpp"
#include "drivers/driver.hpp"

namespace footlight::drivers {

/// DMX lamps behind a DMX USB Pro widget. Lamps know levels and no looks: effects are played here, so a packet goes
/// out every 25 ms while a lamp has one, else every second. The widget repeats the last packet by itself, for ever.
///
/// DMX goes one way and has no check sum: nothing is read back, there is no lease, and a latch is the first packet
/// with the new levels. A node's address is the first slot of its first lamp; its lamps follow each other.
class DmxDriver final : public Driver {
 public:
  /// @param port borrowed for the life of the driver
  DmxDriver(ByteStream& port, DmxFixture fixture, const std::vector<NodeAddress>& nodes);

  [[nodiscard]] std::string_view language() const override { return "dmx-usb-pro"; }
  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] std::string assumption() const override;
  [[nodiscard]] Look shown(const Look& look) const override { return dmx::shown(fixture_, look); }
  [[nodiscard]] Look unguided() const override { return {{}, Effect::steady, 0}; }
  [[nodiscard]] Duration preload_time(int /*channels*/) const override { return {}; }  // nothing goes out
  [[nodiscard]] Duration status_time() const override { return {}; }
  /// The message to the widget, and one packet on the line.
  [[nodiscard]] Duration latch_time() const override;
  [[nodiscard]] Duration heartbeat_time() const override { return {}; }
  [[nodiscard]] Duration upload_time() const override { return {}; }
  [[nodiscard]] bool ready() const override { return !line_taken_ && due_.empty(); }

  SendStatus start(Instant now) override;
  SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                     Instant now) override;
  SendStatus latch(Sequence sequence, Instant now) override;
  SendStatus heartbeat(Duration show_time, Instant now) override;
  SendStatus ask(const NodeAddress& node, Instant now) override;
  SendStatus upload_look(LookIndex index, const Look& look, Instant now) override;
  [[nodiscard]] std::string_view refusal(Task task) const override;
  SendStatus identify(std::uint16_t address, bool on, Instant now) override;
  Instant step(Instant now, EventSink& events) override;

 private:
  struct Kept {
    NodeAddress node;
    Sequence sequence = 0;
    std::vector<LookIndex> looks;
  };
  struct Lamp {
    int slot = 1;  ///< its first
    LookIndex look = kDark;
    Instant identifies_until{};
  };

  [[nodiscard]] std::vector<std::uint8_t> packet(Instant now) const;
  [[nodiscard]] bool moves(Instant now) const;
  SendStatus send(Instant now);

  ByteStream& port_;
  DmxFixture fixture_;
  std::vector<Lamp> lamps_;
  std::map<NodeIndex, std::size_t> first_lamp_;
  std::map<NodeIndex, Kept> kept_;
  std::array<Look, 256> looks_;
  int slots_ = dmx::kFewestSlots;  ///< that are sent
  std::vector<DeviceEvent> due_;
  std::vector<ServiceAnswer> answers_;
  bool changed_ = false;  ///< levels of lamps since the last packet, a latch apart
  bool alive_ = false;    ///< something has been sent: from then on packets go out by themselves
  Instant sent_at_{};
  Instant line_free_{};
  bool line_taken_ = false;
  bool down_ = false;
  bool down_told_ = false;
};

}  // namespace footlight::drivers
