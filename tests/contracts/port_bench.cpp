// SPDX-License-Identifier: Apache-2.0
#include "tests/contracts/port_bench.hpp"

#include <array>
#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "core/clock.hpp"
#include "core/file_descriptor.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "drivers/transports/serial_stream.hpp"
#include "sim/markers/modbus_marker.hpp"
#include "sim/markers/serial_marker.hpp"
#include "sim/simulated_rig.hpp"
#include "tests/drivers/transports/pseudo_terminal.hpp"

namespace footlight::contracts {
namespace {

using Bytes = std::vector<std::uint8_t>;

Rig rig_of(BusKind kind) {
  Rig rig;
  rig.buses.push_back({"b", kind, "sim://b", 115'200, std::nullopt, {}});
  for (const std::uint8_t address : {kFirstMarker, kSecondMarker}) {
    rig.nodes.push_back({"n" + std::to_string(address), BusIndex(0), address, std::vector<Channel>(kChannels), {}});
  }
  return rig;
}

template <class PortType>
class Simulated final : public PortBench<PortType> {
 public:
  Simulated(BusKind kind, PortType& (sim::SimulatedRig::*port_of)(BusIndex))
      : rig_(rig_of(kind), {}, 1, clock_, nullptr), port_((rig_.*port_of)(BusIndex(0))) {
    rig_.set_show(kStart, seconds(1000));
  }
  PortType& port() override { return port_; }
  void pass() override { rig_.advance_to(std::min(rig_.next_event(), clock_.now() + milliseconds(1))); }
  LookIndex shown(std::uint8_t address) override { return rig_.shown(NodeIndex::of(address - 1U), 0); }
  [[nodiscard]] bool real() const override { return false; }

 private:
  ManualClock clock_;
  sim::SimulatedRig rig_;
  PortType& port_;
};

/// Two nodes and a thread that answers for them.
class FarEnd {
 public:
  FarEnd() {
    for (auto& model : models_) model.power_on(kStart);
  }
  LookIndex shown(std::uint8_t address) {
    const std::lock_guard lock(mutex_);
    return models_.at(address - 1U).shown(0);
  }

 protected:
  ~FarEnd() { EXPECT_FALSE(thread_.joinable()); }
  void begin(std::function<void()> serve) {
    ending_ = false;
    thread_ = std::thread(std::move(serve));
  }
  void end() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// Waits for input; false when it is over.
  [[nodiscard]] bool readable(int file) const {
    while (!ending_) {
      pollfd wanted{file, POLLIN, 0};
      if (::poll(&wanted, 1, 10) > 0) return true;
    }
    return false;
  }

  std::array<sim::NodeModel, 2> models_{sim::NodeModel(kChannels, true), sim::NodeModel(kChannels, true)};
  std::mutex mutex_;
  SteadyClock clock_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// A port by a link that may lead to another terminal after the next plugging in, as /dev/serial/by-id does.
class PluggedTerminal {
 public:
  PluggedTerminal() : link_(::testing::TempDir() + "terminal-" + std::to_string(::getpid())) { plug(); }
  ~PluggedTerminal() { std::filesystem::remove(link_); }
  PluggedTerminal(const PluggedTerminal&) = delete;
  PluggedTerminal& operator=(const PluggedTerminal&) = delete;
  void plug() {
    terminal_ = std::make_unique<drivers::PseudoTerminal>();
    std::filesystem::remove(link_);
    std::filesystem::create_symlink(terminal_->path(), link_);
  }
  void unplug() {
    std::filesystem::remove(link_);
    terminal_.reset();
  }
  [[nodiscard]] const std::string& path() const { return link_; }
  [[nodiscard]] int near() const { return terminal_->near(); }

 private:
  std::string link_;
  std::unique_ptr<drivers::PseudoTerminal> terminal_;
};

Bytes read_some(int file) {
  Bytes bytes(512);
  const ssize_t count = ::read(file, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

void write_all(int file, const Bytes& bytes) {
  if (bytes.empty()) return;
  EXPECT_EQ(::write(file, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
}

/// A real port whose far end is a thread.
template <class PortType>
class RealPort : public PortBench<PortType>, protected FarEnd {
 public:
  PortType& port() override { return *port_; }
  void pass() override { std::this_thread::sleep_for(milliseconds(1)); }
  LookIndex shown(std::uint8_t address) override { return FarEnd::shown(address); }
  bool unplug() override {
    end();
    return true;
  }
  void replug() override { start(); }
  [[nodiscard]] bool real() const override { return true; }

 protected:
  virtual void start() = 0;

  std::unique_ptr<PortType> port_;
};

/// One on a pseudo-terminal.
template <class PortType>
class OnTerminal : public RealPort<PortType> {
 public:
  bool unplug() override {
    this->end();
    terminal_.unplug();
    return true;
  }
  void replug() override {
    terminal_.plug();
    this->start();
  }

 protected:
  PluggedTerminal terminal_;
};

class TerminalSerial final : public OnTerminal<drivers::ByteStream> {
 public:
  TerminalSerial() {
    port_ = drivers::open_serial(terminal_.path(), {}).value();
    TerminalSerial::start();
  }
  ~TerminalSerial() override { end(); }

 private:
  void start() override {
    begin([this] {
      while (readable(terminal_.near())) {
        const Bytes heard = read_some(terminal_.near());
        const std::lock_guard lock(mutex_);
        for (sim::SerialMarker& marker : markers_) write_all(terminal_.near(), marker.receive(heard, clock_.now()));
      }
    });
  }

  std::array<sim::SerialMarker, 2> markers_{sim::SerialMarker(kFirstMarker, models_[0]),
                                            sim::SerialMarker(kSecondMarker, models_[1])};
};

using ModbusMarkers = std::array<sim::ModbusMarker, 2>;

ModbusMarkers markers_of(std::array<sim::NodeModel, 2>& models) {
  return {sim::ModbusMarker(kFirstMarker, sim::footlight_profile(), models[0]),
          sim::ModbusMarker(kSecondMarker, sim::footlight_profile(), models[1])};
}

class TerminalRtu final : public OnTerminal<drivers::ModbusPort> {
 public:
  TerminalRtu() {
    port_ = drivers::open_modbus_rtu(terminal_.path(), {.characters = Characters::e1}).value();
    TerminalRtu::start();
  }
  ~TerminalRtu() override { end(); }

 private:
  void start() override {
    begin([this] {
      Bytes heard;
      while (readable(terminal_.near())) {
        const Bytes more = read_some(terminal_.near());
        heard.insert(heard.end(), more.begin(), more.end());
        // Writes of several registers say how long they are, all others have eight bytes.
        while (heard.size() >= 8) {
          const std::size_t length = heard[1] == 0x10 ? 9U + heard[6] : 8U;
          if (heard.size() < length) break;
          const std::span<const std::uint8_t> frame(heard.data(), length);
          const std::lock_guard lock(mutex_);
          for (sim::ModbusMarker& marker : markers_) {
            write_all(terminal_.near(), marker.receive_rtu(frame, clock_.now()));
          }
          heard.erase(heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(length));
        }
      }
    });
  }

  ModbusMarkers markers_ = markers_of(models_);
};

class LoopbackTcp final : public RealPort<drivers::ModbusPort> {
 public:
  LoopbackTcp() : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(::listen(listener_.get(), 8), 0);
    EXPECT_EQ(::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &length), 0);
    port_ = drivers::open_modbus_tcp("127.0.0.1", ntohs(address.sin_port), {kFirstMarker, kSecondMarker}).value();
    LoopbackTcp::start();
  }
  ~LoopbackTcp() override { end(); }

 private:
  void start() override {
    begin([this] {
      while (readable(listener_.get())) {
        const FileDescriptor connection(::accept(listener_.get(), nullptr, nullptr));
        serve(connection.get());
      }
    });
  }
  void serve(int connection) {
    Bytes heard;
    while (readable(connection)) {
      const Bytes more = read_some(connection);
      if (more.empty()) return;
      heard.insert(heard.end(), more.begin(), more.end());
      while (heard.size() >= 6) {
        const std::size_t length = 6U + static_cast<std::size_t>((heard[4] << 8U) | heard[5]);
        if (heard.size() < length) break;
        const std::span<const std::uint8_t> frame(heard.data(), length);
        const std::lock_guard lock(mutex_);
        for (sim::ModbusMarker& marker : markers_) write_all(connection, marker.receive_tcp(frame, clock_.now()));
        heard.erase(heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(length));
      }
    }
  }

  ModbusMarkers markers_ = markers_of(models_);
  FileDescriptor listener_;
};

}  // namespace

std::unique_ptr<SerialBench> simulated_serial() {
  return std::make_unique<Simulated<drivers::ByteStream>>(BusKind::serial, &sim::SimulatedRig::serial);
}
std::unique_ptr<SerialBench> pseudo_terminal_serial() { return std::make_unique<TerminalSerial>(); }
std::unique_ptr<ModbusBench> simulated_rtu() {
  return std::make_unique<Simulated<drivers::ModbusPort>>(BusKind::modbus_rtu, &sim::SimulatedRig::modbus);
}
std::unique_ptr<ModbusBench> simulated_tcp() {
  return std::make_unique<Simulated<drivers::ModbusPort>>(BusKind::modbus_tcp, &sim::SimulatedRig::modbus);
}
std::unique_ptr<ModbusBench> pseudo_terminal_rtu() { return std::make_unique<TerminalRtu>(); }
std::unique_ptr<ModbusBench> loopback_tcp() { return std::make_unique<LoopbackTcp>(); }

}  // namespace footlight::contracts
