// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "core/rig.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// From the controller, or to it.
enum class Heading : std::uint8_t { sent, received };

/// What a packet of a capture begins with (https://www.tcpdump.org/linktypes.html).
enum class LinkType : std::uint16_t {
  ipv4 = 228,
  can_socketcan = 227,
  rtac_serial = 250,
  wireshark_upper_pdu = 252,
};

/// An interface of a capture.
struct Wire {
  std::string name;
  LinkType type = LinkType::rtac_serial;
  int bits_per_second = 0;  ///< 0: not known
};

[[nodiscard]] LinkType link_type_of(BusKind kind);
[[nodiscard]] std::vector<Wire> wires_of(const Rig& rig);

/// Writes a pcapng section (draft-ietf-opsawg-pcapng, sections 4.1 to 4.3): little-endian, times in nanoseconds.
/// Sections may follow each other in one file.
class PcapngWriter {
 public:
  explicit PcapngWriter(std::ostream& out) : out_(out) {}
  void begin(const std::vector<Wire>& wires);
  /// @param since_1970 of the packet  @param wire as in `begin`
  void packet(std::size_t wire, Duration since_1970, Heading heading, std::span<const std::uint8_t> bytes) noexcept;

 private:
  std::ostream& out_;
};

}  // namespace footlight::app
