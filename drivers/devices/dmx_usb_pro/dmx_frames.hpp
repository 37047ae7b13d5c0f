// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/look.hpp"
#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::drivers::dmx {

// Messages of a DMX USB Pro widget (ENTTEC, DMX USB Pro Widget API Specification 1.44) and what lamps on its DMX line
// (ANSI E1.11, DMX512-A) are told for a look. Pure functions.

inline constexpr int kSlots = 512;
inline constexpr int kFewestSlots = 24;  ///< of a packet that the widget sends

/// Label 6, "Output Only Send DMX Packet Request": start code 0, then the slots. @param slots 24..512 of them
[[nodiscard]] std::vector<std::uint8_t> output(std::span<const std::uint8_t> slots);

/// Time of one DMX packet of so many slots on the line: break, mark after break, start code and slots at 250 kbit/s.
[[nodiscard]] Duration packet_time(int slots);

/// What an effect leaves of the full light at this moment, 0..1; all lamps are in step.
[[nodiscard]] double share_of(Effect effect, Instant now);

/// The slots of one lamp. @param share of the full light
[[nodiscard]] std::vector<std::uint8_t> levels(const DmxFixture& fixture, const Look& look, double share);

/// What a lamp shows for a look: one of a dimmer alone is white, as bright as the brightest colour.
[[nodiscard]] Look shown(const DmxFixture& fixture, const Look& look);

/// Whether a lamp whose slots have these levels may show `look`, at whatever moment of its effect.
[[nodiscard]] bool may_show(const DmxFixture& fixture, const Look& look, std::span<const std::uint8_t> levels);

}  // namespace footlight::drivers::dmx
