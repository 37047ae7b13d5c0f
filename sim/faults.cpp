// SPDX-License-Identifier: Apache-2.0
#include "sim/faults.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace footlight::sim {
namespace {

constexpr int kMostNodes = 10'000;

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

bool strip(std::string_view& text, std::string_view suffix) {
  if (!text.ends_with(suffix)) return false;
  text.remove_suffix(suffix.size());
  return true;
}

std::optional<double> share(std::string_view text) {
  const double unit = strip(text, "%") ? 0.01 : 1.0;
  const auto value = number(text);
  if (!value) return {};
  return *value * unit;
}

std::optional<Duration> time(std::string_view text) {
  double unit_s = 0;
  if (strip(text, "us")) {
    unit_s = 1e-6;
  } else if (strip(text, "ms")) {
    unit_s = 1e-3;
  } else if (strip(text, "s")) {
    unit_s = 1;
  } else {
    return {};
  }
  const auto value = number(text);
  if (!value || std::abs(*value * unit_s) > 1e6) return {};
  return seconds(*value * unit_s);
}

Error wrong(std::string_view part, std::string_view right) {
  return input_error("faults: \"" + std::string(part) + "\" is wrong (" + std::string(right) + ")");
}

Status<> set_share(std::string_view part, std::string_view value, double most, std::string_view right, double& target) {
  const auto parsed = share(value);
  if (!parsed || *parsed < 0 || *parsed > most + 1e-12) return wrong(part, right);
  target = *parsed;
  return Done{};
}

Status<> set_count(std::string_view part, std::string_view value, std::string_view right, int& target) {
  int parsed = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
  if (error != std::errc{} || end != value.data() + value.size() || parsed < 0 || parsed > kMostNodes) {
    return wrong(part, right);
  }
  target = parsed;
  return Done{};
}

Status<> set(Faults& faults, std::string_view part, std::string_view key, std::string_view value) {
  if (key == "loss") return set_share(part, value, 0.3, "a share of 0 to 30%, as loss=5%", faults.loss);
  if (key == "corrupt") return set_share(part, value, 0.3, "a share of 0 to 30%, as corrupt=1%", faults.corrupt);
  if (key == "duplicate") return set_share(part, value, 0.5, "a share of 0 to 50%, as duplicate=1%", faults.duplicate);
  if (key == "late") return set_share(part, value, 1, "a share of 0 to 100%, as late=10%", faults.late);
  if (key == "until") return set_share(part, value, 1, "a share of 0 to 100%, as until=80%", faults.until);
  if (key == "reboot") return set_count(part, value, "a number of restarts, 0 to 10000, as reboot=2", faults.reboot);
  if (key == "dead") return set_count(part, value, "a number of nodes, 0 to 10000, as dead=1", faults.dead);
  if (key == "bus-off") return set_count(part, value, "a number of times, 0 to 10000, as bus-off=2", faults.bus_off);
  if (key == "full") return set_count(part, value, "a number of times, 0 to 10000, as full=2", faults.full);
  if (key == "unplug") return set_count(part, value, "a number of times, 0 to 10000, as unplug=2", faults.unplug);
  if (key == "delay") {
    const auto parsed = time(value);
    if (!parsed || *parsed < Duration{} || *parsed > std::chrono::seconds(1)) {
      return wrong(part, "a time of 0 to 1 s with its unit us, ms or s, as delay=3ms");
    }
    faults.delay = *parsed;
    return Done{};
  }
  return input_error("faults: \"" + std::string(part) +
                     "\" is unknown (possible are loss=5%, corrupt=1%, duplicate=1%, delay=3ms, late=10%, "
                     "reboot=2, bus-off=2, full=2, unplug=1, dead=1, until=80%, separated by commas)");
}

}  // namespace

Result<Faults> Faults::parse(std::string_view text) {
  Faults faults;
  std::vector<std::string_view> seen;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view part = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    const std::size_t equals = part.find('=');
    const std::string_view key = part.substr(0, equals);
    for (const std::string_view other : seen) {
      if (other == key) return wrong(part, std::string(key) + " is given twice; once is right");
    }
    seen.push_back(key);
    const std::string_view value = equals == std::string_view::npos ? std::string_view{} : part.substr(equals + 1);
    if (auto done = set(faults, part, key, value); !done) return done.error();
  }
  return faults;
}

}  // namespace footlight::sim
