// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/mapping_reader.hpp"
#include "core/rig.hpp"

namespace footlight::config {

/// Reads the power supplies of a rig, and hangs its nodes on them.
class SuppliesReader {
 public:
  /// @param root borrowed, as the rig
  SuppliesReader(MappingReader& root, Rig& rig) : root_(root), rig_(rig) {}

  /// Supplies and the currents of lamps; before buses and nodes, which name them.
  void read();
  /// The key `supply` of a bus or a node. Where the rig lists supplies it is one of them.
  [[nodiscard]] std::optional<std::string> name_in(MappingReader& reader) const;
  /// This node says itself where it hangs.
  void keep(const Node& node, int line) { said_[{node.bus, node.address}] = line; }
  /// What supplies feed; then whether every lamp's current is known. After all nodes are there.
  void hang();

 private:
  struct Feed {
    std::size_t supply = 0;
    MappingReader reader;
  };

  void feed(Feed& feed);
  void check_currents();
  void warn();

  MappingReader& root_;
  Rig& rig_;
  std::vector<Feed> feeds_;
  std::map<std::pair<BusIndex, int>, int> said_;  ///< line that says where the node of an address hangs
};

}  // namespace footlight::config
