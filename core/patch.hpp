// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/rig.hpp"

namespace footlight {

/// What a marker keeps of its patch: which lamp is which cell or whose wearable, at which address. Nodes that are
/// exchanged, and one that was wired for another rig, have another one. Never 0: that is a marker that was given none.
/// The first 4 bytes of SHA-256 (docs/wire-protocol.md, section 1, kept).
[[nodiscard]] std::uint32_t patch_check(const Node& node);

}  // namespace footlight
