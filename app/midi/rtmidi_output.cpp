// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include <RtMidi.h>
#include <unistd.h>

#include "app/midi/midi_input.hpp"
#include "app/midi/midi_output.hpp"

namespace footlight::app {
namespace {

class RtMidiOutput final : public MidiOutput {
 public:
  explicit RtMidiOutput(std::unique_ptr<RtMidiOut> output) : output_(std::move(output)) {}
  bool send(std::span<const std::uint8_t> message) noexcept override {
    try {
      output_->sendMessage(message.data(), message.size());
      return true;
    } catch (const RtMidiError&) {
      return false;
    }
  }

 private:
  std::unique_ptr<RtMidiOut> output_;
};

}  // namespace

Result<std::unique_ptr<MidiOutput>> open_midi_output_port(const std::string& port) {
  // As for inputs: where there is no sequencer the libraries print, so they are not asked.
  constexpr const char* kSequencer = "/dev/snd/seq";
  if (::access(kSequencer, R_OK | W_OK) != 0) {
    return device_error(std::string("MIDI: no sequencer here: ") + kSequencer + ": " +
                        std::generic_category().message(errno) +
                        " (the kernel module snd-seq, and membership of the group audio)");
  }
  try {
    auto output = std::make_unique<RtMidiOut>(RtMidi::LINUX_ALSA, "footlight");
    output->setErrorCallback([](RtMidiError::Type, const std::string&, void*) {});
    std::vector<std::string> names;
    for (unsigned i = 0; i < output->getPortCount(); ++i) names.push_back(output->getPortName(i));
    const auto number = find_midi_port(names, port);
    if (!number) return number.error();
    output->openPort(*number, "out");
    return std::unique_ptr<MidiOutput>(std::make_unique<RtMidiOutput>(std::move(output)));
  } catch (const RtMidiError& error) {
    return device_error("MIDI port \"" + port + "\": not opened: " + error.getMessage());
  }
}

}  // namespace footlight::app
