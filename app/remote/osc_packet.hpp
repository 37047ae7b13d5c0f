// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/result.hpp"

namespace footlight::app {

/// Booleans come as 1 and 0.
using OscValue = std::variant<std::int32_t, double, std::string>;

struct OscMessage {
  std::string address;  ///< "/go"
  std::vector<OscValue> values{};
  friend bool operator==(const OscMessage&, const OscMessage&) = default;
};

/// The messages of one datagram (Open Sound Control 1.0), those of bundles in their order; bundles are carried out at
/// once, whatever their time. Bounded: 32 messages, bundles four deep, 16 arguments. Errors (ErrorKind::input) for any
/// bytes that are no OSC; ErrorKind::device: a program built without liblo.
[[nodiscard]] Result<std::vector<OscMessage>> read_osc(std::span<const std::byte> datagram);

/// @return bytes to send; empty for a program built without liblo
[[nodiscard]] std::vector<std::byte> osc_bytes(const OscMessage& message);
/// All of them in one bundle, to be carried out at once.
[[nodiscard]] std::vector<std::byte> osc_bundle(const std::vector<OscMessage>& messages);

}  // namespace footlight::app
