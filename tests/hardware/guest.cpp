// SPDX-License-Identifier: Apache-2.0
#include "tests/hardware/guest.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "core/clock.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::hardware {
namespace {

constexpr int kAnswerMs = 10'000;

/// The virtio port whose other end is QEMU's monitor.
std::string control_port() {
  for (const auto& port : std::filesystem::directory_iterator("/sys/class/virtio-ports")) {
    std::string name;
    std::getline(std::ifstream(port.path() / "name"), name);
    if (name == "footlight.qmp") return "/dev/" + port.path().filename().string();
  }
  return {};
}

class Control {
 public:
  Control() : port_(::open(control_port().c_str(), O_RDWR | O_CLOEXEC)) {
    EXPECT_GE(port_.get(), 0) << "no control channel";
    // The session outlives programs: only the first of them is greeted, and the others are told that it is open.
    ask(R"({"execute":"qmp_capabilities"})");
  }

  /// @param event to wait for besides the answer, as "DEVICE_DELETED"; it may come before or after it
  std::string ask(const std::string& request, const std::string& event = {}) {
    EXPECT_EQ(::write(port_.get(), (request + "\n").data(), request.size() + 1),
              static_cast<ssize_t>(request.size() + 1));
    std::string answer;
    for (bool happened = event.empty(); answer.empty() || !happened;) {
      const std::string line = read_line();
      if (line.empty()) return line;
      if (line.find("\"return\"") != std::string::npos) answer = line;
      if (line.find("\"error\"") != std::string::npos) return line;
      if (!happened) happened = line.find(event) != std::string::npos;
    }
    return answer;
  }

 private:
  std::string read_line() {
    std::string line;
    for (char byte = 0; byte != '\n'; line += byte) {
      struct pollfd ready {
        port_.get(), POLLIN, 0
      };
      if (::poll(&ready, 1, kAnswerMs) != 1 || ::read(port_.get(), &byte, 1) != 1) return {};
    }
    return line;
  }

  FileDescriptor port_;
};

void command(const std::string& request, const std::string& event = {}) {
  static Control control;
  const std::string answer = control.ask(request, event);
  EXPECT_NE(answer.find("\"return\""), std::string::npos) << request << "\n" << answer;
}

}  // namespace

std::string run(const std::string& shell_command) {
  std::string output;
  std::FILE* pipe = ::popen((shell_command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t read = 0; (read = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    output.append(buffer.data(), read);
  }
  EXPECT_EQ(::pclose(pipe), 0) << shell_command << "\n" << output;
  return output;
}

Instant guest_now() {
  static const SteadyClock clock;
  return clock.now();
}

bool eventually(const std::function<bool()>& condition, Duration limit) {
  const Instant end = guest_now() + limit;
  while (!condition()) {
    if (guest_now() >= end) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

void unplug(const std::string& device) {
  command(R"({"execute":"device_del","arguments":{"id":")" + device + R"("}})", "DEVICE_DELETED");
}

void plug(const std::string& arguments) { command(R"({"execute":"device_add","arguments":{)" + arguments + "}}"); }

}  // namespace footlight::hardware
