// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/index.hpp"
#include "core/plan.hpp"

namespace footlight::config {

// How the blobs of a plan file are written. An integer is a LEB128 varint, seven bits a byte, low ones first; signed
// ones are folded first (0, -1, 1, -2 ... become 0, 1, 2, 3 ...).

/// A track: for each mark the time since the mark before in ns (the first since count 1), then the change of the cell
/// index (the first from 0), both signed.
[[nodiscard]] std::string encode_track(const std::vector<Mark>& track);
/// @param cells of the grid  @return nothing unless the blob is whole, its times increase and its cells exist
[[nodiscard]] std::optional<std::vector<Mark>> decode_track(std::string_view blob, int cells);

/// A list of cells: for each the change of the index, signed.
[[nodiscard]] std::string encode_cells(const std::vector<CellIndex>& list);
/// @return nothing unless the blob is whole and its cells exist
[[nodiscard]] std::optional<std::vector<CellIndex>> decode_cells(std::string_view blob, int cells);

}  // namespace footlight::config
