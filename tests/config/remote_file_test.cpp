// SPDX-License-Identifier: Apache-2.0
#include "config/remote_file.hpp"

#include <gtest/gtest.h>

#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

using Does = RemoteButton::Does;

class RemoteFile : public testing::Test {
 protected:
  Result<Remote, Diagnostics> load(const std::string& text) {
    folder_.write("remote.yaml", "remote: 1\n" + text);
    return read_remote(folder_.path("remote.yaml"), show_);
  }
  Remote read(const std::string& text) {
    auto remote = load(text);
    EXPECT_TRUE(remote) << (remote ? "" : remote.error().to_text());
    return remote ? std::move(remote).value() : Remote{};
  }
  std::string errors(const std::string& text) {
    const auto remote = load(text);
    EXPECT_FALSE(remote);
    return remote ? "" : folder_.without_folder(remote.error().to_text());
  }

  ShowFolder folder_;
  Show show_;
};

TEST_F(RemoteFile, HasNothingOfItself) {
  const Remote remote = read("");
  EXPECT_FALSE(remote.osc);
  EXPECT_FALSE(remote.midi);
  EXPECT_TRUE(remote.buttons.empty() && remote.gates.empty() && remote.cue_lights.empty() && remote.tallies.empty());
}

TEST_F(RemoteFile, IsReadWhole) {
  show_.gates = {"trap closed", "lift level"};
  const Remote remote = read(
      "osc: {port: 9000, address: 0.0.0.0, from: [10.0.0.4, \"FE80::0001\"], token: osc.token, replies: 53001,\n"
      "      state: [\"10.0.0.4:53001\", \"[::1]:7\"], rate: 20}\n"
      "midi: {port: USB MIDI, device: 3, format: machinery, macros: [{number: 7, order: hold end}]}\n"
      "buttons:\n"
      "  - {name: GO, does: go, line: \"gpiochip0:5\", active: low, pull: up}\n"
      "  - {name: spotter left, does: hold, osc: true, lost_after: 1 s}\n"
      "  - {name: stop, does: emergency-hold, line: \"gpiochip0:6\"}\n"
      "  - {name: flies, does: acknowledge, cue_light: flies, line: \"gpiochip0:7\"}\n"
      "  - {name: back, does: order, order: back, line: \"gpiochip0:8\"}\n"
      "gates:\n"
      "  - {gate: lift level, osc: true}\n"
      "  - {gate: trap closed, line: \"desk:0\", pull: down}\n"
      "cue_lights: [{name: flies, red: \"gpiochip0:20\", green: \"gpiochip0:21\", active: low}]\n"
      "tallies: [{shows: held, line: \"gpiochip0:22\"}]\n");
  ASSERT_TRUE(remote.osc && remote.midi);
  EXPECT_EQ(remote.osc->listen, (NetworkPlace{"0.0.0.0", 9000}));
  EXPECT_EQ(remote.osc->from, (std::vector<std::string>{"10.0.0.4", "fe80::1"}));
  EXPECT_EQ(remote.osc->token_file, folder_.path("osc.token"));
  EXPECT_EQ(remote.osc->state, (std::vector<NetworkPlace>{{"10.0.0.4", 53001}, {"::1", 7}}));
  EXPECT_EQ(remote.midi->format, 0x20);
  EXPECT_EQ(remote.midi->macros.at(0).order, "hold end");
  ASSERT_EQ(remote.buttons.size(), 5U);
  EXPECT_TRUE(remote.buttons[0].input.line->active_low);
  EXPECT_EQ(remote.buttons[0].input.line->pull, GpioPlace::Pull::up);
  EXPECT_EQ(remote.buttons[1].does, Does::hold);
  EXPECT_EQ(remote.buttons[1].input.lost_after, seconds(1));
  EXPECT_FALSE(remote.buttons[1].input.line);
  EXPECT_EQ(remote.buttons[2].does, Does::emergency_hold);
  EXPECT_EQ(remote.buttons[4].order, "back");
  ASSERT_EQ(remote.gates.size(), 2U);
  EXPECT_EQ(remote.gates[0].gate, 1U);
  EXPECT_EQ(remote.gates[0].input.lost_after, milliseconds(2500));
  EXPECT_EQ(remote.gates[1].input.line->chip, "desk");
  EXPECT_TRUE(remote.cue_lights.at(0).green.active_low);
  EXPECT_EQ(remote.tallies.at(0).shows, TallyLine::Shows::held);
}

