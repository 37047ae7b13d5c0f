// SPDX-License-Identifier: Apache-2.0
#include "config/device_profile.hpp"

#include <gtest/gtest.h>

#include "config/field.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class ProfileFile : public ::testing::Test {
 protected:
  /// What is wrong with a profile, its path shortened.
  std::string messages(const std::string& yaml) {
    folder_.write("lamp.yaml", yaml);
    const std::string file = folder_.path("lamp.yaml").string();
    Diagnostics diagnostics;
    EXPECT_EQ(read_profile(file, diagnostics), std::nullopt);
    std::string text = diagnostics.to_text();
    for (auto at = text.find(file); at != std::string::npos; at = text.find(file, at))
      text.replace(at, file.size(), "lamp.yaml");
    return text;
  }
  ModbusProfile right(const std::string& yaml) {
    Diagnostics diagnostics;
    folder_.write("lamp.yaml", yaml);
    const auto profile = read_profile(folder_.path("lamp.yaml"), diagnostics);
    EXPECT_TRUE(profile.has_value()) << diagnostics.to_text();
    return profile.value_or(ModbusProfile{});
  }
  ShowFolder folder_;
};

TEST_F(ProfileFile, EveryShippedProfileIsRight) {
  EXPECT_EQ(shipped_profiles(), (std::vector<std::string>{"cia401-32do", "dmx-dimmer", "dmx-rgb", "footlight-marker",
                                                          "pick-light", "relay-16"}));
  for (const std::string& name : shipped_profiles()) {
    Diagnostics diagnostics;
    if (name.starts_with("cia401")) {
      const auto module = read_output_module(find_profile(name, "/").value(), diagnostics);
      ASSERT_TRUE(module) << diagnostics.to_text();
      EXPECT_EQ(module->name, name);
      continue;
    }
    if (name.starts_with("dmx")) {
      const auto fixture = read_fixture(find_profile(name, "/").value(), diagnostics);
      ASSERT_TRUE(fixture) << diagnostics.to_text();
      EXPECT_EQ(fixture->name, name);
      continue;
    }
    const auto profile = read_profile(find_profile(name, "/").value(), diagnostics);
    ASSERT_TRUE(profile) << diagnostics.to_text();
    EXPECT_EQ(profile->name, name) << "the name is the file's";
    EXPECT_TRUE(diagnostics.empty());
  }
}

TEST_F(ProfileFile, OfARelayModuleHasCoils) {
  Diagnostics diagnostics;
  const ModbusProfile relays = read_profile(find_profile("relay-16", "/").value(), diagnostics).value();
  EXPECT_TRUE(relays.coils);
  EXPECT_EQ(relays.channels, 16);
  EXPECT_FALSE(relays.has_preload_sequence);
  EXPECT_TRUE(relays.readable_looks);
  EXPECT_FALSE(relays.has_broadcast);
  EXPECT_TRUE(relays.restarts_for_address);
  EXPECT_FALSE(relays.proves_looks());
}

TEST_F(ProfileFile, ReadsStatesPaletteHealthAndQuirks) {
  const ModbusProfile profile = right(
      "profile: 1\nname: lamp\nlook_register: 7\nlooks_per_register: 1\n"
      "states: {register: 0x100, stride: 8, count: 5, effect_at: 7, effects: [{effect: pulse, value: 9}]}\n"
      "health: [{name: battery, register: 50, scale: 0.5, unit: \"%\", signed: true}]\n"
      "word_order: low-first\nquirks: [write-one-by-one, no-broadcast]\npause_after_write: 20 ms\n");
  ASSERT_TRUE(profile.states);
  EXPECT_EQ(profile.states->first_register, 256);
  EXPECT_EQ(profile.states->effect_offset, 7);
  EXPECT_EQ(profile.states->effects, (std::vector<EffectCode>{{9, Effect::pulse}}));
  EXPECT_EQ(profile.health, (std::vector<HealthRegister>{{"battery", 50, 0.5, "%", true}}));
  EXPECT_TRUE(profile.low_word_first);
  EXPECT_TRUE(profile.writes_one_by_one);
  EXPECT_FALSE(profile.has_broadcast);
  EXPECT_EQ(profile.pause_after_write, milliseconds(20));
  const ModbusProfile colours = right(
      "profile: 1\nname: lamp\nlook_register: 7\n"
      "palette: [{value: 3, colour: \"#000000\"}, {value: 5, colour: \"#FF8000\", effect: blink}]\n");
  EXPECT_EQ(colours.palette, (std::vector<PaletteEntry>{{3, {{0, 0, 0}}}, {5, {{255, 128, 0}, Effect::blink}}}));
}

