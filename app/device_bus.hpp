// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/growing_file.hpp"
#include "app/session.hpp"
#include "app/wire_log/logged_ports.hpp"
#include "app/wire_log/wire_log.hpp"
#include "controller/bus_service.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/registry.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::app {

/// Which bus a technician means.
struct DeviceBusChoice {
  std::string bus;           ///< its name in the rig of `show`, or a URL
  const Rig* rig = nullptr;  ///< read already, with its real URLs: instead of `show` and `transports`; borrowed
  std::string show;          ///< show file; empty: show.yaml in this folder, where the bus is no URL
  std::string transports;    ///< transport map: where the rig's buses are today; empty: where the rig says
  std::string profile;       ///< of a URL's Modbus devices; empty: our own marker
  int bits_per_second = 0;   ///< of a URL; 0: as rigs have it
  bool simulated = false;    ///< the rig's nodes in virtual time, whatever its URLs
  std::string faults;        ///< of the simulated ones
  std::uint64_t seed = 1;
  std::string wire_log;  ///< pcapng file of what goes over the wire; empty: none
};

/// The rig that a show names. Errors: whatever the files have wrong.
[[nodiscard]] Result<Rig> read_rig_of(Session& session, const std::string& show);

/// One bus with its driver, real or simulated, for a technician's work.
class DeviceBus {
 public:
  [[nodiscard]] static Result<std::unique_ptr<DeviceBus>> open(Session& session, const DeviceBusChoice& choice);

  [[nodiscard]] const Bus& bus() const { return rig_.buses[index_.at()]; }
  [[nodiscard]] const Rig& rig() const { return rig_; }
  [[nodiscard]] drivers::Driver& driver() { return *driver_; }
  /// In the order of the rig file, which is that of the cable.
  [[nodiscard]] const std::vector<drivers::NodeAddress>& nodes() const { return nodes_; }
  [[nodiscard]] const Clock& clock() const;
  /// "can-1-7", or the address where the rig has no such node.
  [[nodiscard]] std::string name_of(std::uint16_t address) const;
  [[nodiscard]] std::uint16_t last_address() const;
  /// Steps the service until it has finished. Errors: its failure; interrupted.
  [[nodiscard]] Status<> run(Session& session, controller::BusService& service, const std::string& what);

 private:
  Status<> connect(const DeviceBusChoice& choice);
  Status<> start_log(const std::string& file);
  Status<> keep_log();

  Rig rig_;
  BusIndex index_;
  ManualClock virtual_time_;
  SteadyClock real_time_;
  std::unique_ptr<sim::SimulatedRig> simulated_;
  drivers::Port port_;
  std::vector<drivers::NodeAddress> nodes_;
  std::optional<GrowingFile> log_file_;
  std::unique_ptr<WireLog> log_;
  std::optional<LoggedPorts> logged_;
  std::unique_ptr<drivers::Driver> driver_;
};

}  // namespace footlight::app
