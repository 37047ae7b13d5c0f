// SPDX-License-Identifier: Apache-2.0
#include "config/field.hpp"

namespace footlight::config {
namespace {

const Range kRegister{0, 65'535};
const Range kNumber{0, 2'147'483'647};
const std::vector<std::string_view> kEffects{"steady", "blink", "pulse", "double-blink", "count-down"};

const Listing& palette_listing() {
  static const Listing kListing{
      "palette[]",
      "One thing that the device can show, by a number of its own.",
      {
          {.key = "value",
           .type = Type::integer,
           .doc = "What is written for it.",
           .required = true,
           .range = {0, 255}},
          {.key = "colour", .type = Type::colour, .doc = "What it looks like; dark is `#000000`.", .required = true},
          {.key = "effect", .type = Type::choice, .doc = "What it does.", .fallback = "steady", .choices = kEffects},
          {.key = "brightness", .type = Type::integer, .doc = "0 to 255.", .fallback = "255", .range = {0, 255}},
      }};
  return kListing;
}

const Listing& effect_code_listing() {
  static const Listing kListing{
      "states.effects[]",
      "The device's number of an effect.",
      {
          {.key = "effect", .type = Type::choice, .doc = "Ours.", .required = true, .choices = kEffects},
          {.key = "value", .type = Type::integer, .doc = "The device's.", .required = true, .range = kRegister},
      }};
  return kListing;
}

const Listing& colour_code_listing() {
  static const Listing kListing{
      "states.colours[]",
      "The device's number of a colour.",
      {
          {.key = "colour", .type = Type::colour, .doc = "What it looks like.", .required = true},
          {.key = "value", .type = Type::integer, .doc = "The device's number.", .required = true, .range = kRegister},
      }};
  return kListing;
}

const Listing& brightness_code_listing() {
  static const Listing kListing{
      "states.brightnesses[]",
      "The device's number of a brightness.",
      {
          {.key = "brightness", .type = Type::integer, .doc = "0 to 255.", .required = true, .range = {0, 255}},
          {.key = "value", .type = Type::integer, .doc = "The device's number.", .required = true, .range = kRegister},
      }};
  return kListing;
}

const Listing& states_listing() {
  static const Listing kListing{
      "states",
      "A table of numbered states that is filled once; then the show switches states only. Look 1 is state 1, dark is "
      "state 0.",
      {
          {.key = "register",
           .type = Type::integer,
           .doc = "First register of state 1.",
           .required = true,
           .range = kRegister},
          {.key = "stride",
           .type = Type::integer,
           .doc = "Registers from one state to the next.",
           .required = true,
           .range = {1, 1000}},
          {.key = "count",
           .type = Type::integer,
           .doc = "States besides dark; a show with more looks is refused.",
           .required = true,
           .range = {1, 254}},
          {.key = "effect_at",
           .type = Type::integer,
           .doc = "Register of the effect, counted from the state's first.",
           .otherwise = "no effects",
           .range = {0, 999}},
          {.key = "colour_at",
           .type = Type::integer,
           .doc = "Register of the colour, counted from the state's first.",
           .otherwise = "no colours",
           .range = {0, 999}},
          {.key = "brightness_at",
           .type = Type::integer,
           .doc = "Register of the brightness, counted from the state's first.",
           .otherwise = "one brightness",
           .range = {0, 999}},
          {.key = "effects",
           .type = Type::mapping,
           .doc = "Its effects; the nearest is taken for one that it lacks.",
           .otherwise = "none",
           .listing = &effect_code_listing(),
           .list = true},
          {.key = "colours",
           .type = Type::mapping,
           .doc = "Its colours; the nearest is taken for one that it lacks.",
           .otherwise = "none",
           .listing = &colour_code_listing(),
           .list = true},
          {.key = "brightnesses",
           .type = Type::mapping,
           .doc = "Its brightnesses; the nearest is taken for one that it lacks.",
           .otherwise = "none",
           .listing = &brightness_code_listing(),
           .list = true},
      }};
  return kListing;
}

const Listing& health_listing() {
  static const Listing kListing{
      "health[]",
      "A register that tells how the device is.",
      {
          {.key = "name", .type = Type::text, .doc = "Of the quantity, as battery.", .required = true},
          {.key = "register", .type = Type::integer, .doc = "Where it stands.", .required = true, .range = kRegister},
          {.key = "scale",
           .type = Type::number,
           .doc = "What one of the register's units is worth.",
           .fallback = "1",
           .range = {1e-6, 1e6}},
          {.key = "unit", .type = Type::text, .doc = "Behind the number.", .otherwise = "none"},
          {.key = "signed", .type = Type::boolean, .doc = "May be below zero.", .fallback = "false"},
      }};
  return kListing;
}

const Listing& object_listing() {
  static const Listing kListing{
      "objects[]",
      "An object of a CANopen device, written before the show and read back.",
      {
          {.key = "index",
           .type = Type::integer,
           .doc = "0x1000 to 0xFFFF.",
           .required = true,
           .range = {0x1000, 0xFFFF}},
          {.key = "sub", .type = Type::integer, .doc = "Sub-index.", .fallback = "0", .range = {0, 255}},
          {.key = "bits", .type = Type::choice, .doc = "Its size.", .required = true, .choices = {"8", "16", "32"}},
          {.key = "value", .type = Type::integer, .doc = "What it is to be.", .required = true, .range = kNumber},
      }};
  return kListing;
}

Field at_register(std::string_view key, std::string_view doc, std::string_view otherwise) {
  return {.key = key, .type = Type::integer, .doc = doc, .otherwise = otherwise, .range = kRegister};
}

}  // namespace

const Listing& profile_listing() {
  static const Listing kListing{
      "drivers/profiles/*.yaml",
      "Where a Modbus device keeps what, numbers of registers and coils from 0, decimal or 0x...; or the slots of a "
      "DMX lamp; or the outputs of a CANopen module (CiA 401).",
      {
          {.key = "profile",
           .type = Type::integer,
           .doc = "Version of this format.",
           .required = true,
           .range = {1, 1}},
          {.key = "name", .type = Type::text, .doc = "Of the device.", .required = true},
          {.key = "channels",
           .type = Type::integer,
           .doc = "Lamps that one device has at most.",
           .fallback = "32",
           .range = {1, 32}},
          {.key = "look_register",
           .type = Type::integer,
           .doc = "First register of the preload block: the sequence, where there is one, then the looks.",
           .range = kRegister},
          {.key = "look_coil", .type = Type::integer, .doc = "First coil: a lamp is on or off.", .range = kRegister},
          {.key = "lamp_slots",
           .type = Type::choice,
           .doc = "DMX: what the slots of one lamp are, in their order.",
           .choices = {"dimmer", "red", "green", "blue", "white", "amber", "zero", "full"},
           .list = true},
          {.key = "outputs",
           .type = Type::integer,
           .doc = "CAN: digital outputs, a lamp each, eight to a sub-index of object 0x6200.",
           .range = {1, 32}},
          {.key = "on_failure",
           .type = Type::choice,
           .doc = "CAN: the outputs when the controller has fallen silent (objects 0x6206 and 0x6207).",
           .fallback = "dark",
           .choices = {"dark", "lit", "keep"}},
          {.key = "heartbeat",
           .type = Type::time,
           .doc = "CAN: the module tells so often that it lives (0x1017).",
           .fallback = "1 s",
           .range = {0.1, 60}},
          {.key = "silence",
           .type = Type::time,
           .doc = "CAN: so long the controller may be silent (0x1016); it beats every 250 ms.",
           .fallback = "1 s",
           .range = {0.5, 60}},
          {.key = "vendor",
           .type = Type::integer,
           .doc = "CAN: in 0x1018:1; another one is refused.",
           .otherwise = "whoever it is",
           .range = kNumber},
          {.key = "product",
           .type = Type::integer,
           .doc = "CAN: in 0x1018:2; another one is refused.",
           .otherwise = "whatever it is",
           .range = kNumber},
          {.key = "objects",
           .type = Type::mapping,
           .doc = "CAN: what the module needs besides, in this order.",
           .otherwise = "none",
           .listing = &object_listing(),
           .list = true},
          {.key = "currents",
           .type = Type::mapping,
           .doc = "What its lamps take.",
           .otherwise = "as the rig says",
           .listing = &currents_listing()},
          {.key = "looks_per_register",
           .type = Type::integer,
           .doc = "With 2 the lower channel stands in the high byte.",
           .fallback = "2",
           .range = {1, 2}},
          {.key = "preload_sequence",
           .type = Type::boolean,
           .doc = "The preload block begins with a register of plan byte and sequence.",
           .fallback = "false"},
          {.key = "readback",
           .type = Type::boolean,
           .doc = "Looks can be read where they are written.",
           .fallback = "false"},
          {.key = "palette",
           .type = Type::mapping,
           .doc = "The device has numbers of its own for what it can show; the nearest is taken.",
           .otherwise = "numbers of our look table; coils: dark is off, all else on",
           .listing = &palette_listing(),
           .list = true},
          at_register("latch_register", "First of three registers of the broadcast latch; without a sequence one.",
                      "looks act at once"),
          at_register("heartbeat_register", "First of two registers of the broadcast heartbeat.", "no lease"),
          at_register("status_register", "First of six status registers.", "no sequence can be read back"),
          at_register("look_table_register", "First of four registers that upload one entry of the look table.",
                      "the device's looks are fixed"),
          {.key = "states",
           .type = Type::mapping,
           .doc = "A look table of the device's own kind.",
           .otherwise = "none",
           .listing = &states_listing()},
          at_register("identity_register", "First register of what it says that it is.", "it does not say"),
          {.key = "identity_registers", .type = Type::integer, .doc = "How many.", .fallback = "1", .range = {1, 64}},
          {.key = "identity_text",
           .type = Type::boolean,
           .doc = "They are text, two characters a register.",
           .fallback = "false"},
          at_register("unique_id_register", "First of two registers of a number that no other piece has.", "none"),
          at_register("identify_register", "1: it shows which one it is; 0: no longer.",
                      "its lamps are lit in its stead"),
          at_register("address_register", "Takes the device's new address.", "addresses are set by hand"),
          at_register("readdress_register",
                      "First of four registers: unique id (2), new address, 0x5A5A xor the new address.",
                      "devices of one address are not told apart"),
          {.key = "health",
           .type = Type::mapping,
           .doc = "Registers that tell how it is.",
           .otherwise = "none",
           .listing = &health_listing(),
           .list = true},
          {.key = "word_order",
           .type = Type::choice,
           .doc = "Of numbers of two registers.",
           .fallback = "high-first",
           .choices = {"high-first", "low-first"}},
          {.key = "quirks",
           .type = Type::choice,
           .doc = "`no-broadcast`: everything is written node by node; `write-one-by-one`: it knows functions 0x05 and "
                  "0x06 alone; `restart-for-address`: a new address counts after power-on.",
           .otherwise = "none",
           .choices = {"no-broadcast", "write-one-by-one", "restart-for-address"},
           .list = true},
          {.key = "pause_after_write",
           .type = Type::time,
           .doc = "The device wants so much time after each write.",
           .fallback = "0 s",
           .range = {0, 1}},
      },
      "look_register look_coil lamp_slots outputs"};
  return kListing;
}

}  // namespace footlight::config
