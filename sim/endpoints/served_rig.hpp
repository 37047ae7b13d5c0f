// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "sim/endpoints/endpoint.hpp"
#include "sim/simulated_rig.hpp"

namespace footlight::sim {

/// Where the buses of a rig are served.
struct Serving {
  std::filesystem::path folder;            ///< of the links to the pseudo-terminals; made when it is not there
  int first_port = 0;                      ///< of the Modbus TCP buses, one each in the order of the rig; 0: any free
  std::map<std::string, std::string> can;  ///< SocketCAN interface by name of the bus; other CAN buses are not served
  Faults faults;
  std::uint64_t seed = 1;
  Duration show_length{};  ///< restarts are drawn within it, from the first byte that anybody says
};

/// The simulated markers of a rig in real time, on endpoints that other programs open: what they say goes over the
/// simulated wire, in the time that it takes there and with its faults, to the markers, and the answers likewise.
/// Used by one thread.
class ServedRig {
 public:
  struct Served {
    std::string bus;
    std::string url;
  };

  /// @param clock real time; borrowed, as is `trace`
  /// Errors: what the machine refuses, in the words of the endpoint.
  static Result<std::unique_ptr<ServedRig>> open(const Rig& rig, const Serving& serving, const Clock& clock,
                                                 std::ostream* trace);

  /// Waits until something arrives or is due, `most` at the longest, and lets it happen. `seen` is called with the time
  /// after everything that happens at one instant, when the lamps may have changed.
  void step(Duration most, const std::function<void(Instant)>& seen);

  [[nodiscard]] const std::vector<Served>& served() const { return served_; }
  /// CAN buses for which no interface was named.
  [[nodiscard]] const std::vector<std::string>& left_out() const { return left_out_; }
  [[nodiscard]] const SimulatedRig& rig() const { return *simulated_; }
  [[nodiscard]] Instant now() const { return world_time_.now(); }

 private:
  ServedRig(const Rig& rig, const Serving& serving, const Clock& clock, std::ostream* trace);
  Status<> serve(const Rig& rig, const Serving& serving);
  Result<std::unique_ptr<Endpoint>> endpoint_for(const Rig& rig, BusIndex bus, const Serving& serving);
  void catch_up(const std::function<void(Instant)>& seen);
  void wait(Instant until);

  const Clock& clock_;
  ManualClock world_time_;
  Duration show_length_;
  std::unique_ptr<SimulatedRig> simulated_;
  std::vector<std::unique_ptr<Endpoint>> endpoints_;
  std::vector<Served> served_;
  std::vector<std::string> left_out_;
  std::vector<pollfd> files_;
  Instant wish_ = kStart;
  int ports_ = 0;
  bool begun_ = false;
};

}  // namespace footlight::sim
