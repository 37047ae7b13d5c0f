// SPDX-License-Identifier: Apache-2.0
#include "config/device_profile.hpp"

#include <cstdlib>
#include <vector>

#include "config/mapping_reader.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMaxProfileBytes = std::size_t{64} << 10U;

std::vector<std::filesystem::path> shipped_folders() {
  std::vector<std::filesystem::path> out;
  if (const char* data = std::getenv("FOOTLIGHT_DATA");
      data != nullptr && *data != '\0') {  // NOLINT(concurrency-mt-unsafe)
    out.push_back(std::filesystem::path(data) / "profiles");
  }
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) out.push_back(program.parent_path().parent_path() / "share" / "footlight" / "profiles");
  out.emplace_back(FOOTLIGHT_PROFILES);
  return out;
}

}  // namespace

ModbusProfile footlight_marker_profile() {
  ModbusProfile out;
  out.name = "footlight-marker";
  out.look_register = 0x0000;
  out.latch_register = 0x0020;
  out.heartbeat_register = 0x0030;
  out.status_register = 0x0040;
  out.look_table_register = 0x0050;
  return out;
}

std::optional<std::filesystem::path> find_profile(const std::string& name, const std::filesystem::path& folder) {
  std::error_code error;
  const auto extension = std::filesystem::path(name).extension();
  if (extension == ".yaml" || extension == ".yml") {
    auto file = (folder / name).lexically_normal();
    if (std::filesystem::is_regular_file(file, error)) return file;
    return std::nullopt;
  }
  if (name.find('/') != std::string::npos) return std::nullopt;
  for (const auto& shipped : shipped_folders()) {
    auto file = shipped / (name + ".yaml");
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

std::optional<ModbusProfile> read_profile(const std::filesystem::path& file, Diagnostics& diagnostics) {
  Reading reading{file.string(), diagnostics};
  const auto bytes = read_bounded(file, kMaxProfileBytes);
  if (!bytes) {
    diagnostics.error({reading.file, 0, 0}, "", bytes.error().message);
    return std::nullopt;
  }
  auto root = read_root(reading, *bytes, profile_listing());
  if (!root) return std::nullopt;
  ModbusProfile out;
  const auto version = root->integer("profile");
  const auto name = root->text("name");
  const auto look_register = root->integer("look_register");
  out.looks_per_register = root->integer("looks_per_register").value_or(2);
  out.has_preload_sequence = root->boolean("preload_sequence").value_or(true);
  out.latch_register = root->integer("latch_register");
  out.heartbeat_register = root->integer("heartbeat_register");
  out.status_register = root->integer("status_register");
  out.look_table_register = root->integer("look_table_register");
  if (!version || !name || !look_register) return std::nullopt;
  out.name = *name;
  out.look_register = *look_register;
  return out;
}

}  // namespace footlight::config
