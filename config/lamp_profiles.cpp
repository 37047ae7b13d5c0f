// SPDX-License-Identifier: Apache-2.0
// Profiles of devices without registers: lamps on a DMX line, output modules on a CANopen bus.
#include <algorithm>
#include <string>

#include "config/device_profile.hpp"
#include "config/nearest.hpp"
#include "config/profile_file.hpp"

namespace footlight::config {
namespace {

DmxFixture fixture_in(MappingReader& root) {
  constexpr std::size_t kMostSlots = 32;
  DmxFixture fixture;
  (void)root.integer("profile");
  fixture.name = root.text("name").value_or("");
  if (!is_profile_of(root, DeviceKind::dmx)) return fixture;
  const auto& known = profile_listing().find("lamp_slots")->choices;
  for (const Written& written : root.list("lamp_slots")) {
    const auto at = std::find(known.begin(), known.end(), written.text);
    if (at == known.end()) {
      root.error(written, in_quotes(written.text) + " is no kind of slot",
                 suggestion(written.text, {known.begin(), known.end()}, "kinds"));
    } else {
      fixture.slots.push_back(static_cast<DmxSlot>(at - known.begin()));
    }
  }
  if (fixture.slots.empty() || fixture.slots.size() > kMostSlots) {
    root.error("lamp_slots", "a lamp has " + std::to_string(fixture.slots.size()) + " slots",
               "1 to " + std::to_string(kMostSlots));
  }
  return fixture;
}

/// Written by the controller by itself, for every module (docs/wire-protocol.md, section 3).
bool is_ours(int index) {
  return index == 0x1016 || index == 0x1017 || (index >= 0x1400 && index < 0x1800) || index == 0x6200 ||
         index == 0x6206 || index == 0x6207;
}

OutputModule outputs_in(MappingReader& root) {
  OutputModule module;
  (void)root.integer("profile");
  module.name = root.text("name").value_or("");
  if (!is_profile_of(root, DeviceKind::outputs)) return module;
  module.outputs = root.integer("outputs").value_or(1);
  module.on_failure = static_cast<OutputModule::OnFailure>(root.choice("on_failure").value_or(0));
  module.heartbeat = seconds(root.quantity("heartbeat").value_or(1));
  module.silence = seconds(root.quantity("silence").value_or(1));
  const auto number = [&](std::string_view key) -> std::optional<std::uint32_t> {
    const auto value = root.integer(key);
    return value ? std::optional(static_cast<std::uint32_t>(*value)) : std::nullopt;
  };
  module.vendor = number("vendor");
  module.product = number("product");
  for (MappingReader& entry : root.mappings("objects")) {
    const auto index = entry.integer("index");
    const auto value = entry.integer("value");
    const auto bits = entry.choice("bits");
    const auto sub = entry.integer("sub");
    if (!index || !value || !bits || !sub) continue;
    const int bytes = 1 << *bits;
    if (is_ours(*index)) {
      entry.error("index", "the controller writes this object by itself", "leave it out");
    } else if (bytes < 4 && *value >= 1 << (8 * bytes)) {
      entry.error("value", std::to_string(*value) + " does not fit into " + std::to_string(8 * bytes) + " bits",
                  "at most " + std::to_string((1 << (8 * bytes)) - 1));
    }
    module.objects.push_back({*index, *sub, bytes, static_cast<std::uint32_t>(*value)});
  }
  return module;
}

}  // namespace

std::optional<DmxFixture> read_fixture(const std::filesystem::path& file, Diagnostics& diagnostics,
                                       std::optional<LampCurrents>* currents) {
  return read_profile_file<DmxFixture>(file, diagnostics, currents, fixture_in);
}

std::optional<OutputModule> read_output_module(const std::filesystem::path& file, Diagnostics& diagnostics,
                                               std::optional<LampCurrents>* currents) {
  return read_profile_file<OutputModule>(file, diagnostics, currents, outputs_in);
}

}  // namespace footlight::config
