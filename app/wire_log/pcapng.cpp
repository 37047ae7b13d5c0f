// SPDX-License-Identifier: Apache-2.0
#include "app/wire_log/pcapng.hpp"

#include <array>
#include <ostream>
#include <string_view>
#include <utility>

namespace footlight::app {
namespace {

constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A;
constexpr std::uint32_t kInterfaceDescription = 1;
constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint32_t kByteOrder = 0x1A2B3C4D;
constexpr std::uint16_t kUserApplication = 4;  // options of a section header
constexpr std::uint16_t kInterfaceName = 2;    // of an interface description
constexpr std::uint16_t kInterfaceSpeed = 8;
constexpr std::uint16_t kTimeResolution = 9;
constexpr std::uint16_t kPacketFlags = 2;  // of an enhanced packet
constexpr std::uint8_t kNanoseconds = 9;   // 10^-9 s

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

/// The body of a block, of a fixed machine-independent layout.
class Block {
 public:
  template <class Integer>
  Block& number(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
    return *this;
  }
  Block& option(std::uint16_t code, std::string_view value) {
    number(code).number(static_cast<std::uint16_t>(value.size()));
    bytes_.append(value);
    bytes_.resize(padded(bytes_.size()));
    return *this;
  }
  void write(std::ostream& out, std::uint32_t type) {
    number(std::uint32_t{0});  // end of options
    const auto length = static_cast<std::uint32_t>(bytes_.size() + 12);
    const std::string body = std::move(bytes_);
    bytes_.clear();
    number(type).number(length);
    bytes_.append(body);
    number(length);
    out.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
  }

 private:
  std::string bytes_;
};

std::string little_endian(std::uint64_t value) {
  std::string text;
  for (int i = 0; i < 8; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

}  // namespace

LinkType link_type_of(BusKind kind) {
  switch (kind) {
    case BusKind::can:
      return LinkType::can_socketcan;
    case BusKind::modbus_rtu:
      return LinkType::wireshark_upper_pdu;
    case BusKind::modbus_tcp:
      return LinkType::ipv4;
    case BusKind::serial:
    case BusKind::dmx:
      break;
  }
  return LinkType::rtac_serial;
}

std::vector<Wire> wires_of(const Rig& rig) {
  std::vector<Wire> wires;
  for (const Bus& bus : rig.buses) {
    wires.push_back({bus.name, link_type_of(bus.kind), bus.kind == BusKind::modbus_tcp ? 0 : bus.bits_per_second});
  }
  return wires;
}

void PcapngWriter::begin(const std::vector<Wire>& wires) {
  Block section;
  section.number(kByteOrder).number(std::uint16_t{1}).number(std::uint16_t{0}).number(std::int64_t{-1});
  section.option(kUserApplication, "footlight");
  section.write(out_, kSectionHeader);
  for (const Wire& wire : wires) {
    Block interface;
    interface.number(static_cast<std::uint16_t>(wire.type)).number(std::uint16_t{0}).number(std::uint32_t{0});
    interface.option(kInterfaceName, wire.name);
    if (wire.bits_per_second > 0) {
      interface.option(kInterfaceSpeed, little_endian(static_cast<std::uint64_t>(wire.bits_per_second)));
    }
    interface.option(kTimeResolution, std::string_view(reinterpret_cast<const char*>(&kNanoseconds), 1));
    interface.write(out_, kInterfaceDescription);
  }
}

void PcapngWriter::packet(std::size_t wire, Duration since_1970, Heading heading,
                          std::span<const std::uint8_t> bytes) noexcept {
  const auto time = static_cast<std::uint64_t>(since_1970.count());
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const auto length = static_cast<std::uint32_t>(12 + 20 + padded(size) + 12);
  // Without a string, for this one is written a million times.
  const std::array<std::uint32_t, 7> head{kEnhancedPacket,
                                          length,
                                          static_cast<std::uint32_t>(wire),
                                          static_cast<std::uint32_t>(time >> 32U),
                                          static_cast<std::uint32_t>(time),
                                          size,
                                          size};
  const std::uint32_t direction = heading == Heading::received ? 1 : 2;  // inbound, outbound
  const std::array<std::uint32_t, 4> tail{kPacketFlags | (4U << 16U), direction, 0, length};
  constexpr std::array<char, 4> kZeros{};
  const auto put = [&](const auto& words) {
    for (const std::uint32_t word : words) {
      const std::array<char, 4> four{static_cast<char>(word), static_cast<char>(word >> 8U),
                                     static_cast<char>(word >> 16U), static_cast<char>(word >> 24U)};
      out_.write(four.data(), four.size());
    }
  };
  put(head);
  out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out_.write(kZeros.data(), static_cast<std::streamsize>(padded(size) - size));
  put(tail);
}

}  // namespace footlight::app
