// SPDX-License-Identifier: Apache-2.0
#include "app/device_bus.hpp"

#include <algorithm>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "app/load.hpp"
#include "app/simulated_buses.hpp"
#include "app/wire_check.hpp"
#include "app/wire_log/wire_recorder.hpp"
#include "config/device_profile.hpp"
#include "config/nearest.hpp"
#include "config/rig_file.hpp"
#include "config/transport_map.hpp"

namespace footlight::app {
namespace {

constexpr Duration kPollReal = milliseconds(1);
constexpr const char* kLogEnding = ".pcapng";
constexpr std::uint8_t kPlanByte = 0;  // no show is on the bus

bool is_url(const std::string& text) { return text.find("://") != std::string::npos; }

Result<Bus> bus_of_url(const DeviceBusChoice& choice) {
  const auto kind = config::kind_of_url(choice.bus);
  if (!kind) {
    return input_error(config::in_quotes(choice.bus) + " is not the URL of a bus (" + config::known_urls() + ")");
  }
  Bus bus;
  bus.name = choice.bus;
  bus.kind = *kind;
  bus.url = choice.bus;
  bus.bits_per_second = *kind == BusKind::can ? 500'000 : 115'200;
  if (choice.bits_per_second > 0) bus.bits_per_second = choice.bits_per_second;
  if (*kind == BusKind::dmx && choice.profile.empty()) return bus;
  if (*kind == BusKind::dmx) {
    const auto file = config::find_profile(choice.profile, std::filesystem::current_path());
    Diagnostics diagnostics;
    if (file) bus.fixture = config::read_fixture(*file, diagnostics);
    if (!bus.fixture)
      return input_error(file ? diagnostics.to_text()
                              : "there is no device profile " + config::in_quotes(choice.profile));
    return bus;
  }
  if (*kind == BusKind::can && !choice.profile.empty()) {
    const auto file = config::find_profile(choice.profile, std::filesystem::current_path());
    Diagnostics diagnostics;
    if (file) bus.outputs = config::read_output_module(*file, diagnostics);
    if (!bus.outputs)
      return input_error(file ? diagnostics.to_text()
                              : "there is no device profile " + config::in_quotes(choice.profile));
    return bus;
  }
  if (*kind != BusKind::modbus_rtu && *kind != BusKind::modbus_tcp) return bus;
  if (choice.profile.empty()) {
    bus.profile = footlight_marker_profile();
    return bus;
  }
  const auto file = config::find_profile(choice.profile, std::filesystem::current_path());
  if (!file) {
    return input_error("there is no device profile " + config::in_quotes(choice.profile) + " (" +
                       config::suggestion(choice.profile, config::shipped_profiles(), "shipped profiles") +
                       "; or a .yaml file)");
  }
  Diagnostics diagnostics;
  bus.profile = config::read_profile(*file, diagnostics);
  if (diagnostics.has_errors()) {
    std::string text = diagnostics.to_text();
    text.pop_back();
    return input_error(text);
  }
  return bus;
}

Status<> take_transports_of(const DeviceBusChoice& choice, Rig& rig) {
  if (choice.transports.empty()) return Done{};
  if (const auto taken = config::take_transports(choice.transports, rig); !taken) {
    std::string text = taken.error().to_text();
    text.pop_back();
    return input_error(text);
  }
  return Done{};
}

Result<BusIndex> bus_named(const Rig& rig, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    if (rig.buses[b].name == name) return BusIndex::of(b);
    names.push_back(rig.buses[b].name);
  }
  return input_error("no bus has the name " + config::in_quotes(name) + " (" +
                     config::suggestion(name, names, "buses") + "; or a URL, as rtu:///dev/serial/by-id/...)");
}

}  // namespace

Result<Rig> read_rig_of(Session& session, const std::string& show) {
  auto loaded = read_show(session, show);
  if (!loaded) return std::move(loaded).error();
  return std::move(loaded->rig);
}

Result<std::unique_ptr<DeviceBus>> DeviceBus::open(Session& session, const DeviceBusChoice& choice) {
  auto made = std::make_unique<DeviceBus>();
  if (is_url(choice.bus)) {
    auto bus = bus_of_url(choice);
    if (!bus) return std::move(bus).error();
    if (choice.simulated || bus->simulated()) {
      return input_error("a simulated bus has the nodes of a rig (give the bus's name and --show SHOW)");
    }
    made->rig_.buses.push_back(std::move(bus).value());
    made->index_ = BusIndex(0);
  } else {
    if (choice.rig != nullptr) {
      made->rig_ = *choice.rig;
    } else {
      auto rig = read_rig_of(session, choice.show.empty() ? "show.yaml" : choice.show);
      if (!rig) return std::move(rig).error();
      made->rig_ = std::move(rig).value();
      if (auto taken = take_transports_of(choice, made->rig_); !taken) return taken.error();
    }
    const auto index = bus_named(made->rig_, choice.bus);
    if (!index) return index.error();
    made->index_ = *index;
  }
  if (!choice.simulated) {
    if (auto wire = check_wires(session, {made->bus()}); !wire) return std::move(wire).error();
  }
  if (auto connected = made->connect(choice); !connected) return std::move(connected).error();
  return made;
}