TEST_F(ProfileFile, RefusesUnknownKeysAndValuesWithAGuess) {
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_regster: 7\nquirks: [no-broadcst]\n"),
            "lamp.yaml:1:1: error: one of the keys look_register, look_coil, lamp_slots, outputs is missing (give "
            "exactly one of "
            "them)\n"
            "lamp.yaml:3:1: error: look_regster: unknown key (did you mean \"look_register\"?)\n"
            "lamp.yaml:4:10: error: quirks[0]: \"no-broadcst\" is not a quirk that we know (did you mean "
            "\"no-broadcast\"?)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 70000\n"),
            "lamp.yaml:3:16: error: look_register: \"70000\" is out of range (0 to 65535)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 7\nlook_coil: 0\n"),
            "lamp.yaml:4:1: error: look_coil: does not go with \"look_register\" (give exactly one of look_register, "
            "look_coil, lamp_slots, outputs)\n");
}

TEST_F(ProfileFile, OfADmxLampHasItsSlotsAndNothingElse) {
  folder_.write("lamp.yaml", "profile: 1\nname: par\nlamp_slots: [dimmer, red, green, blue, white, zero]\n");
  Diagnostics diagnostics;
  const auto fixture = read_fixture(folder_.path("lamp.yaml"), diagnostics);
  ASSERT_TRUE(fixture) << diagnostics.to_text();
  EXPECT_EQ(*fixture,
            (DmxFixture{
                "par", {DmxSlot::dimmer, DmxSlot::red, DmxSlot::green, DmxSlot::blue, DmxSlot::white, DmxSlot::zero}}));
  folder_.write("lamp.yaml", "profile: 1\nname: par\nlamp_slots: [dimer, red]\nreadback: true\n");
  EXPECT_EQ(read_fixture(folder_.path("lamp.yaml"), diagnostics), std::nullopt);
  const std::string file = folder_.path("lamp.yaml").string();
  EXPECT_EQ(diagnostics.to_text(),
            file + ":3:14: error: lamp_slots[0]: \"dimer\" is no kind of slot (did you mean \"dimmer\"?)\n" + file +
                ":4:1: error: readback: the key has no meaning here (a DMX lamp has a name and lamp_slots)\n");
}

TEST_F(ProfileFile, RefusesAPaletteThatCannotBeDarkOrRepeatsANumber) {
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 7\npalette:\n"
                     "  - {value: 1, colour: red}\n  - {value: 2, colour: \"#FF0000\"}\n"
                     "  - {value: 2, colour: \"#00FF00\"}\n  - {value: 300, colour: \"#00FF00\"}\n"),
            "lamp.yaml:5:3: error: palette: the palette has nothing dark (an entry of colour \"#000000\" and one of "
            "another colour)\n"
            "lamp.yaml:5:24: error: palette[0].colour: \"red\" is not a colour (#RRGGBB)\n"
            "lamp.yaml:7:13: error: palette[2].value: the value 2 stands here for the second time (each once)\n"
            "lamp.yaml:8:13: error: palette[3].value: \"300\" is out of range (0 to 255)\n");
}

TEST_F(ProfileFile, RefusesStatesWithoutNumbersOrBeyondTheirStride) {
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 7\n"
                     "states: {register: 100, stride: 3, count: 4, effect_at: 3, colours: [{colour: \"#FF0000\", "
                     "value: 1}]}\n"),
            "lamp.yaml:4:57: error: states.effect_at: the register 3 belongs to the next state (below the stride of "
            "3)\n"
            "lamp.yaml:4:57: error: states.effect_at: the device's numbers of its effects are missing (list them under "
            "effects)\n"
            "lamp.yaml:4:69: error: states.colours: the states have colours and nowhere to write them (give colour_at "
            "as well)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 7\nstates: {register: 65000, stride: 600, count: 1}\n"),
            "lamp.yaml:4:1: error: states: the states say neither effect nor colour nor brightness (give at least one "
            "of effect_at, colour_at, brightness_at)\n"
            "lamp.yaml:4:9: error: states: the states go beyond register 65535 (a smaller register, stride or "
            "count)\n");
}

TEST_F(ProfileFile, RefusesKeysThatMeanNothingTogether) {
  EXPECT_EQ(
      messages("profile: 1\nname: lamp\nlook_coil: 65530\nlooks_per_register: 2\npreload_sequence: true\n"
               "quirks: write-one-by-one\nreaddress_register: 9\n"),
      "lamp.yaml:3:12: error: look_coil: the looks of 32 channels go beyond 65535 (a smaller number)\n"
      "lamp.yaml:4:1: error: looks_per_register: the key has no meaning here (only registers hold several "
      "looks)\n"
      "lamp.yaml:5:19: error: preload_sequence: coils have no room for a sequence (false, or look_register)\n"
      "lamp.yaml:5:19: error: preload_sequence: a sequence and its looks are one write, and this device takes one "
      "register at a time (false, or no quirk write-one-by-one)\n"
      "lamp.yaml:7:21: error: readdress_register: nobody can be meant without a unique id (give "
      "unique_id_register as well)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 7\nlook_table_register: 80\n"
                     "palette: [{value: 0, colour: \"#000000\"}, {value: 1, colour: \"#FFFFFF\"}]\n"),
            "lamp.yaml:5:10: error: palette: a device with a palette has no look table to fill (give one of palette, "
            "states, look_table_register)\n");
}

