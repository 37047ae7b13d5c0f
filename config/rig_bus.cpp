// SPDX-License-Identifier: Apache-2.0
#include "config/rig_bus.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "config/device_profile.hpp"
#include "config/nearest.hpp"
#include "config/rig_file.hpp"

namespace footlight::config {
namespace {

std::optional<BusKind> read_kind(MappingReader& reader, const std::optional<std::string>& url) {
  const auto choice = reader.choice("kind");
  const auto by_url = url ? kind_of_url(*url) : std::nullopt;
  if (url && !by_url) {
    reader.error("url", in_quotes(*url) + " is not the URL of a bus",
                 choice ? urls_of(static_cast<BusKind>(*choice)) : known_urls());
  }
  if (!choice) return by_url;
  const auto kind = static_cast<BusKind>(*choice);
  if (by_url && *by_url != kind) {
    reader.error("url",
                 in_quotes(*url) + " is the URL of a " + std::string(to_text(*by_url)) + " bus, and this one is " +
                     std::string(to_text(kind)),
                 urls_of(kind));
  }
  return kind;
}

void check_speed(MappingReader& reader, const Bus& bus) {
  const bool can = bus.kind == BusKind::can;
  const Range range = can ? Range{10'000, 1'000'000} : Range{1200, 4'000'000};
  if (range.contains(bus.bits_per_second)) return;
  reader.error("bits_per_second", in_quotes(std::to_string(bus.bits_per_second)) + " is out of range",
               std::string(to_text(bus.kind)) + ": " + to_text(range, "bit/s"));
}

void read_direction_line(MappingReader& reader, Bus& bus) {
  const bool by_gpio = bus.line.direction == LineDirection::gpio;
  if (!reader.has("direction_line")) {
    if (by_gpio) reader.error("direction", "no line is named", "direction_line: gpiochip0:17");
    return;
  }
  if (!by_gpio) {
    return reader.error(reader.key_position("direction_line"), reader.path("direction_line"),
                        "the key has no meaning here", "direction: gpio uses it");
  }
  const auto text = reader.text("direction_line");
  if (!text) return;
  const auto colon = text->rfind(':');
  const char* const end = text->data() + text->size();
  const char* const begin = colon == std::string::npos ? end : text->data() + colon + 1;
  const auto [stop, wrong] = std::from_chars(begin, end, bus.line.direction_offset);
  if (wrong != std::errc{} || stop != end || bus.line.direction_offset < 0 || colon == 0) {
    return reader.error("direction_line", in_quotes(*text) + " is no GPIO line", "chip and number, as gpiochip0:17");
  }
  bus.line.direction_chip = text->substr(0, colon);
}

void read_line(MappingReader& reader, Bus& bus) {
  if (bus.kind != BusKind::serial && bus.kind != BusKind::modbus_rtu) {
    for (const char* key : {"characters", "direction", "direction_line", "direction_inverted"}) {
      if (!reader.has(key)) continue;
      reader.error(reader.key_position(key), reader.path(key), "the key has no meaning here",
                   "only serial and modbus-rtu buses are lines");
    }
    return;
  }
  if (reader.has("characters")) {
    if (const auto choice = reader.choice("characters")) bus.line.characters = static_cast<Characters>(*choice);
  }
  bus.line.direction_inverted = reader.boolean("direction_inverted").value_or(false);
  const auto direction = reader.choice("direction");
  if (!direction) return;
  bus.line.direction = static_cast<LineDirection>(*direction);
  read_direction_line(reader, bus);
}

void read_bus_profile(MappingReader& reader, Bus& bus, const std::filesystem::path& folder,
                      std::vector<std::string>& files) {
  const bool modbus = bus.kind == BusKind::modbus_rtu || bus.kind == BusKind::modbus_tcp;
  if (bus.kind == BusKind::serial) {
    if (reader.has("profile")) {
      reader.error(reader.key_position("profile"), reader.path("profile"), "the key has no meaning here",
                   "only Modbus devices, DMX lamps and CANopen modules have a profile");
    }
    return;
  }
  if (!reader.has("profile") && bus.kind != BusKind::dmx) {
    if (modbus) bus.profile = footlight_marker_profile();
    return;
  }
  const auto name = reader.has("profile") ? reader.text("profile") : std::optional<std::string>("dmx-rgb");
  if (!name) return;
  const auto file = find_profile(*name, folder);
  if (!file) {
    reader.error("profile", "there is no device profile " + in_quotes(*name),
                 suggestion(*name, shipped_profiles(), "shipped profiles") + "; or a .yaml file beside the rig");
    return;
  }
  Diagnostics& diagnostics = reader.reading().diagnostics;
  if (modbus) {
    bus.profile = read_profile(*file, diagnostics, &bus.currents);
  } else if (bus.kind == BusKind::dmx) {
    bus.fixture = read_fixture(*file, diagnostics, &bus.currents);
  } else {
    bus.outputs = read_output_module(*file, diagnostics, &bus.currents);
  }
  if (std::find(files.begin(), files.end(), file->string()) == files.end()) files.push_back(file->string());
}

}  // namespace

Bus read_bus_keys(MappingReader& reader, const std::filesystem::path& folder, std::vector<std::string>& files) {
  Bus bus;
  bus.position = reader.position();
  const auto url = reader.text("url");
  const auto kind = read_kind(reader, url);
  const bool known = reader.has("kind") || kind;
  const auto speed = reader.integer("bits_per_second");
  bus.name = reader.text("name").value_or("");
  if (kind) bus.kind = *kind;
  if (url) bus.url = *url;
  bus.bits_per_second = speed.value_or(bus.kind == BusKind::can ? 500'000 : 115'200);
  if (kind && speed) check_speed(reader, bus);
  if (known) read_bus_profile(reader, bus, folder, files);
  if (known) read_line(reader, bus);
  return bus;
}

}  // namespace footlight::config
