// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/index.hpp"
#include "core/look.hpp"
#include "core/time.hpp"

namespace footlight {

enum class BusKind { serial, modbus_rtu, modbus_tcp, can, dmx };

[[nodiscard]] std::string_view to_text(BusKind kind);

/// A device's own number of something that it can show.
struct ColourCode {
  int value = 0;
  Colour colour;
  friend bool operator==(const ColourCode&, const ColourCode&) = default;
};
struct EffectCode {
  int value = 0;
  Effect effect = Effect::steady;
  friend bool operator==(const EffectCode&, const EffectCode&) = default;
};
struct BrightnessCode {
  int value = 0;
  int brightness = 255;
  friend bool operator==(const BrightnessCode&, const BrightnessCode&) = default;
};
struct PaletteEntry {
  int value = 0;  ///< 0..255
  Look look;
  friend bool operator==(const PaletteEntry&, const PaletteEntry&) = default;
};

/// Numbered states of a device whose colours and effects are set once, so that the show only switches states: look i is
/// state i, state 0 is dark.
struct StateTable {
  int first_register = 0;  ///< of state 1
  int stride = 1;          ///< registers from one state to the next
  int count = 1;           ///< states besides dark
  std::optional<int> effect_offset;
  std::optional<int> colour_offset;
  std::optional<int> brightness_offset;
  std::vector<EffectCode> effects;
  std::vector<ColourCode> colours;
  std::vector<BrightnessCode> brightnesses;
  friend bool operator==(const StateTable&, const StateTable&) = default;
};

/// A register that tells how a device is.
struct HealthRegister {
  std::string name;  ///< "battery"
  int number = 0;
  double scale = 1;  ///< register value x scale is in `unit`
  std::string unit;
  bool has_sign = false;
  friend bool operator==(const HealthRegister&, const HealthRegister&) = default;
};

/// Where a device keeps what in its Modbus registers, or coils; read from drivers/profiles/*.yaml
/// (docs/device-profiles.md).
struct ModbusProfile {
  std::string name;
  int channels = 32;                       ///< lamps that one node has at most
  int look_register = 0;                   ///< first register of the preload block; the first coil where `coils`
  bool coils = false;                      ///< a lamp is a coil: on or off
  int looks_per_register = 2;              ///< 1 or 2; with 2 the lower channel stands in the high byte
  bool has_preload_sequence = true;        ///< the block begins with plan byte and latch sequence, the looks follow
  bool readable_looks = false;             ///< looks can be read where they are written
  std::vector<PaletteEntry> palette;       ///< what the device can show, by its own numbers; empty: look indices
  std::optional<int> latch_register;       ///< broadcast-written with the sequence; absent: looks act at once
  std::optional<int> heartbeat_register;   ///< broadcast-written every 250 ms; absent: no lease
  std::optional<int> status_register;      ///< first of: shown sequence, pending sequence, CRC of shown looks, state
  std::optional<int> look_table_register;  ///< upload block of one entry: index, red/green, blue/brightness, effect
  std::optional<StateTable> states;        ///< or a table of the device's own kind
  std::optional<int> identity_register;    ///< registers that say what it is
  int identity_registers = 1;
  bool identity_is_text = false;          ///< two characters a register
  std::optional<int> unique_id_register;  ///< two registers
  std::optional<int> identify_register;   ///< 1: the device shows which one it is; 0: no longer
  std::optional<int> address_register;    ///< takes the device's new address
  std::optional<int> readdress_register;  ///< broadcast-written: unique id (2), new address, guard
  bool restarts_for_address = false;      ///< a new address counts after power-on
  std::vector<HealthRegister> health;
  bool low_word_first = false;     ///< of numbers of two registers
  bool has_broadcast = true;       ///< obeys writes to unit 0
  bool writes_one_by_one = false;  ///< knows functions 0x06 and 0x05 alone
  Duration pause_after_write{};
  friend bool operator==(const ModbusProfile&, const ModbusProfile&) = default;

