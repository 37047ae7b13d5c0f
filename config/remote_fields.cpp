// SPDX-License-Identifier: Apache-2.0
// The keys of the file of `footlight run --remote`.
#include "config/field.hpp"

namespace footlight::config {
namespace {

const Listing& osc_listing() {
  static const Listing kListing{
      "osc",
      "Open Sound Control over UDP, in and out. It has no identity of its own: beyond this machine it needs a list of "
      "addresses and a token.",
      {{.key = "port", .type = Type::integer, .doc = "Where it listens.", .fallback = "53000", .range = {1, 65535}},
       {.key = "address",
        .type = Type::text,
        .doc = "Of this machine, as numbers; 0.0.0.0 is all of them.",
        .fallback = "127.0.0.1"},
       {.key = "from",
        .type = Type::text,
        .doc = "Addresses that are heard; what comes from others is dropped unread.",
        .otherwise = "this machine alone",
        .list = true},
       {.key = "token",
        .type = Type::file,
        .doc = "A file with a secret of at least 22 characters, for nobody else to read (mode 0600); `/connect` or the "
               "last argument of a message says it.",
        .otherwise = "none, which only 127.0.0.1 and ::1 may"},
       {.key = "replies",
        .type = Type::integer,
        .doc = "Port at the sender for replies.",
        .otherwise = "the port that the message came from",
        .range = {1, 65535}},
       {.key = "state",
        .type = Type::text,
        .doc = "Who is told the state of the show, as `10.0.0.4:53001`.",
        .otherwise = "nobody",
        .list = true},
       {.key = "rate",
        .type = Type::number,
        .doc = "How often a second the state is told.",
        .fallback = "10",
        .range = {0.1, 50}}}};
  return kListing;
}

const Listing& macro_listing() {
  static const Listing kListing{
      "macros[]",
      "What FIRE does.",
      {{.key = "number", .type = Type::integer, .doc = "Of the macro.", .required = true, .range = {0, 127}},
       {.key = "order", .type = Type::text, .doc = "In the words of the desk: `hold end`.", .required = true}}};
  return kListing;
}

const Listing& midi_listing() {
  static const Listing kListing{
      "midi",
      "MIDI Show Control.",
      {{.key = "port",
        .type = Type::text,
        .doc = "Name, part of a name or number of a port, or the path of a raw MIDI device.",
        .required = true},
       {.key = "device", .type = Type::integer, .doc = "Device id.", .fallback = "0", .range = {0, 111}},
       {.key = "format",
        .type = Type::choice,
        .doc = "Command format that is heard, besides `all types`.",
        .fallback = "lighting",
        .choices = {"lighting", "sound", "machinery", "video", "projection", "process-control", "pyro"}},
       {.key = "macros",
        .type = Type::mapping,
        .doc = "What FIRE does.",
        .otherwise = "nothing",
        .listing = &macro_listing(),
        .list = true}}};
  return kListing;
}

// Fields that an input shares with others.
Field line_field() { return {.key = "line", .type = Type::text, .doc = "GPIO chip and line, as `gpiochip0:17`."}; }
Field osc_field() { return {.key = "osc", .type = Type::boolean, .doc = "`true`: told by OSC, under its name."}; }
Field active_field(std::string_view doc) {
  return {.key = "active", .type = Type::choice, .doc = doc, .fallback = "high", .choices = {"high", "low"}};
}
Field pull_field() {
  return {.key = "pull",
          .type = Type::choice,
          .doc = "The chip's own resistor.",
          .fallback = "none",
          .choices = {"none", "up", "down"}};
}
Field lost_after_field(std::string_view otherwise) {
  return {.key = "lost_after",
          .type = Type::time,
          .doc = "By OSC: it has to be told again so often, or nobody knows how it is.",
          .otherwise = otherwise,
          .range = {0.2, 60}};
}

const Listing& button_listing() {
  static const Listing kListing{
      "buttons[]",
      "A button that somebody presses.",
      {{.key = "name", .type = Type::text, .doc = "Unique; who presses it, for people and the log.", .required = true},
       {.key = "does",
        .type = Type::choice,
        .doc = "`hold` holds at once and refuses GO while it is pressed; `emergency-hold` until somebody says ok, too; "
               "`acknowledge` answers a cue light.",
        .required = true,
        .choices = {"go", "hold", "emergency-hold", "acknowledge", "order"}},
       {.key = "order", .type = Type::text, .doc = "`does: order`: in the words of the desk.", .otherwise = "none"},
       {.key = "cue_light", .type = Type::text, .doc = "`does: acknowledge`: which one.", .otherwise = "all"},
       line_field(),
       osc_field(),
       active_field("Level while it is pressed."),
       pull_field(),
       lost_after_field("it is never lost")},
      "line osc"};
  return kListing;
}

const Listing& gate_listing() {
  static const Listing kListing{"gates[]",
                                "What tells that a gate of the show is closed.",
                                {{.key = "gate", .type = Type::text, .doc = "Of the show's `gates`.", .required = true},
                                 line_field(),
                                 osc_field(),
                                 active_field("Level while it is closed."),
                                 pull_field(),
                                 lost_after_field("2.5 s")},
                                "line osc"};
  return kListing;
}

const Listing& cue_light_listing() {
  static const Listing kListing{
      "cue_lights[]",
      "A cue light: red flashes for standby and is steady when it is acknowledged, green flashes in pairs for GO.",
      {{.key = "name", .type = Type::text, .doc = "Unique.", .required = true},
       {.key = "red", .type = Type::text, .doc = "GPIO chip and line, as `gpiochip0:20`.", .required = true},
       {.key = "green", .type = Type::text, .doc = "GPIO chip and line.", .required = true},
       active_field("Level while a lamp is lit.")}};
  return kListing;
}

const Listing& tally_listing() {
  static const Listing kListing{
      "tallies[]",
      "A lamp that tells how the show is.",
      {{.key = "shows",
        .type = Type::choice,
        .doc = "`running`: it counts in, runs or walks back; `held`: it is held; `alarm`: since an alarm, until "
               "somebody says ok.",
        .required = true,
        .choices = {"running", "held", "alarm"}},
       {.key = "line", .type = Type::text, .doc = "GPIO chip and line, as `gpiochip0:22`.", .required = true},
       active_field("Level while it is lit.")}};
  return kListing;
}

}  // namespace

const Listing& remote_listing() {
  static const Listing kListing{
      "remote.yaml",
      "From where a show is led besides the desk, and what it tells back (docs/remote.md).",
      {{.key = "remote", .type = Type::integer, .doc = "Version of this format.", .required = true, .range = {1, 1}},
       {.key = "osc", .type = Type::mapping, .doc = "OSC.", .otherwise = "off", .listing = &osc_listing()},
       {.key = "midi", .type = Type::mapping, .doc = "MIDI.", .otherwise = "off", .listing = &midi_listing()},
       {.key = "buttons",
        .type = Type::mapping,
        .doc = "Any number.",
        .otherwise = "none",
        .listing = &button_listing(),
        .list = true},
       {.key = "gates",
        .type = Type::mapping,
        .doc = "One for each gate of the show.",
        .otherwise = "none",
        .listing = &gate_listing(),
        .list = true},
       {.key = "cue_lights",
        .type = Type::mapping,
        .doc = "Any number.",
        .otherwise = "none",
        .listing = &cue_light_listing(),
        .list = true},
       {.key = "tallies",
        .type = Type::mapping,
        .doc = "Any number.",
        .otherwise = "none",
        .listing = &tally_listing(),
        .list = true}}};
  return kListing;
}

}  // namespace footlight::config
