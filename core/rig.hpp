// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/index.hpp"
#include "core/time.hpp"

namespace footlight {

enum class BusKind { serial, modbus_rtu, modbus_tcp, can };

[[nodiscard]] std::string_view to_text(BusKind kind);

/// Where a device keeps what in its Modbus registers; read from drivers/profiles/*.yaml (docs/wire-protocol.md,
/// "Modbus").
struct ModbusProfile {
  std::string name;
  int look_register = 0;                   ///< first register of the preload block
  int looks_per_register = 2;              ///< 1 or 2; with 2 the lower channel stands in the high byte
  bool has_preload_sequence = true;        ///< the block begins with plan byte and latch sequence, the looks follow
  std::optional<int> latch_register;       ///< broadcast-written with the sequence; absent: looks act at once
  std::optional<int> heartbeat_register;   ///< broadcast-written every 250 ms; absent: no lease
  std::optional<int> status_register;      ///< first of: shown sequence, pending sequence, CRC of shown looks, state
  std::optional<int> look_table_register;  ///< upload block of one entry: index, red/green, blue/brightness, effect
  friend bool operator==(const ModbusProfile&, const ModbusProfile&) = default;
};

/// A character on a serial or RTU line: eight data bits, parity, stop bits.
enum class Characters { n1, n2, e1, o1 };

[[nodiscard]] std::string_view to_text(Characters characters);

/// Who turns the transceiver of an RS-485 line from listening to speaking and back.
enum class LineDirection {
  adapter,  ///< the adapter by itself; or there is nothing to turn, as with RS-232 and RS-422
  kernel,   ///< the kernel's driver, by RTS (TIOCSRS485)
  rts,      ///< we, by RTS
  gpio,     ///< we, by a line of a GPIO chip
};

/// What only serial and RTU lines have.
struct SerialLine {
  std::optional<Characters> characters;  ///< absent: 8E1 on RTU, else 8N1
  LineDirection direction = LineDirection::adapter;
  std::string direction_chip;       ///< gpio: "gpiochip0" or the chip's label
  int direction_offset = 0;         ///< gpio: line of the chip
  bool direction_inverted = false;  ///< low while speaking
  friend bool operator==(const SerialLine&, const SerialLine&) = default;
};

/// One wire. `url` chooses the transport: sim://serial, sim://rtu, sim://tcp, sim://can, serial:///dev/...,
/// rtu:///dev/..., tcp://host:502, can://can0.
struct Bus {
  std::string name;  ///< unique
  BusKind kind = BusKind::serial;
  std::string url;
  int bits_per_second = 115'200;         ///< serial, RTU: 1200..4,000,000; CAN: 10,000..1,000,000
  std::optional<ModbusProfile> profile;  ///< Modbus only
  Position position;
  std::string supply{};  ///< power supply of its nodes that name none; empty: not known
  SerialLine line{};

  /// On this serial or RTU line.
  [[nodiscard]] Characters characters() const {
    return line.characters.value_or(kind == BusKind::modbus_rtu ? Characters::e1 : Characters::n1);
  }
  /// Start, data, parity and stop bits.
  [[nodiscard]] int bits_per_character() const { return characters() == Characters::n1 ? 10 : 11; }
  [[nodiscard]] bool simulated() const { return url.rfind("sim://", 0) == 0; }
};

/// A cell's lamp or somebody's wearable on one channel of a node.
struct Channel {
  enum class Kind { unused, cell, wearable };
  Kind kind = Kind::unused;
  CellIndex cell;            ///< when kind is cell
  PerformerIndex performer;  ///< when kind is wearable
};

inline constexpr int kChannelsPerNode = 32;

struct Node {
  std::string name;  ///< unique in the rig
  BusIndex bus;
  int address = 1;                ///< CAN 1..126, Modbus 1..247, serial 1..254; unique on its bus
  std::vector<Channel> channels;  ///< 1..32
  Position position;
  std::string supply{};  ///< power supply, as technicians call it; empty: not known
};

/// One lamp: channel `channel` of node `node`.
struct MarkerPlace {
  NodeIndex node;
  int channel = 0;
  friend auto operator<=>(const MarkerPlace&, const MarkerPlace&) = default;
};

struct Rig {
  std::string file;  ///< empty when made for the stage
  std::vector<Bus> buses;
  std::vector<Node> nodes;  ///< ordered by bus, then address
};

}  // namespace footlight
