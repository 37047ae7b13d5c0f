// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "config/rig_file.hpp"

namespace footlight::config {
namespace {

struct Scheme {
  std::string_view prefix;
  BusKind kind;
  std::string_view example;  ///< of the simulated ones: the real one
};
// The longer of two prefixes of one beginning stands first.
constexpr std::array kSchemes{
    Scheme{"sim://serial", BusKind::serial, "serial:///dev/serial/by-id/..."},
    Scheme{"sim://rtu", BusKind::modbus_rtu, "rtu:///dev/serial/by-id/..."},
    Scheme{"sim://tcp", BusKind::modbus_tcp, "tcp://host:502"},
    Scheme{"sim://can", BusKind::can, "can://can0"},
    Scheme{"sim://dmx", BusKind::dmx, "dmx:///dev/serial/by-id/..."},
    Scheme{"serial://", BusKind::serial, ""},
    Scheme{"rtu://", BusKind::modbus_rtu, ""},
    Scheme{"tcp://", BusKind::modbus_tcp, ""},
    Scheme{"can://", BusKind::can, ""},
    Scheme{"dmx://", BusKind::dmx, ""},
};

}  // namespace

std::optional<BusKind> kind_of_url(std::string_view url) {
  for (const Scheme& scheme : kSchemes) {
    const bool simulated = !scheme.example.empty();
    const bool begins = url.substr(0, scheme.prefix.size()) == scheme.prefix;
    if (begins && (simulated ? url.size() == scheme.prefix.size() : url.size() > scheme.prefix.size())) {
      return scheme.kind;
    }
  }
  return std::nullopt;
}

std::string example_url(BusKind kind) {
  for (const Scheme& scheme : kSchemes) {
    if (scheme.kind == kind) return std::string(scheme.example);
  }
  return {};
}

std::string urls_of(BusKind kind) {
  for (const Scheme& scheme : kSchemes) {
    if (scheme.kind == kind) return std::string(scheme.example) + " or " + std::string(scheme.prefix);
  }
  return {};
}

std::string known_urls() {
  return "serial:///dev/..., rtu:///dev/..., tcp://host:502, can://can0, dmx:///dev/..., sim://serial, sim://rtu, "
         "sim://tcp, sim://can, sim://dmx";
}

}  // namespace footlight::config