class ModuleFile : public ProfileFile {
 protected:
  std::string module_messages(const std::string& yaml) {
    folder_.write("module.yaml", yaml);
    Diagnostics diagnostics;
    EXPECT_EQ(read_output_module(folder_.path("module.yaml"), diagnostics), std::nullopt);
    return folder_.without_folder(diagnostics.to_text());
  }
};

TEST_F(ModuleFile, SaysWhatAModuleIsAndNeeds) {
  folder_.write("module.yaml",
                "profile: 1\nname: sixteen\noutputs: 16\non_failure: keep\nheartbeat: 500 ms\nsilence: 2 s\n"
                "vendor: 0x195\nobjects: [{index: 0x2000, sub: 3, bits: 16, value: 0x1234}]\n"
                "currents: {lamp: 60 mA, node: 30 mA}\n");
  Diagnostics diagnostics;
  std::optional<LampCurrents> currents;
  const auto module = read_output_module(folder_.path("module.yaml"), diagnostics, &currents);
  ASSERT_TRUE(module) << diagnostics.to_text();
  EXPECT_EQ(module->outputs, 16);
  EXPECT_EQ(module->bytes(), 2);
  EXPECT_EQ(module->on_failure, OutputModule::OnFailure::keep);
  EXPECT_EQ(module->heartbeat, milliseconds(500));
  EXPECT_EQ(module->silence, milliseconds(2000));
  EXPECT_EQ(module->vendor, 0x195U);
  EXPECT_EQ(module->product, std::nullopt);
  EXPECT_EQ(module->objects, (std::vector<ObjectValue>{{0x2000, 3, 2, 0x1234}}));
  ASSERT_TRUE(currents);
  EXPECT_DOUBLE_EQ(currents->red_a, 0.02);
  EXPECT_DOUBLE_EQ(currents->node_a, 0.03);
}

TEST_F(ModuleFile, WrongValuesAreToldWithTheirPlace) {
  EXPECT_EQ(module_messages("profile: 1\nname: odd\noutputs: 33\non_failure: off\nheartbeat: 10 ms\nlook_coil: 0\n"
                            "objects:\n  - {index: 0x1400, sub: 1, bits: 32, value: 0}\n"
                            "  - {index: 0x2000, bits: 8, value: 256}\n  - {index: 0x2000, bits: 24, value: 1}\n"),
            "module.yaml:3:1: error: outputs: does not go with \"look_coil\" (give exactly one of look_register, "
            "look_coil, lamp_slots, outputs)\n"
            "module.yaml:3:10: error: outputs: \"33\" is out of range (1 to 32)\n"
            "module.yaml:4:13: error: on_failure: \"off\" is not one of the choices (choices: dark, lit, keep)\n"
            "module.yaml:5:12: error: heartbeat: \"10 ms\" is out of range (0.1 to 60 s)\n"
            "module.yaml:6:1: error: look_coil: the key has no meaning here (a CANopen module has outputs)\n"
            "module.yaml:8:13: error: objects[0].index: the controller writes this object by itself (leave it out)\n"
            "module.yaml:9:37: error: objects[1].value: 256 does not fit into 8 bits (at most 255)\n"
            "module.yaml:10:27: error: objects[2].bits: \"24\" is not one of the choices (choices: 8, 16, 32)\n");
  EXPECT_EQ(module_messages("profile: 1\nname: odd\nlook_coil: 0\n"),
            "module.yaml:1:1: error: outputs: this is the profile of a Modbus device (a CANopen module has outputs)\n");
  EXPECT_EQ(module_messages("profile: 1\nname: odd\noutputs: 8\nlook_register: 0\n"),
            "module.yaml:3:1: error: outputs: does not go with \"look_register\" (give exactly one of look_register, "
            "look_coil, lamp_slots, outputs)\n"
            "module.yaml:4:1: error: look_register: the key has no meaning here (a CANopen module has outputs)\n");
}

TEST_F(ModuleFile, OtherKindsHaveNoKeysOfAModule) {
  EXPECT_EQ(
      messages("profile: 1\nname: lamp\nlook_register: 0\nsilence: 1 s\n"),
      "lamp.yaml:4:1: error: silence: the key has no meaning here (a Modbus device has look_register or look_coil)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\noutputs: 8\n"),
            "lamp.yaml:3:1: error: outputs: this is the profile of a CANopen module (a Modbus device has look_register "
            "or look_coil)\n");
}

TEST_F(ProfileFile, WhatALampTakesIsToldOnce) {
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 0\ncurrents: {red: 1 A, lamp: 60 mA}\n"),
            "lamp.yaml:4:28: error: currents.lamp: the lamp's current is given twice, whole and by its colours (either "
            "lamp, or red, green and blue)\n");
  EXPECT_EQ(messages("profile: 1\nname: lamp\nlook_register: 0\ncurrents: {node: 60 mA}\n"),
            "lamp.yaml:4:1: error: currents: nothing says what a lamp takes (red, green and blue, for example 20 mA "
            "each, or lamp)\n");
}

}  // namespace
}  // namespace footlight::config
