// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live/node_board.hpp"

namespace footlight::app {

/// What one client has been told of the nodes, and the frame that tells it the rest (docs/console.md, "Node frames"):
/// neighbours of one state are one run of 16 bytes, so a floor that is of one mind takes 24 bytes, and a client that is
/// slow gets fewer frames and no old ones.
class NodeNews {
 public:
  /// Nothing when nothing has changed since the last frame; the first one tells of all. O(nodes)
  [[nodiscard]] std::optional<std::string> frame(const NodeBoard& board);

 private:
  std::vector<NodeBoard::View> told_;
  bool begun_ = false;
};

}  // namespace footlight::app
