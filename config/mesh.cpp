// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>

#include "config/csv.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMostVertices = 2'000'000;
constexpr double kFarthest = 1e9;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The three numbers after `v`; nothing when they are not three.
std::optional<std::array<double, 3>> numbers_of(std::string_view line) {
  std::array<double, 3> out{};
  for (double& value : out) {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    if (line.starts_with('+')) line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc{} || !(std::abs(value) < kFarthest)) return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (!line.empty() && !is_blank(line.front())) return std::nullopt;
  }
  return out;
}

}  // namespace

// Faces, normals and materials are of no use here, and hostile files are: four lines of the format are enough.
std::vector<std::array<double, 3>> read_mesh(const std::string& file, Diagnostics& diagnostics) {
  std::vector<std::array<double, 3>> out;
  const auto bytes = read_bounded(file, kMaxCsvBytes);
  if (!bytes) {
    diagnostics.error({file, 0, 0}, "", bytes.error().message);
    return out;
  }
  int number = 0;
  for (std::string_view rest = *bytes; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    ++number;
    if (line.size() < 2 || line[0] != 'v' || !is_blank(line[1])) continue;
    const auto vertex = numbers_of(line.substr(1));
    if (!vertex) {
      diagnostics.error({file, number, 1}, "", "the corner is not three numbers", "write for example v 1.0 0.5 -2");
      return {};
    }
    if (out.size() == kMostVertices) {
      diagnostics.error({file, number, 1}, "", "the mesh has more than 2000000 corners", "a simpler one will do");
      return {};
    }
    out.push_back(*vertex);
  }
  if (out.empty()) {
    diagnostics.error({file, 0, 0}, "", "the mesh has no corners", "an OBJ file has lines like v 1.0 0.5 -2");
  }
  return out;
}

}  // namespace footlight::config
