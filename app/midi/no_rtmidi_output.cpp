// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_output.hpp"

namespace footlight::app {

Result<std::unique_ptr<MidiOutput>> open_midi_output_port(const std::string& port) {
  return device_error("MIDI port \"" + port +
                      "\": this program was built without RtMidi (install librtmidi-dev and build again)");
}

}  // namespace footlight::app
