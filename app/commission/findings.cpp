// SPDX-License-Identifier: Apache-2.0
#include "app/commission/findings.hpp"

#include <algorithm>
#include <map>

#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr int kLeastSegment = 3;

/// One comparison under way: lamps are explained one after the other, by the largest cause first.
class Comparison {
 public:
  Comparison(const Rig& rig, const std::vector<FloorLamp>& lamps, const std::vector<std::optional<CellIndex>>& seen)
      : lamps_(lamps), seen_(seen), open_(lamps.size(), false), of_node_(rig.nodes.size()) {
    FL_CHECK(seen.size() == lamps.size());
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      of_node_[lamps[i].place.node.at()].push_back(i);
      if (lamps[i].cell) at_.emplace(*lamps[i].cell, i);
      open_[i] = seen[i] && lamps[i].cell && *seen[i] != *lamps[i].cell;
    }
  }

  Findings find(const std::vector<CellIndex>& unread) {
    find_nodes();
    for (std::size_t n = 0; n < of_node_.size(); ++n) find_turned(NodeIndex::of(n));
    find_exchanged();
    for (std::size_t i = 0; i < lamps_.size(); ++i) {
      if (open_[i]) out_.moved.emplace_back(i, *seen_[i]);
      if (seen_[i] && lamps_[i].cell == seen_[i]) ++out_.right;
      if (seen_[i] && !lamps_[i].cell) out_.unassigned.emplace_back(i, *seen_[i]);
      if (seen_[i]) continue;
      if (!lamps_[i].cell) {
        out_.nowhere.push_back(i);
      } else if (std::ranges::binary_search(unread, *lamps_[i].cell)) {
        out_.unreadable.push_back(i);
      } else {
        out_.dead.push_back(i);
      }
    }
    return std::move(out_);
  }

 private:
  using Lamps = std::vector<std::size_t>;

  /// Lamp `a` is where the rig has lamp `b`; a lamp that was not seen may be anywhere.
  [[nodiscard]] bool may_be_at(std::size_t a, std::size_t b) const {
    return !seen_[a] || (lamps_[b].cell && *seen_[a] == *lamps_[b].cell);
  }
  [[nodiscard]] std::size_t wrong_of(const Lamps& lamps) const {
    return static_cast<std::size_t>(std::ranges::count_if(lamps, [&](std::size_t i) { return open_[i]; }));
  }
  void close(const Lamps& lamps) {
    for (const std::size_t i : lamps) open_[i] = false;
  }

  void find_nodes() {
    for (std::size_t a = 0; a < of_node_.size(); ++a) {
      const auto b = node_that_a_is_at(a);
      if (!b || *b <= a) continue;
      bool exchanged = true;
      for (std::size_t c = 0; c < of_node_[a].size() && exchanged; ++c) {
        exchanged = may_be_at(of_node_[a][c], of_node_[*b][c]) && may_be_at(of_node_[*b][c], of_node_[a][c]);
      }
      if (!exchanged || wrong_of(of_node_[*b]) < 2) continue;
      out_.nodes.emplace_back(NodeIndex::of(a), NodeIndex::of(*b));
      close(of_node_[a]);
      close(of_node_[*b]);
    }
  }
  /// The node in whose place the first lamp of `a` that is wrong was seen.
  [[nodiscard]] std::optional<std::size_t> node_that_a_is_at(std::size_t a) const {
    if (wrong_of(of_node_[a]) < 2) return std::nullopt;
    for (const std::size_t i : of_node_[a]) {
      if (!open_[i]) continue;
      const auto there = at_.find(*seen_[i]);
      if (there == at_.end()) return std::nullopt;
      const std::size_t b = lamps_[there->second].place.node.at();
      if (b == a || of_node_[b].size() != of_node_[a].size()) return std::nullopt;
      return b;
    }
    return std::nullopt;
  }

  /// Again and again the turned segment that explains the most wrong lamps of the node.
  void find_turned(NodeIndex node) {
    const Lamps& all = of_node_[node.at()];
    const int count = static_cast<int>(all.size());
    while (wrong_of(all) >= 2) {
      TurnedLamps best;
      std::size_t most = 0;
      const auto consider = [&](const TurnedLamps& turned) {
        const std::size_t explained = explains(all, turned);
        if (explained <= most) return;
        most = explained;
        best = turned;
      };
      for (int first = 0; first + kLeastSegment <= count; ++first) {
        for (int last = count - 1; last - first + 1 >= kLeastSegment; --last) consider({node, first, last, true, 0});
      }
      for (int first = 0; first + kLeastSegment <= count; ++first) {
        for (int last = count - 1; last - first + 1 >= kLeastSegment; --last) {
          if (const auto by = ring_step(all, first, last)) consider({node, first, last, false, *by});
        }
      }
      // Two lamps that are wrong are an exchange, unless they are the ends of a node of three.
      if (most < 3 && !(most == 2 && best.reversed && count == kLeastSegment)) return;
      out_.turned.push_back(best);
      for (int i = best.first; i <= best.last; ++i) open_[all[static_cast<std::size_t>(i)]] = false;
    }
  }
  /// How far the first wrong lamp of a segment has moved around it; nothing when it has left it.
  [[nodiscard]] std::optional<int> ring_step(const Lamps& all, int first, int last) const {
    for (int i = first; i <= last; ++i) {
      const std::size_t lamp = all[static_cast<std::size_t>(i)];
      if (!open_[lamp]) continue;
      for (int j = first; j <= last; ++j) {
        if (lamps_[all[static_cast<std::size_t>(j)]].cell == seen_[lamp])
          return (j - i + last - first + 1) % (last - first + 1);
      }
      return std::nullopt;
    }
    return std::nullopt;
  }

  /// Wrong lamps that a turned segment explains; 0 when it contradicts one, or when its ends were not seen to be wrong.
  [[nodiscard]] std::size_t explains(const Lamps& all, const TurnedLamps& turned) const {
    const int length = turned.last - turned.first + 1;
    std::size_t wrong = 0;
    for (int i = turned.first; i <= turned.last; ++i) {
      const int at =
          turned.reversed ? turned.first + turned.last - i : turned.first + (i - turned.first + turned.by) % length;
      const std::size_t lamp = all[static_cast<std::size_t>(i)];
      if (!may_be_at(lamp, all[static_cast<std::size_t>(at)])) return 0;
      if (seen_[lamp] && at != i && !open_[lamp]) return 0;  // explained already
      wrong += open_[lamp] ? 1 : 0;
    }
    return wrong;
  }

  void find_exchanged() {
    for (std::size_t a = 0; a < lamps_.size(); ++a) {
      if (!open_[a]) continue;
      const auto there = at_.find(*seen_[a]);
      if (there == at_.end()) continue;
      const std::size_t b = there->second;
      if (b <= a || !open_[b] || *seen_[b] != *lamps_[a].cell) continue;
      out_.exchanged.emplace_back(a, b);
      open_[a] = open_[b] = false;
    }
  }

  const std::vector<FloorLamp>& lamps_;
  const std::vector<std::optional<CellIndex>>& seen_;
  std::vector<bool> open_;  ///< seen elsewhere than the rig says, and not explained yet
  std::vector<Lamps> of_node_;
  std::map<CellIndex, std::size_t> at_;  ///< lamp that the rig has on a cell
  Findings out_;
};

}  // namespace

Findings compare(const Rig& rig, const std::vector<FloorLamp>& lamps, const std::vector<std::optional<CellIndex>>& seen,
                 const std::vector<CellIndex>& unread) {
  return Comparison(rig, lamps, seen).find(unread);
}

}  // namespace footlight::app
