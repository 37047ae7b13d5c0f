// SPDX-License-Identifier: Apache-2.0
#include "app/output_place.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace footlight::app {

Status<> can_write(const std::filesystem::path& output) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool file = output.has_extension();
  fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  // A folder is made, with those above it; a file's folder must be there.
  while (!file && !fs::exists(folder, error) && folder.has_parent_path() && folder != folder.parent_path()) {
    folder = folder.parent_path();
  }
  const auto cannot = [&](int reason) {
    return input_error(fmt::format("cannot write '{}': {}", output.string(), std::strerror(reason)));
  };
  if (file && fs::is_directory(output, error)) return cannot(EISDIR);
  if (!fs::exists(folder, error)) return file ? cannot(ENOENT) : Status<>(Done{});
  if (!fs::is_directory(folder, error)) return cannot(ENOTDIR);
  if (access(folder.c_str(), W_OK | X_OK) != 0) return cannot(errno);
  return Done{};
}

Status<> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && std::filesystem::is_directory(folder, error)) return Done{};
  if (!error) error = std::make_error_code(std::errc::not_a_directory);
  return input_error(fmt::format("cannot make the folder '{}': {}", folder.string(), error.message()));
}

std::string file_name_of(std::string_view name, std::set<std::string>& taken) {
  std::string out;
  for (const char c : name) {
    const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                       c == '-' || static_cast<unsigned char>(c) >= 0x80;
    out += stays ? c : '-';
  }
  constexpr std::size_t kLongest = 120;  // bytes; a folder takes names of 255 and we write a longer one first
  while (out.size() > kLongest || (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0U) == 0xC0U)) {
    out.pop_back();
  }
  const std::string wanted = out.empty() ? "-" : out;
  for (int number = 2; !taken.insert(out.empty() ? wanted : out).second; ++number) {
    out = fmt::format("{}-{}", wanted, number);
  }
  return out.empty() ? wanted : out;
}

}  // namespace footlight::app
