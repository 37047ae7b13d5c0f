// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/diagnostic.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// Where a bus is found here and today, instead of where the rig says.
struct BusTransport {
  std::string bus;
  std::string url;
};

/// Reads a transport map and gives the buses that it names their URLs:
///
///   transports: 1
///   buses:
///     - {name: left, url: "serial:///dev/serial/by-id/..."}
///
/// All that is wrong is reported at once, each at its place: a bus that the rig does not have or that is named twice, a
/// URL of another kind of bus, a simulated one.
[[nodiscard]] Status<Diagnostics> take_transports(const std::filesystem::path& file, Rig& rig);

/// The text of such a file. @param made_by for its first line
[[nodiscard]] std::string transport_map_text(const std::vector<BusTransport>& transports, const std::string& made_by);

}  // namespace footlight::config
