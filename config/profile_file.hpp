// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "config/lamp_currents.hpp"
#include "config/mapping_reader.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// What kind of device a profile is of, by the key that only it has.
enum class DeviceKind { modbus, dmx, outputs };

/// Refuses the profile of another kind of device, and keys that this kind does not have.
/// @return false when it is another kind
[[nodiscard]] bool is_profile_of(MappingReader& root, DeviceKind wanted);

inline constexpr std::size_t kMaxProfileBytes = std::size_t{64} << 10U;

/// Reads a file by its listing and `read`; nothing after an error.
template <class Value, class Read>
std::optional<Value> read_profile_file(const std::filesystem::path& file, Diagnostics& diagnostics,
                                       std::optional<LampCurrents>* currents, Read read) {
  Diagnostics found;
  Reading reading{file.string(), found};
  std::optional<Value> value;
  if (const auto bytes = read_bounded(file, kMaxProfileBytes); !bytes) {
    found.error({reading.file, 0, 0}, "", bytes.error().message);
  } else if (auto root = read_root(reading, *bytes, profile_listing())) {
    value = read(*root);
    auto written = root->has("currents") ? root->mapping("currents") : std::nullopt;
    if (written) {
      const LampCurrents read_ones = read_currents(*written);
      if (currents != nullptr) *currents = read_ones;
    }
  }
  for (Diagnostic& diagnostic : found.sorted()) diagnostics.add(std::move(diagnostic));
  if (found.has_errors()) return std::nullopt;
  return value;
}

}  // namespace footlight::config
