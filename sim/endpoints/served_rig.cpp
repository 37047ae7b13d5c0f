// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/served_rig.hpp"

#include <algorithm>
#include <ctime>
#include <system_error>
#include <utility>

#include "sim/endpoints/can_endpoint.hpp"
#include "sim/endpoints/serial_endpoints.hpp"
#include "sim/endpoints/tcp_endpoint.hpp"

namespace footlight::sim {
namespace {

/// The name of a bus as that of a file.
std::string file_name(const std::string& bus) {
  std::string name = bus;
  std::ranges::replace(name, '/', '_');
  return name.starts_with('.') ? "_" + name : name;
}

template <class Kind, class Bus, class... More>
Result<std::unique_ptr<Endpoint>> on_terminal(const std::filesystem::path& link, Bus& bus, More... more) {
  auto terminal = PseudoTerminal::open(link);
  if (!terminal) return std::move(terminal).error();
  return std::unique_ptr<Endpoint>(std::make_unique<Kind>(std::move(terminal).value(), bus, more...));
}

template <class Kind>
Result<std::unique_ptr<Endpoint>> as_endpoint(Result<std::unique_ptr<Kind>> opened) {
  if (!opened) return std::move(opened).error();
  return std::unique_ptr<Endpoint>(std::move(opened).value());
}

}  // namespace

ServedRig::ServedRig(const Rig& rig, const Serving& serving, const Clock& clock, std::ostream* trace)
    : clock_(clock),
      show_length_(serving.show_length),
      simulated_(std::make_unique<SimulatedRig>(rig, serving.faults, serving.seed, world_time_, trace)) {}

Result<std::unique_ptr<ServedRig>> ServedRig::open(const Rig& rig, const Serving& serving, const Clock& clock,
                                                   std::ostream* trace) {
  std::unique_ptr<ServedRig> served(new ServedRig(rig, serving, clock, trace));
  if (auto done = served->serve(rig, serving); !done) return done.error();
  return served;
}

Status<> ServedRig::serve(const Rig& rig, const Serving& serving) {
  std::error_code error;
  std::filesystem::create_directories(serving.folder, error);
  if (error) {
    return input_error("folder \"" + serving.folder.string() + "\": " + error.message() +
                       " (--dir names one that can be made)");
  }
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    const Bus& bus = rig.buses[b];
    if (bus.kind == BusKind::can && !serving.can.contains(bus.name)) {
      left_out_.push_back(bus.name);
      continue;
    }
    auto endpoint = endpoint_for(rig, BusIndex::of(b), serving);
    if (!endpoint) {
      return Error{endpoint.error().kind, "bus \"" + bus.name + "\": " + endpoint.error().message};
    }
    served_.push_back({bus.name, (*endpoint)->url()});
    endpoints_.push_back(std::move(endpoint).value());
  }
  return Done{};
}

Result<std::unique_ptr<Endpoint>> ServedRig::endpoint_for(const Rig& rig, BusIndex bus, const Serving& serving) {
  const Bus& wire = rig.buses[bus.at()];
  const auto link = serving.folder / file_name(wire.name);
  switch (wire.kind) {
    case BusKind::serial:
      return on_terminal<SerialEndpoint>(link, simulated_->serial(bus));
    case BusKind::dmx:
      return on_terminal<SerialEndpoint>(link, simulated_->serial(bus), "dmx");
    case BusKind::modbus_rtu:
      return on_terminal<RtuEndpoint>(link, simulated_->modbus_line(bus));
    case BusKind::modbus_tcp: {
      const int port = serving.first_port == 0 ? 0 : serving.first_port + ports_++;
      return as_endpoint(TcpEndpoint::open(port, simulated_->modbus_line(bus)));
    }
    case BusKind::can:
      break;
  }
  return as_endpoint(CanEndpoint::open(serving.can.at(wire.name), simulated_->can(bus)));
}

void ServedRig::step(Duration most, const std::function<void(Instant)>& seen) {
  const Instant now = clock_.now();
  wait(std::min({now + most, wish_, simulated_->next_event()}));
  catch_up(seen);
  if (!begun_ && std::ranges::any_of(endpoints_, [](const auto& endpoint) { return endpoint->used(); })) {
    begun_ = true;
    simulated_->set_show(world_time_.now(), show_length_);
  }
}

void ServedRig::catch_up(const std::function<void(Instant)>& seen) {
  const Instant now = std::max(clock_.now(), world_time_.now());
  // One instant after the other: an answer that is due goes out before the next thing happens.
  while (true) {
    simulated_->advance_to(std::min(now, std::max(simulated_->next_event(), world_time_.now())));
    wish_ = kNever;
    for (auto& endpoint : endpoints_) wish_ = std::min(wish_, endpoint->step(world_time_.now()));
    seen(world_time_.now());
    if (world_time_.now() == now && simulated_->next_event() > now) return;
  }
}

void ServedRig::wait(Instant until) {
  files_.clear();
  for (const auto& endpoint : endpoints_) endpoint->add_handles(files_);
  const Duration left = std::max(Duration{}, until - clock_.now());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
  (void)::ppoll(files_.data(), files_.size(), &timeout, nullptr);  // interrupted: the caller looks at its flag
}

}  // namespace footlight::sim
