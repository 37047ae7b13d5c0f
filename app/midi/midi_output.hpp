// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"

namespace footlight::app {

/// Where MIDI goes. One thread.
class MidiOutput {
 public:
  virtual ~MidiOutput() = default;
  /// @param message whole, status byte first @return false: it is lost
  virtual bool send(std::span<const std::uint8_t> message) noexcept = 0;
};

/// @param port as `open_midi_input`, of the ports that take something
/// Errors: ErrorKind::device.
[[nodiscard]] Result<std::unique_ptr<MidiOutput>> open_midi_output(const std::string& port);

/// A port of the machine's sequencer, by RtMidi; `open_midi_output` chooses.
[[nodiscard]] Result<std::unique_ptr<MidiOutput>> open_midi_output_port(const std::string& port);

}  // namespace footlight::app
