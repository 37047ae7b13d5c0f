// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

#include <RtMidi.h>
#include <unistd.h>

#include "app/midi/midi_input.hpp"

namespace footlight::app {
namespace {

constexpr const char* kClient = "footlight";

/// The library would print them; what matters is thrown, too.
void say_nothing(RtMidiError::Type /*type*/, const std::string& /*text*/, void* /*nothing*/) {}

Error no_midi(const std::string& why) {
  return device_error("MIDI: no sequencer here: " + why +
                      " (the kernel module snd-seq, and membership of the group audio)");
}

/// Only ALSA's sequencer has ports: JACK would have to be started. Where there is none the libraries print, so they are
/// not asked.
Result<std::unique_ptr<RtMidiIn>> make_input() {
  constexpr const char* kSequencer = "/dev/snd/seq";
  if (::access(kSequencer, R_OK | W_OK) != 0) {
    return no_midi(std::string(kSequencer) + ": " + std::generic_category().message(errno));
  }
  try {
    return std::make_unique<RtMidiIn>(RtMidi::LINUX_ALSA, kClient);
  } catch (const RtMidiError& error) {
    return no_midi(error.getMessage());
  }
}

class RtMidiPort final : public MidiInput {
 public:
  RtMidiPort(std::string name, std::unique_ptr<RtMidiIn> input, const Clock& clock)
      : MidiInput(std::move(name)), input_(std::move(input)), clock_(clock) {
    input_->ignoreTypes(false, false, true);
    input_->setCallback(
        [](double /*since_last_s*/, std::vector<unsigned char>* message, void* self) {
          auto* port = static_cast<RtMidiPort*>(self);
          port->receive(*message, port->clock_.now());
        },
        this);
  }
  ~RtMidiPort() override {
    try {
      input_->cancelCallback();
      input_->closePort();  // joins its thread
    } catch (const RtMidiError&) {
      // It is going anyway.
    }
  }
  void open(unsigned number) { input_->openPort(number, "in"); }

 private:
  std::unique_ptr<RtMidiIn> input_;
  const Clock& clock_;
};

std::vector<std::string> names_of(RtMidiIn& input) {
  std::vector<std::string> names;
  for (unsigned i = 0; i < input.getPortCount(); ++i) names.push_back(input.getPortName(i));
  return names;
}

}  // namespace

Result<std::vector<std::string>> midi_input_ports() {
  auto input = make_input();
  if (!input) return std::move(input).error();
  try {
    (*input)->setErrorCallback(say_nothing);
    return names_of(**input);
  } catch (const RtMidiError& error) {
    return no_midi(error.getMessage());
  }
}

Result<std::unique_ptr<MidiInput>> open_midi_port(const std::string& port, const Clock& clock) {
  auto input = make_input();
  if (!input) return std::move(input).error();
  try {
    const std::vector<std::string> names = names_of(**input);
    const auto number = find_midi_port(names, port);
    if (!number) return number.error();
    auto opened = std::make_unique<RtMidiPort>(names[*number], std::move(input).value(), clock);
    opened->open(*number);
    return std::unique_ptr<MidiInput>(std::move(opened));
  } catch (const RtMidiError& error) {
    return device_error("MIDI port \"" + port + "\": not opened: " + error.getMessage());
  }
}

}  // namespace footlight::app
