// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "app/live/node_board.hpp"
#include "app/surfaces/run_desk.hpp"
#include "core/rig.hpp"

namespace footlight::app {

/// How the buses and nodes of a run are, for people: tells an alarm when a wire goes down, a bus goes off, nodes fall
/// silent or restart, and a note when all of a bus answers again. One alarm for a bus, whatever has happened on it; the
/// next one of the same bus 10 s later, then 20, 40, up to 320 s while it goes on, with how often it was: a line that
/// flaps buries no other alarm. One thread; O(nodes) a look.
///
/// A node is *silent* from the instant at which its wire is down or it is in quarantine, or when it has not answered
/// for `kSuspect`; it answers again when it has done so for as long and has confirmed what it should show.
class BusHealth final : public Surface {
 public:
  static constexpr Duration kSuspect = milliseconds(1000);   ///< T1 of the trust model
  static constexpr Duration kUnproved = milliseconds(2500);  ///< T2: so long without the right looks is no switch
  static constexpr Duration kGather = milliseconds(500);     ///< nodes of one fault are found one after the other
  static constexpr Duration kAlarmAgain = milliseconds(10'000);
  static constexpr Duration kAlarmAtMost = milliseconds(320'000);
  static constexpr Duration kCalm = milliseconds(60'000);  ///< so long well: the next fault is a new one

  /// Every change of health by itself, for the journal: "bus \"left\": left-1, left-2 silent".
  using Change = std::function<void(const std::string&)>;

  /// Borrows rig and board, which the desk's views must outlive. @param change none: nobody
  BusHealth(const Rig& rig, const NodeBoard& board, RunDesk& desk, Change change);

  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] bool listens() const override { return false; }

  /// Does not answer. False before the roll call is over.
  [[nodiscard]] bool silent(std::size_t node) const { return nodes_[node].silent; }
  /// Silent, or without a confirmation of what it should show for longer than any switch takes.
  [[nodiscard]] bool unproved(std::size_t node) const { return nodes_[node].silent || nodes_[node].unproved; }
  /// Why the wire of a bus is down; empty: it is not.
  [[nodiscard]] const std::string& down(std::size_t bus) const { return buses_[bus].down; }
  [[nodiscard]] std::size_t buses() const { return buses_.size(); }

 private:
  struct NodeHealth {
    bool silent = false;
    bool unproved = false;
    std::uint8_t boots = 0;
    Instant differs_since = kNever;  ///< what it says now differs from `silent`
    Instant wrong_since = kNever;    ///< it is not confirmed right
  };
  struct BusState {
    std::size_t nodes = 0;
    std::size_t silent = 0;
    std::string down;           ///< why its wire is; empty as soon as it has been up for `kSuspect`
    Instant up_since = kNever;  ///< it is up, and `down` does not say so yet
    std::string last_fault;
    std::int64_t last_fault_unix_ms = 0;
    // Since the last alarm.
    std::size_t downs = 0;
    std::string was_down;
    std::set<std::size_t> fell_silent;
    std::set<std::size_t> restarted;
    // At this look, for the journal.
    std::vector<std::size_t> now_silent;
    std::vector<std::size_t> now_answer;
    // When the next one is due, and when it may be.
    Instant due = kNever;
    Instant not_before = Instant::min();
    Duration interval = kAlarmAgain;
    Instant bad_since = kNever;   ///< an alarm was told, and not all answer yet: since then
    Instant well_since = kNever;  ///< nothing is the matter
  };

  void begin(Instant now);
  void look_at_port(std::size_t b, const std::string& trouble, Instant now);
  void look_at_nodes(Instant now);
  void look_at_node(std::size_t n, Instant now);
  void tell(std::size_t b, Instant now, RunDesk& desk);
  void changed(std::size_t bus, const std::string& what) const;
  [[nodiscard]] bool answers_not(std::size_t n) const;
  [[nodiscard]] std::string alarm_text(std::size_t b) const;
  template <class Nodes>
  [[nodiscard]] std::string names(const Nodes& nodes, std::size_t most) const;

  const Rig& rig_;
  const NodeBoard& board_;
  Change change_;
  std::vector<NodeHealth> nodes_;
  std::vector<BusState> buses_;
  bool called_ = false;  ///< the roll call was over at the last look
};

}  // namespace footlight::app
