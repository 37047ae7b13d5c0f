// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_output.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

/// A file of the kernel: a raw MIDI device, or a FIFO.
class MidiDeviceOutput final : public MidiOutput {
 public:
  explicit MidiDeviceOutput(FileDescriptor file) : file_(std::move(file)) {}
  bool send(std::span<const std::uint8_t> message) noexcept override {
    return ::write(file_.get(), message.data(), message.size()) == static_cast<ssize_t>(message.size());
  }

 private:
  FileDescriptor file_;
};

}  // namespace

Result<std::unique_ptr<MidiOutput>> open_midi_output(const std::string& port) {
  if (port.find('/') == std::string::npos) return open_midi_output_port(port);
  // Read and write: a FIFO opens before anybody listens.
  FileDescriptor file(::open(port.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) file = FileDescriptor(::open(port.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) {
    return device_error("MIDI device \"" + port + "\": " + std::generic_category().message(errno));
  }
  return std::unique_ptr<MidiOutput>(std::make_unique<MidiDeviceOutput>(std::move(file)));
}

}  // namespace footlight::app
