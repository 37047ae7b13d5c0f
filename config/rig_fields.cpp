// SPDX-License-Identifier: Apache-2.0
#include "config/field.hpp"

namespace footlight::config {
namespace {

const Listing& bus_listing() {
  static const Listing kListing{
      "buses[]",
      "One wire.",
      {
          {.key = "name", .type = Type::text, .doc = "Unique.", .required = true},
          {.key = "kind",
           .type = Type::choice,
           .doc = "The language on the wire; the URL must fit.",
           .otherwise = "as the URL says",
           .choices = {"serial", "modbus-rtu", "modbus-tcp", "can", "dmx"}},
          {.key = "url",
           .type = Type::text,
           .doc = "`serial:///dev/serial/by-id/...`, `rtu:///dev/...`, by the adapter's USB serial number "
                  "`serial://usb/NUMBER` and `rtu://usb/NUMBER`, `tcp://host:502`, `can://can0`, or without hardware "
                  "`sim://serial`, `sim://rtu`, `sim://tcp`, `sim://can`, `sim://dmx`.",
           .required = true},
          {.key = "bits_per_second",
           .type = Type::integer,
           .doc = "Serial and RTU 1,200 to 4,000,000, CAN 10,000 to 1,000,000.",
           .otherwise = "115200; CAN 500000",
           .range = {1200, 4'000'000}},
          {.key = "profile",
           .type = Type::text,
           .doc = "Name of a shipped device profile (Modbus footlight-marker, pick-light, relay-16; DMX dmx-rgb, "
                  "dmx-dimmer; CAN cia401-32do), or a YAML file beside the rig.",
           .otherwise = "footlight-marker; DMX dmx-rgb; CAN our own markers"},
          {.key = "supply",
           .type = Type::text,
           .doc = "Power supply of its nodes, for those that name none; `footlight dark` asks what hangs on it.",
           .otherwise = "not known"},
          {.key = "characters",
           .type = Type::choice,
           .doc = "Serial and RTU: parity and stop bits of a character.",
           .otherwise = "RTU 8E1, serial 8N1",
           .choices = {"8N1", "8N2", "8E1", "8O1"}},
          {.key = "direction",
           .type = Type::choice,
           .doc = "RS-485: who turns the transceiver from listening to speaking: the adapter by itself, the kernel's "
                  "driver, or the controller by RTS or by a GPIO line.",
           .fallback = "adapter",
           .choices = {"adapter", "kernel", "rts", "gpio"}},
          {.key = "direction_line",
           .type = Type::text,
           .doc = "`direction: gpio`: chip and line, as `gpiochip0:17`.",
           .otherwise = "none"},
          {.key = "direction_inverted",
           .type = Type::boolean,
           .doc = "The line is low while the controller speaks.",
           .fallback = "false"},
      }};
  return kListing;
}

const Listing& feed_listing() {
  static const Listing kListing{
      "supplies[].feeds[]",
      "Nodes of one bus that hang on the supply, by address; they need not say so themselves.",
      {
          {.key = "bus", .type = Type::text, .doc = "Name of the bus.", .required = true},
          {.key = "first",
           .type = Type::integer,
           .doc = "First address.",
           .otherwise = "the bus's first",
           .range = {1, 512}},
          {.key = "last",
           .type = Type::integer,
           .doc = "Last address.",
           .otherwise = "the bus's last",
           .range = {1, 512}},
      }};
  return kListing;
}

const Listing& supply_listing() {
  static const Listing kListing{
      "supplies[]",
      "A power supply. Nodes hang on it that name it (`supply` of node or bus) or that it feeds.",
      {
          {.key = "name", .type = Type::text, .doc = "Unique.", .required = true},
          {.key = "limit",
           .type = Type::current,
           .doc = "What it gives as long as one likes.",
           .required = true,
           .range = {0, 1000, true}},
          {.key = "overload",
           .type = Type::choice,
           .doc =
               "What happens when a cue's looks ask for more: the show is refused, or all of its lamps are dimmed by "
               "one factor for that cue, never dark.",
           .fallback = "refuse",
           .choices = {"refuse", "dim"}},
          {.key = "stagger",
           .type = Type::time,
           .doc = "Time between the first lights of two of its nodes after power-on, so that inrush trips nothing.",
           .fallback = "0 s",
           .range = {0, 1}},
          {.key = "feeds",
           .type = Type::mapping,
           .doc = "What hangs on it, besides nodes and buses that name it.",
           .otherwise = "none",
           .listing = &feed_listing(),
           .list = true},
      }};
  return kListing;
}

const Listing& wearable_listing() {
  static const Listing kListing{
      "nodes[].channels[]",
      "A lamp that somebody wears; a lamp of a cell is written as the cell.",
      {{.key = "wearable", .type = Type::text, .doc = "Id in the roster's column `wearable`.", .required = true}}};
  return kListing;
}

const Listing& node_listing() {
  static const Listing kListing{
      "nodes[]",
      "A device with one address and up to 32 lamps.",
      {
          {.key = "name", .type = Type::text, .doc = "Unique.", .otherwise = "bus and address, as can-a-7"},
          {.key = "bus", .type = Type::text, .doc = "Name of its bus.", .required = true},
          {.key = "address",
           .type = Type::integer,
           .doc = "Unique on its bus: CAN 1 to 126, Modbus 1 to 247, serial 1 to 254; DMX: the first slot of "
                  "its first lamp, 1 to 512.",
           .required = true,
           .range = {1, 512}},
          {.key = "channels",
           .type = Type::lamp,
           .doc = "1 to 32 lamps, channel 0 first: cells (`A1`), ranges of cells (`A1:H4`, row by row from A1, "
                  "blocked cells left out), `{wearable: W7}`, and `unused` for a channel without a lamp, or with one "
                  "whose "
                  "cell is not known (`footlight commission` finds it).",
           .required = true,
           .listing = &wearable_listing(),
           .list = true},
          {.key = "supply", .type = Type::text, .doc = "Power supply.", .otherwise = "the bus's"},
      }};
  return kListing;
}

const Listing& floor_listing() {
  static const Listing kListing{
      "floor",
      "Lays a lamp for every cell that has none yet, row by row from A1, over nodes that are made for it; each bus "
      "gets "
      "a share as its capacity is.",
      {
          {.key = "buses", .type = Type::text, .doc = "Names of buses.", .required = true, .list = true},
          {.key = "nodes_per_bus",
           .type = Type::integer,
           .doc = "Most nodes on one bus.",
           .otherwise = "what carries well: CAN 126, serial 28, Modbus 16",
           .range = {1, 247}},
          {.key = "channels_per_node",
           .type = Type::integer,
           .doc = "Lamps on a node.",
           .fallback = "32",
           .range = {1, 32}},
          {.key = "wearables",
           .type = Type::boolean,
           .doc = "Every wearable of the roster that has no channel yet gets one, too.",
           .fallback = "true"},
      }};
  return kListing;
}

}  // namespace

const Listing& currents_listing() {
  const auto current = [](std::string_view key, std::string_view doc) {
    return Field{.key = key, .type = Type::current, .doc = doc, .otherwise = "0", .range = {0, 10}};
  };
  static const Listing kListing{
      "lamps, currents",
      "Currents from the supply: each colour at full, in proportion below (a lamp that "
      "corrects for the eye takes less).",
      {current("red", "Red alone, at full."), current("green", "Green alone, at full."),
       current("blue", "Blue alone, at full."), current("lamp", "In the place of the colours: a lamp at full white."),
       current("node", "A node with all of its lamps dark.")}};
  return kListing;
}

const Listing& rig_listing() {
  static const Listing kListing{
      "rig.yaml",
      "Which lamp hangs on which wire.",
      {
          {.key = "rig", .type = Type::integer, .doc = "Version of this format.", .required = true, .range = {1, 1}},
          {.key = "buses",
           .type = Type::mapping,
           .doc = "The wires; at least one.",
           .required = true,
           .listing = &bus_listing(),
           .list = true},
          {.key = "nodes",
           .type = Type::mapping,
           .doc = "Devices, one by one.",
           .otherwise = "none",
           .listing = &node_listing(),
           .list = true},
          {.key = "floor",
           .type = Type::mapping,
           .doc = "Devices for the whole floor at once.",
           .otherwise = "none",
           .listing = &floor_listing()},
          {.key = "supplies",
           .type = Type::mapping,
           .doc = "Power supplies with their limits. Where they are listed, no other name may be used.",
           .otherwise = "names alone, as buses and nodes give them",
           .listing = &supply_listing(),
           .list = true},
          {.key = "lamps",
           .type = Type::mapping,
           .doc = "What lamps take, on buses whose profile does not say.",
           .otherwise = "not known",
           .listing = &currents_listing()},
      }};
  return kListing;
}

}  // namespace footlight::config
