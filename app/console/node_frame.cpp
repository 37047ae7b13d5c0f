// SPDX-License-Identifier: Apache-2.0
#include "app/console/node_frame.hpp"

#include <cstdint>

namespace footlight::app {
namespace {

struct Run {
  std::uint32_t first = 0;
  std::uint32_t nodes = 0;
  NodeBoard::View view;
};

void put(std::string& out, std::uint32_t value) {
  for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(value >> (8 * byte) & 0xffU);
}

}  // namespace

std::optional<std::string> NodeNews::frame(const NodeBoard& board) {
  const bool whole = !begun_;
  begun_ = true;
  told_.resize(board.size());
  std::vector<Run> runs;
  for (std::size_t n = 0; n < board.size(); ++n) {
    const NodeBoard::View view = board.at(n);
    if (!whole && view == told_[n]) continue;
    told_[n] = view;
    const bool goes_on = !runs.empty() && runs.back().first + runs.back().nodes == n && runs.back().view == view;
    if (goes_on) {
      ++runs.back().nodes;
    } else {
      runs.push_back({static_cast<std::uint32_t>(n), 1, view});
    }
  }
  if (runs.empty() && !whole) return std::nullopt;
  std::string out{'\1', whole ? '\1' : '\0', '\0', '\0'};
  out.reserve(8 + runs.size() * 16);
  put(out, static_cast<std::uint32_t>(runs.size()));
  for (const Run& run : runs) {
    put(out, run.first);
    put(out, run.nodes);
    put(out, run.view.shown);
    put(out, run.view.flags);
  }
  return out;
}

}  // namespace footlight::app
