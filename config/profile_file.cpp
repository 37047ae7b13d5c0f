// SPDX-License-Identifier: Apache-2.0
#include "config/profile_file.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace footlight::config {
namespace {

struct Kind {
  std::string_view is;
  std::string_view has;                ///< what it is known by
  std::vector<std::string_view> keys;  ///< that no other kind has, the one that it is known by first
};

const Kind& kind_of(DeviceKind kind) {
  static const std::array<Kind, 3> kKinds{
      Kind{"a Modbus device", "a Modbus device has look_register or look_coil", {}},
      Kind{"a DMX lamp", "a DMX lamp has a name and lamp_slots", {"lamp_slots"}},
      Kind{"a CANopen module",
           "a CANopen module has outputs",
           {"outputs", "on_failure", "heartbeat", "silence", "vendor", "product", "objects"}}};
  return kKinds.at(static_cast<std::size_t>(kind));
}

bool has_key(const Kind& kind, std::string_view key) {
  return std::find(kind.keys.begin(), kind.keys.end(), key) != kind.keys.end();
}

/// A Modbus device has all keys that are of no other kind.
bool belongs(std::string_view key, DeviceKind kind) {
  if (key == "profile" || key == "name" || key == "currents") return true;
  if (kind != DeviceKind::modbus) return has_key(kind_of(kind), key);
  return !has_key(kind_of(DeviceKind::dmx), key) && !has_key(kind_of(DeviceKind::outputs), key);
}

}  // namespace

bool is_profile_of(MappingReader& root, DeviceKind wanted) {
  const auto found = root.has("lamp_slots") ? DeviceKind::dmx
                     : root.has("outputs")  ? DeviceKind::outputs
                                            : DeviceKind::modbus;
  const std::string hint(kind_of(wanted).has);
  if (found != wanted) {
    const std::string_view key = kind_of(found == DeviceKind::modbus ? wanted : found).keys.front();
    root.error(root.has(key) ? root.key_position(key) : root.position(), std::string(key),
               "this is the profile of " + std::string(kind_of(found).is), hint);
    return false;
  }
  for (const Field& field : profile_listing().fields) {
    if (!root.has(field.key) || belongs(field.key, wanted)) continue;
    root.error(root.key_position(field.key), root.path(field.key), "the key has no meaning here", hint);
  }
  return true;
}

}  // namespace footlight::config
