// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace footlight::planner::assignment {

/// The innermost loops of the assignment, compiled for several instruction sets (kernels.inc). All of them do the same
/// IEEE operations in the same order for each number, without contraction: the same bytes on every processor.
///
/// Only plain values and pointers here: an inline function of a library that is compiled for AVX-512 in one file could
/// be the copy that the linker keeps for all files.
enum class Instructions : std::uint8_t { generic, avx2, avx512 };

/// Children of a node, targets of a leaf, and more than the lanes of any register.
inline constexpr std::uint32_t kFan = 16;
/// Targets that a source bids among.
inline constexpr std::uint32_t kListed = 32;

/// A candidate: walk + price, rounded.
struct Hit {
  float value;
  std::uint32_t target;
};

/// A PriceTree's columns, padded to full fans.
struct TreeView {
  static constexpr std::uint32_t kMostLevels = 8;
  struct Level {
    const float *low_x, *high_x, *low_y, *high_y;
    const float *slope_x, *slope_y, *residual;
  };
  const float *x, *y, *price;
  Level level[kMostLevels];  ///< 0: leaves
  std::uint32_t levels;
};

/// A search under way. A kernel goes on with it until nothing is open or `pause_at` hits have been found, of which
/// there is then room for kFan - 1 more.
struct SearchState {
  struct Open {
    float bound;
    std::uint32_t level;  ///< of the children
    std::uint32_t node;
  };
  float x, y;
  float bound;   ///< what is not below it is not wanted
  float margin;  ///< above the least value found
  float reach_squared;
  std::uint32_t pause_at;
  std::uint32_t found = 0;
  std::uint32_t open = 0;
  Hit* hits;
  Open stack[kFan * TreeView::kMostLevels];
};

/// The two least of a list of walks + prices, and the target of the first one that is least.
struct Offer {
  float best;
  float second;
  std::uint32_t target;
};

struct Kernels {
  /// [by distance][within reach only]
  void (*search[2][2])(const TreeView& tree, SearchState& state);
  /// @param count a multiple of kFan, at most kListed
  Offer (*look)(const float* walk, const std::uint32_t* target, std::uint32_t count, const float* price);
  /// One step of Dijkstra's search in a full table, for all columns: distance[t] = min(distance[t], base + cost[t] -
  /// paid[t]), with from[t] = source where it was less.
  /// @param rank added to the distances only for finding the least: infinity where the search has been
  /// @param count a multiple of kFan @return the first of the least distance + rank
  std::uint32_t (*relax)(const double* cost, const double* paid, const double* rank, double base, double source,
                         std::uint32_t count, double* distance, double* from);
};

/// Those of use_instructions, at first the widest that this program and this processor have.
[[nodiscard]] const Kernels& kernels();
[[nodiscard]] bool has_instructions(Instructions wanted);
/// For tests and timings. @param wanted has_instructions. Not while somebody assigns.
void use_instructions(Instructions wanted);

}  // namespace footlight::planner::assignment
