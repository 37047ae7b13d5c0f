// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/spsc_ring.hpp"
#include "app/midi/midi_bytes.hpp"
#include "core/clock.hpp"
#include "core/file_descriptor.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// A whole message as it is on the wire, status byte first.
struct MidiMessage {
  Instant at{};  ///< when its last byte came, by the clock that the input was opened with
  std::uint16_t size = 0;
  std::array<std::uint8_t, kLongestMidiMessage> bytes{};

  [[nodiscard]] std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};

/// Where MIDI comes in: short messages, system exclusive, time code, clock; active sensing is left out. A thread of the
/// library or of its own receives and stamps, one other thread takes. A flood loses messages and is counted; nobody
/// waits for anybody.
class MidiInput {
 public:
  virtual ~MidiInput() = default;
  MidiInput(const MidiInput&) = delete;
  MidiInput& operator=(const MidiInput&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// The oldest message that waits. The taking thread.
  std::optional<MidiMessage> take() noexcept;
  /// Becomes readable when there is something to take.
  [[nodiscard]] int poll_handle() const { return event_.get(); }
  /// Messages that nobody took in time, that were too long or cut off. Any thread.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// The device is gone, nothing comes any more. Any thread.
  [[nodiscard]] bool closed() const noexcept { return closed_.load(std::memory_order_relaxed); }

 protected:
  explicit MidiInput(std::string name);
  // The receiving thread.
  void receive(std::span<const std::uint8_t> message, Instant at) noexcept;
  void lose(std::uint64_t messages = 1) noexcept { lost_.fetch_add(messages, std::memory_order_relaxed); }
  void close() noexcept;

 private:
  void wake() noexcept;

  std::string name_;
  FileDescriptor event_;
  SpscRing<MidiMessage, 256> ring_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<bool> closed_{false};
};

/// @param port its number ("0"), its whole name or the one part of a name that only it has, upper or lower case, as
/// `midi_input_ports` lists them; or the path of a raw MIDI device ("/dev/snd/midiC1D0") or of a FIFO
/// Errors: ErrorKind::device: no such port, not ours to open, or a program built without RtMidi (which needs none for a
/// path).
[[nodiscard]] Result<std::unique_ptr<MidiInput>> open_midi_input(const std::string& port, const Clock& clock);

/// The ports of this machine, by number. Errors: ErrorKind::device: no MIDI here, or a program built without RtMidi.
[[nodiscard]] Result<std::vector<std::string>> midi_input_ports();

/// @return its number. Errors say which there are.
[[nodiscard]] Result<unsigned> find_midi_port(const std::vector<std::string>& ports, const std::string& wanted);

/// A port of the machine's sequencer, by RtMidi; `open_midi_input` chooses.
[[nodiscard]] Result<std::unique_ptr<MidiInput>> open_midi_port(const std::string& port, const Clock& clock);

}  // namespace footlight::app
