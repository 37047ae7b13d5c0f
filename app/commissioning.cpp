// SPDX-License-Identifier: Apache-2.0
#include "app/commissioning.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "app/load.hpp"
#include "app/output_place.hpp"
#include "config/output_file.hpp"
#include "config/rig_file.hpp"
#include "config/rig_writer.hpp"
#include "config/transport_map.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostLamps = 65'536;

Status<> may_write(const std::string& output) {
  if (output.empty()) return Done{};
  const std::filesystem::path file(output);
  if (file.extension() != ".yaml" && file.extension() != ".yml") {
    return input_error(fmt::format("-o '{}': a rig file ends in .yaml", output));
  }
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    return input_error(fmt::format("-o '{}' is there already (another name: no rig is ever overwritten)", output));
  }
  return can_write(file);
}

}  // namespace

Result<FloorToCommission> read_floor(Session& session, const CommissionChoice& choice) {
  if (auto may = may_write(choice.output); !may) return std::move(may).error();
  auto loaded = read_show(session, choice.show);
  if (!loaded) return std::move(loaded).error();
  FloorToCommission out{std::move(loaded).value(), {}};
  out.lamps = lamps_of(out.loaded.rig);
  if (out.lamps.empty()) return input_error("the rig has no lamps on the floor");
  if (out.lamps.size() > kMostLamps) {
    return input_error(
        fmt::format("the rig has {} lamps on the floor (at most {} are told apart; commission a part of "
                    "it at a time)",
                    out.lamps.size(), kMostLamps));
  }
  return out;
}

Result<std::unique_ptr<FloorLights>> light_floor(Session& session, const CommissionChoice& choice, const Rig& rig) {
  Rig wires = rig;
  FloorLights::Choice how;
  how.simulated = choice.simulated;
  how.seed = choice.seed;
  if (!choice.faults.empty()) {
    if (!choice.simulated) return input_error("--faults: only simulated nodes have faults by name (with --sim)");
    auto faults = sim::Faults::parse(choice.faults);
    if (!faults) return faults.error();
    how.faults = *faults;
  }
  if (!choice.transports.empty()) {
    if (auto taken = config::take_transports(choice.transports, wires); !taken) {
      return input_error(taken.error().to_text());
    }
  }
  std::string without;
  for (const Bus& bus : wires.buses) {
    if (bus.simulated() && !choice.simulated) without += (without.empty() ? "" : ", ") + bus.name;
  }
  if (!without.empty()) {
    return input_error("no wire for these buses: " + without +
                       " (a real URL in the rig or in --transport-map; --sim tries it on simulated lamps)");
  }
  auto lights = FloorLights::open(wires, how, session.stop());
  if (lights) session.note(choice.simulated ? "the lamps are simulated" : "the buses are open");
  return lights;
}

Status<> write_rig(const FloorToCommission& floor, const std::vector<std::optional<CellIndex>>& seen,
                   const std::string& output) {
  const Rig rig = with_places(floor.loaded.rig, floor.lamps, seen);
  const auto text = config::rig_text(rig, floor.loaded.show, output);
  if (!text) return text.error();
  if (auto written = config::write_file(output, *text); !written) return written;
  Diagnostics diagnostics;
  std::vector<std::string> files;
  const Rig again = config::read_rig(output, floor.loaded.show, true, diagnostics, files);
  if (!diagnostics.has_errors() && places_digest(again) == places_digest(rig)) return Done{};
  return internal_error(fmt::format("'{}' does not read as it was written: {}", output, diagnostics.to_text()));
}

}  // namespace footlight::app
