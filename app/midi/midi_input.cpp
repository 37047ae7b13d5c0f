// SPDX-License-Identifier: Apache-2.0
#include "app/midi/midi_input.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/check.hpp"

namespace footlight::app {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

FileDescriptor make_event() {
  FileDescriptor event(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  FL_CHECK(event.get() >= 0);
  return event;
}

void ring_event(int event) {
  const std::uint64_t one = 1;
  (void)!::write(event, &one, sizeof one);  // full: it is awake
}

/// Bytes of a file of the kernel, by a thread that does nothing else.
class MidiDevice final : public MidiInput {
 public:
  MidiDevice(const std::string& path, FileDescriptor file, const Clock& clock)
      : MidiInput(path), file_(std::move(file)), clock_(clock), stop_(make_event()), thread_([this] { run(); }) {}
  ~MidiDevice() override {
    ring_event(stop_.get());
    thread_.join();
  }

 private:
  void run() noexcept {
    std::array<pollfd, 2> files{pollfd{file_.get(), POLLIN, 0}, pollfd{stop_.get(), POLLIN, 0}};
    while (true) {
      const int ready = ::poll(files.data(), files.size(), -1);
      if (files[1].revents != 0) return;
      if (ready < 0 && errno == EINTR) continue;
      if (ready < 0 || !read_all()) return close();
    }
  }
  /// @return false when the device is gone
  bool read_all() noexcept {
    std::array<std::uint8_t, 256> buffer{};
    const ssize_t count = ::read(file_.get(), buffer.data(), buffer.size());
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    const Instant now = clock_.now();
    for (const std::uint8_t byte : std::span(buffer.data(), static_cast<std::size_t>(count))) {
      const auto message = bytes_.take(byte);
      if (!message.empty() && message[0] != kActiveSensing) receive(message, now);
    }
    lose(bytes_.lost() - std::exchange(told_lost_, bytes_.lost()));
    return count > 0;
  }

  static constexpr std::uint8_t kActiveSensing = 0xFE;
  FileDescriptor file_;
  const Clock& clock_;
  MidiBytes bytes_;
  std::uint64_t told_lost_ = 0;
  FileDescriptor stop_;
  std::thread thread_;
};

Error not_opened(const std::string& path, const std::string& why, const std::string& right) {
  return device_error("MIDI device \"" + path + "\": " + why + " (" + right + ")");
}

Result<std::unique_ptr<MidiInput>> open_midi_device(const std::string& path, const Clock& clock) {
  struct stat what {};
  if (::stat(path.c_str(), &what) != 0) {
    return not_opened(path, std::generic_category().message(errno), "`amidi -l` lists those of this machine");
  }
  if (!S_ISCHR(what.st_mode) && !S_ISFIFO(what.st_mode)) {
    return not_opened(path, "neither a device nor a FIFO", "such as /dev/snd/midiC1D0");
  }
  // A FIFO that is open for writing, too, has no end when another program closes it.
  const int way = S_ISFIFO(what.st_mode) ? O_RDWR : O_RDONLY;
  FileDescriptor file(::open(path.c_str(), way | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) {
    return not_opened(path, std::generic_category().message(errno), "a device that this user may read, nobody else's");
  }
  return std::unique_ptr<MidiInput>(std::make_unique<MidiDevice>(path, std::move(file), clock));
}

}  // namespace

MidiInput::MidiInput(std::string name) : name_(std::move(name)), event_(make_event()) {}

std::optional<MidiMessage> MidiInput::take() noexcept {
  if (auto message = ring_.pop()) return message;
  std::uint64_t count = 0;
  (void)!::read(event_.get(), &count, sizeof count);
  return ring_.pop();  // what came after the first look, before the event was taken back
}

void MidiInput::receive(std::span<const std::uint8_t> message, Instant at) noexcept {
  if (message.empty()) return;
  if (message.size() > kLongestMidiMessage) return lose();
  MidiMessage out;
  out.at = at;
  out.size = static_cast<std::uint16_t>(message.size());
  std::ranges::copy(message, out.bytes.begin());
  if (!ring_.push(out)) lose();
  wake();
}

void MidiInput::close() noexcept {
  closed_.store(true, std::memory_order_relaxed);
  wake();
}

void MidiInput::wake() noexcept { ring_event(event_.get()); }

Result<std::unique_ptr<MidiInput>> open_midi_input(const std::string& port, const Clock& clock) {
  return port.starts_with('/') ? open_midi_device(port, clock) : open_midi_port(port, clock);
}

Result<unsigned> find_midi_port(const std::vector<std::string>& ports, const std::string& wanted) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  if (error == std::errc{} && end == wanted.data() + wanted.size() && number < ports.size()) return number;
  std::vector<unsigned> found;
  std::string all;
  for (unsigned i = 0; i < ports.size(); ++i) {
    all += (i > 0 ? ", " : "") + std::to_string(i) + " \"" + ports[i] + "\"";
    if (lower(ports[i]) == lower(wanted)) return i;
    if (!wanted.empty() && lower(ports[i]).find(lower(wanted)) != std::string::npos) found.push_back(i);
  }
  if (found.size() == 1) return found[0];
  const std::string there = ports.empty() ? "there is none" : "there are " + all;
  return device_error("MIDI port \"" + wanted +
                      "\": " + (found.empty() ? "no such port" : "more than one is called so") + " (" + there + ")");
}

}  // namespace footlight::app
