// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// What the labels and links of a TimeFlowSolver say, for its own files.
namespace footlight::planner {

inline constexpr std::int32_t kFar = 1 << 30;
inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;
/// Marks in place of the node before: nobody is here; somebody is kept here whom nobody has joined; here from the
/// start.
inline constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;
inline constexpr std::uint32_t kUnfilled = 0xFFFFFFFEU;
inline constexpr std::uint32_t kSource = 0xFFFFFFFDU;
inline bool is_node(std::uint32_t from) { return from < kSource; }

}  // namespace footlight::planner
