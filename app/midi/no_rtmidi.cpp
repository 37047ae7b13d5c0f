// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_input.hpp"

namespace footlight::app {
namespace {

Error without(const std::string& what) {
  return device_error(what + ": this program was built without RtMidi (install librtmidi-dev and build again)");
}

}  // namespace

Result<std::vector<std::string>> midi_input_ports() { return without("MIDI"); }

Result<std::unique_ptr<MidiInput>> open_midi_port(const std::string& port, const Clock& /*clock*/) {
  return without("MIDI port \"" + port + "\"");
}

}  // namespace footlight::app
