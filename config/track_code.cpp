// SPDX-License-Identifier: Apache-2.0
#include "config/track_code.hpp"

namespace footlight::config {
namespace {

void put(std::string& out, std::int64_t value) {
  auto folded = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63);
  while (folded >= 0x80) {
    out.push_back(static_cast<char>((folded & 0x7FU) | 0x80U));
    folded >>= 7U;
  }
  out.push_back(static_cast<char>(folded));
}

/// Takes one integer from the front of `blob`; nothing when it is cut off or longer than 64 bits.
std::optional<std::int64_t> take(std::string_view& blob) {
  std::uint64_t folded = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (blob.empty()) return std::nullopt;
    const auto byte = static_cast<std::uint8_t>(blob.front());
    blob.remove_prefix(1);
    const std::uint64_t bits = byte & 0x7FU;
    if ((bits << shift) >> shift != bits) return std::nullopt;
    folded |= bits << shift;
    if ((byte & 0x80U) == 0) {
      return static_cast<std::int64_t>((folded >> 1U) ^ (~(folded & 1U) + 1U));
    }
  }
  return std::nullopt;
}

/// Adds a step to a cell index and checks that the cell exists.
std::optional<CellIndex> step_to(std::int64_t& at, std::optional<std::int64_t> step, int cells) {
  if (!step || *step > cells || *step < -cells) return std::nullopt;
  at += *step;
  if (at < 0 || at >= cells) return std::nullopt;
  return CellIndex::of(at);
}

}  // namespace

std::string encode_track(const std::vector<Mark>& track) {
  std::string out;
  std::int64_t time = 0;
  std::int64_t cell = 0;
  for (const Mark& mark : track) {
    const std::int64_t ns = mark.time.time_since_epoch().count();
    put(out, ns - time);
    put(out, static_cast<std::int64_t>(mark.cell.value()) - cell);
    time = ns;
    cell = mark.cell.value();
  }
  return out;
}

std::optional<std::vector<Mark>> decode_track(std::string_view blob, int cells) {
  std::vector<Mark> out;
  std::int64_t time = 0;
  std::int64_t cell = 0;
  while (!blob.empty()) {
    const auto passed = take(blob);
    if (!passed || (!out.empty() && *passed <= 0) || __builtin_add_overflow(time, *passed, &time)) return std::nullopt;
    const auto at = step_to(cell, take(blob), cells);
    if (!at) return std::nullopt;
    out.push_back({Instant(Duration(time)), *at});
  }
  return out;
}

std::string encode_cells(const std::vector<CellIndex>& list) {
  std::string out;
  std::int64_t before = 0;
  for (const CellIndex cell : list) {
    put(out, static_cast<std::int64_t>(cell.value()) - before);
    before = cell.value();
  }
  return out;
}

std::optional<std::vector<CellIndex>> decode_cells(std::string_view blob, int cells) {
  std::vector<CellIndex> out;
  std::int64_t cell = 0;
  while (!blob.empty()) {
    const auto at = step_to(cell, take(blob), cells);
    if (!at) return std::nullopt;
    out.push_back(*at);
  }
  return out;
}

}  // namespace footlight::config