TEST_F(RemoteFile, ADoorThatOthersMayUseNeedsAListOfThemAndAToken) {
  EXPECT_EQ(errors("osc: {address: 0.0.0.0}\n"),
            "remote.yaml:2:16: error: osc.address: others may send, and nobody says who (from: [10.0.0.4], the "
            "addresses that are heard)\n"
            "remote.yaml:2:16: error: osc.address: others may send, and OSC has no identity (token: osc.token)\n");
  EXPECT_EQ(read("osc: {address: \"::1\"}\n").osc->from, (std::vector<std::string>{"127.0.0.1", "::1"}));
}

TEST_F(RemoteFile, TellsAllThatIsWrongAtItsPlace) {
  show_.gates = {"trap closed"};
  EXPECT_EQ(errors("osc: {port: 70000, from: desk.local, state: [\"10.0.0.4\"]}\n"
                   "midi: {device: 112, macros: [{number: 1, order: go}, {number: 1, order: hold}]}\n"
                   "buttons:\n"
                   "  - {name: a, does: go, line: gpiochip0}\n"
                   "  - {name: a, does: order, line: \"c:1\"}\n"
                   "  - {name: b, does: hold, order: go, line: \"c:1\", lost_after: 1 s}\n"
                   "  - {name: c, does: acknowledge, cue_light: left, osc: true, pull: up}\n"
                   "gates: [{gate: trap, line: \"c:2\"}, {gate: trap closed, line: \"c:3\", osc: true}]\n"),
            "remote.yaml:2:13: error: osc.port: \"70000\" is out of range (1 to 65535)\n"
            "remote.yaml:2:26: error: osc.from: \"desk.local\" is no address (numbers, as 10.0.0.4 or fe80::1)\n"
            "remote.yaml:2:46: error: osc.state[0]: \"10.0.0.4\" is no address with a port (as 10.0.0.4:53001, "
            "[fe80::1]:53001)\n"
            "remote.yaml:3:1: error: midi.port: the key is missing (Name, part of a name or number of a port, or the "
            "path of a raw MIDI device.)\n"
            "remote.yaml:3:16: error: midi.device: \"112\" is out of range (0 to 111)\n"
            "remote.yaml:3:63: error: midi.macros[1].number: a second macro has the number 1 (one order for each)\n"
            "remote.yaml:5:31: error: buttons[0].line: \"gpiochip0\" is no GPIO line (chip and number, as "
            "gpiochip0:17)\n"
            "remote.yaml:6:12: error: buttons[1].name: a second button has the name \"a\" (unique)\n"
            "remote.yaml:6:21: error: buttons[1].does: no order is given (order: hold end)\n"
            "remote.yaml:7:27: error: buttons[2].order: the key has no meaning here (does: order)\n"
            "remote.yaml:7:44: error: buttons[2].line: the line \"c:1\" is used twice (one use for each line)\n"
            "remote.yaml:7:51: error: buttons[2].lost_after: the key has no meaning here (only what is told by OSC "
            "falls silent)\n"
            "remote.yaml:8:45: error: buttons[3].cue_light: no cue light has the name \"left\"\n"
            "remote.yaml:8:62: error: buttons[3].pull: the key has no meaning here (only a line has a level)\n"
            "remote.yaml:9:16: error: gates[0].gate: the show has no gate \"trap\" (did you mean \"trap closed\"?)\n"
            "remote.yaml:9:69: error: gates[1].osc: does not go with \"line\" (give exactly one of line, osc)\n");
}

TEST_F(RemoteFile, EveryGateOfTheShowIsTold) {
  show_.gates = {"trap closed", "lift level"};
  EXPECT_EQ(errors("gates: [{gate: trap closed, line: \"c:3\"}]\n"),
            "remote.yaml:2:8: error: gates: nothing tells the show's gate \"lift level\" (- {gate: lift level, line: "
            "gpiochip0:17})\n");
}

TEST_F(RemoteFile, ButtonsAndGatesByOscNeedOsc) {
  EXPECT_EQ(errors("buttons: [{name: a, does: hold, osc: true}, {name: b, does: hold, osc: false}]\n"),
            "remote.yaml:2:38: error: buttons[0].osc: nobody listens to OSC (the key osc of this file)\n"
            "remote.yaml:2:72: error: buttons[1].osc: nothing tells it (osc: true, or a line)\n"
            "remote.yaml:2:72: error: buttons[1].osc: nobody listens to OSC (the key osc of this file)\n");
}

}  // namespace
}  // namespace footlight::config
