// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/footlight_serial/cobs.hpp"

#include <algorithm>

namespace footlight::drivers::footlight_serial {
namespace {

constexpr std::size_t kLongestRun = 254;  // bytes behind one code byte

}  // namespace

std::vector<std::uint8_t> cobs_encode(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> out;
  out.reserve(bytes.size() + bytes.size() / kLongestRun + 1);
  std::size_t code_at = 0;
  out.push_back(0);
  for (const std::uint8_t byte : bytes) {
    const bool full = out.size() - code_at == kLongestRun + 1;
    if (full || byte == 0) {
      out[code_at] = static_cast<std::uint8_t>(out.size() - code_at);
      code_at = out.size();
      out.push_back(0);
    }
    if (byte != 0) {
      out.push_back(byte);
    } else if (full) {  // the full run has taken no zero with it: this one needs a code of its own
      out[code_at] = 1;
      code_at = out.size();
      out.push_back(0);
    }
  }
  out[code_at] = static_cast<std::uint8_t>(out.size() - code_at);
  return out;
}

std::optional<std::vector<std::uint8_t>> cobs_decode(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || std::find(bytes.begin(), bytes.end(), std::uint8_t{0}) != bytes.end()) return std::nullopt;
  std::vector<std::uint8_t> out;
  out.reserve(bytes.size());
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t code = bytes[at];
    if (at + code > bytes.size()) return std::nullopt;
    const auto run = bytes.subspan(at + 1, code - 1);
    out.insert(out.end(), run.begin(), run.end());
    at += code;
    if (code <= kLongestRun && at < bytes.size()) out.push_back(0);
  }
  return out;
}

}  // namespace footlight::drivers::footlight_serial