  /// The device holds a look table that shows upload, or shows only what its palette has.
  [[nodiscard]] bool shows_own_numbers() const { return coils || !palette.empty(); }
  /// It speaks the language of our own marker, which reports sequence and check sum of what it shows.
  [[nodiscard]] bool proves_looks() const { return has_preload_sequence && status_register.has_value(); }
};

/// As drivers/profiles/footlight-marker.yaml has it: for rigs that need no file at all.
[[nodiscard]] ModbusProfile footlight_marker_profile();

/// A value that a CANopen device is given before the show.
struct ObjectValue {
  int index = 0;  ///< 0x1000..0xFFFF
  int sub = 0;    ///< 0..255
  int bytes = 1;  ///< 1, 2 or 4
  std::uint32_t value = 0;
  friend bool operator==(const ObjectValue&, const ObjectValue&) = default;
};

/// A CANopen module of digital outputs (CiA 401), each of them a lamp that is on or off; read from
/// drivers/profiles/*.yaml.
struct OutputModule {
  /// What its outputs do when the controller has fallen silent, or the module has stopped.
  enum class OnFailure { dark, lit, keep };
  std::string name;
  int outputs = 32;  ///< 1..32; eight of them are one byte of object 0x6200
  OnFailure on_failure = OnFailure::dark;
  Duration heartbeat = seconds(1);        ///< that it sends
  Duration silence = milliseconds(1000);  ///< of the controller, after which it falls back
  std::optional<std::uint32_t> vendor;    ///< in object 0x1018; absent: whoever it is
  std::optional<std::uint32_t> product;
  std::vector<ObjectValue> objects;  ///< written besides, in this order
  friend bool operator==(const OutputModule&, const OutputModule&) = default;
  /// Bytes of outputs.
  [[nodiscard]] int bytes() const { return (outputs + 7) / 8; }
};

/// One slot (DMX channel) of a lamp.
enum class DmxSlot { dimmer, red, green, blue, white, amber, zero, full };

/// Lamps of one kind on a DMX line; read from drivers/profiles/*.yaml. A node's address is its first slot.
struct DmxFixture {
  std::string name;
  std::vector<DmxSlot> slots;  ///< of one lamp, in their order on the wire
  friend bool operator==(const DmxFixture&, const DmxFixture&) = default;
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

/// What lamps take from their supply, in ampere: of each colour at full brightness, less in proportion.
struct LampCurrents {
  double red_a = 0;
  double green_a = 0;
  double blue_a = 0;
  double node_a = 0;  ///< of a node with all of its lamps dark
  friend bool operator==(const LampCurrents&, const LampCurrents&) = default;
};

/// One wire. `url` chooses the transport: sim://serial, sim://rtu, sim://tcp, sim://can, serial:///dev/...,
/// rtu:///dev/..., tcp://host:502, can://can0, dmx:///dev/....
struct Bus {
  std::string name;  ///< unique
  BusKind kind = BusKind::serial;
  std::string url;
  int bits_per_second = 115'200;         ///< serial, RTU: 1200..4,000,000; CAN: 10,000..1,000,000
  std::optional<ModbusProfile> profile;  ///< Modbus only
  Position position;
  std::string supply{};  ///< power supply of its nodes that name none; empty: not known
  SerialLine line{};
  std::optional<DmxFixture> fixture{};     ///< DMX only
  std::optional<OutputModule> outputs{};   ///< CAN only; absent: our own markers
  std::optional<LampCurrents> currents{};  ///< as the devices' profile says; absent: the rig's

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
  int address = 1;                ///< CAN 1..126, Modbus 1..247, serial 1..254, DMX 1..512; unique on its bus
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

/// A power supply, and what happens to looks that ask more of it than it can give.
struct Supply {
  enum class Overload { refuse, dim };
  std::string name;    ///< unique; nodes and buses name it
  double limit_a = 0;  ///< that it gives as long as one likes
  Overload overload = Overload::refuse;
  Duration stagger{};  ///< between the first lights of two of its nodes; 0: all at once
  Position position;
};

struct Rig {
  std::string file;  ///< empty when made for the stage
  std::vector<Bus> buses;
  std::vector<Node> nodes;         ///< ordered by bus, then address
  std::vector<Supply> supplies{};  ///< empty: names alone, as buses and nodes have them
  LampCurrents currents{};

  /// What a lamp of this bus takes.
  [[nodiscard]] const LampCurrents& currents_of(const Bus& bus) const {
    return bus.currents ? *bus.currents : currents;
  }
};

}  // namespace footlight