Status<> DeviceBus::connect(const DeviceBusChoice& choice) {
  nodes_ = drivers::node_addresses(rig_, index_);
  std::ranges::stable_sort(nodes_, {},
                           [&](const drivers::NodeAddress& node) { return rig_.nodes[node.node.at()].position.line; });
  drivers::PortReference reference;
  if (choice.simulated || bus().simulated()) {
    sim::Faults faults;
    if (!choice.faults.empty()) {
      auto parsed = sim::Faults::parse(choice.faults);
      if (!parsed) return parsed.error();
      faults = *parsed;
    }
    rig_ = with_simulated_buses(std::move(rig_));
    simulated_ = std::make_unique<sim::SimulatedRig>(rig_, faults, choice.seed, virtual_time_, nullptr);
    reference = port_of(*simulated_, rig_, index_);
  } else {
    auto port = drivers::open_port(bus(), nodes_);
    if (!port) return std::move(port).error();
    port_ = std::move(port).value();
    reference = drivers::reference(port_);
  }
  if (!choice.wire_log.empty()) {
    if (auto started = start_log(choice.wire_log); !started) return started;
    reference = logged_.emplace(*log_).before(index_.at(), bus().kind, reference);
  }
  auto driver = drivers::make_driver(bus(), nodes_, kPlanByte, reference);
  if (!driver) return std::move(driver).error();
  driver_ = std::move(driver).value();
  return Done{};
}

Status<> DeviceBus::start_log(const std::string& file) {
  if (!file.ends_with(kLogEnding)) {  // a show file that is named by mistake stays
    return input_error("--wire-log " + config::in_quotes(file) + ": not the name of such a file (as wires" +
                       kLogEnding + ")");
  }
  if (auto opened = log_file_.emplace("wire log", file).open(); !opened) return opened;
  if (simulated_) {
    log_ = std::make_unique<DirectWireLog>(log_file_->stream(), rig_, virtual_time_);
    return Done{};
  }
  auto recorder = WireRecorder::open(rig_, {{}, &log_file_->stream()}, real_time_);
  if (!recorder) return recorder.error();
  log_ = std::move(recorder).value();
  return Done{};
}

Status<> DeviceBus::keep_log() {
  if (!log_file_) return Done{};
  if (auto* recorder = dynamic_cast<WireRecorder*>(log_.get())) recorder->close();
  return log_file_->keep();
}

const Clock& DeviceBus::clock() const {
  if (simulated_) return virtual_time_;
  return real_time_;
}

std::string DeviceBus::name_of(std::uint16_t address) const {
  for (const drivers::NodeAddress& node : nodes_) {
    if (node.address == address) return rig_.nodes[node.node.at()].name;
  }
  return fmt::format("address {}", address);
}

std::uint16_t DeviceBus::last_address() const { return static_cast<std::uint16_t>(config::last_address(bus().kind)); }

Status<> DeviceBus::run(Session& session, controller::BusService& service, const std::string& what) {
  while (!service.finished()) {
    if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted"};
    const Instant now = clock().now();
    const Instant wish = service.step(now);
    if (service.finished()) break;
    session.tell(what, service.progress());
    if (simulated_) {
      const Instant next = std::min(wish, simulated_->next_event());
      simulated_->advance_to(next == kNever ? now + kPollReal : std::max(next, now));
    } else {
      std::this_thread::sleep_for(std::clamp(wish - now, Duration{}, kPollReal));
    }
  }
  session.clear_line();
  if (auto kept = keep_log(); !kept) return kept;
  if (service.failure()) {
    const std::string trouble = simulated_ ? "" : drivers::trouble_of(drivers::reference(port_));
    if (!trouble.empty()) return Error{service.failure()->kind, "bus \"" + bus().name + "\": " + trouble};
    return Error{service.failure()->kind, "bus \"" + bus().name + "\": " + service.failure()->message};
  }
  return Done{};
}

}  // namespace footlight::app
